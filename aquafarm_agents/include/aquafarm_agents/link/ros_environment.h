// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/GetState.h>
#include <aquafarm_msgs/LoadState.h>
#include <aquafarm_msgs/Reset.h>
#include <aquafarm_msgs/SaveState.h>
#include <aquafarm_msgs/Step.h>
#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm_agents/link/call_limit.h"

namespace aquafarm_agents {

struct RosEnvironmentOptions {
  std::int32_t farms{};  ///< 0: all farms of the sim node
  /// The farms play the same episodes as in an environment with all farms of the share, and Load
  /// reads their part of a state that all farms saved. If its total is 0, this environment has all
  /// farms.
  aquafarm::agents::FarmShare share;
  std::uint8_t observation_types{aquafarm::agents::kIndexBit};
  bool hashes{};
  double wait_limit_s{20.0};        ///< max wait for the sim node to start or to return
  double call_limit_s{30.0};        ///< max duration of one call
  double pause_limit_s{3600.0};     ///< max wait for a paused (or paced) farm to continue
  const std::atomic<bool>* stop{};  ///< ends all waits; null if they cannot be ended
  std::function<void(const std::string&)> on_notice;  ///< reports losses, waits and returns
};

/// Farms behind a sim node's services. Connections are persistent. A lost call is repeated with the
/// same number, so that no farm steps twice. The farms are reset to new episodes of the same seed
/// if another client has stepped, reset or loaded them, or if the sim node returned without them;
/// ConsumeRestart() then returns true. Any call throws EnvironmentLost if the sim node is
/// unreachable for longer than the limits.
class RosEnvironment final : public aquafarm::agents::Environment {
 public:
  /// Waits for the sim node.
  /// @throws InputError if its farms do not support the options
  RosEnvironment(const ros::NodeHandle& node, RosEnvironmentOptions options);

  const aquafarm::agents::EnvironmentSpec& spec() const override { return spec_; }
  const aquafarm::agents::StepResults& Reset(std::uint64_t seed,
                                             std::uint64_t first_episode = 0) override;
  const aquafarm::agents::StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const aquafarm::agents::StepResults& Load(const std::string& bytes) override;
  bool ConsumeRestart() override;

 private:
  /// Opens a connection. All are opened at the start: a master that was restarted does not know the
  /// sim node's services, but open connections remain.
  template <typename Service>
  void Connect(ros::ServiceClient& client, const std::string& name);
  template <typename Service>
  bool Try(ros::ServiceClient& client, const std::string& name, Service& service);
  template <typename Service>
  void CallOrThrow(ros::ServiceClient& client, const std::string& name, Service& service);
  bool Stopped() const;
  void Notice(const std::string& text) const;
  void Sleep() const;
  void Restart(const std::string& why);
  std::uint64_t NextRound() const;
  void WaitForReturn(ros::WallTime& lost_since);
  void WaitToResume(const std::string& why, double& waited_s);
  void Take(aquafarm_msgs::StepResult& result);
  aquafarm_msgs::GetState::Response GetState(std::int32_t farm, bool with_spec);
  void ReadProgress();

  ros::NodeHandle node_;
  const RosEnvironmentOptions options_;
  std::uint8_t observation_types_;  // bits of StepResult
  bool own_rewards_{};
  CallLimit limit_;
  ros::ServiceClient step_client_;
  ros::ServiceClient reset_client_;
  ros::ServiceClient get_client_;
  ros::ServiceClient save_client_;
  ros::ServiceClient load_client_;

  aquafarm::agents::EnvironmentSpec spec_;
  aquafarm::agents::FarmShare share_;
  aquafarm::agents::StepResults results_;
  std::unique_ptr<aquafarm::FarmBatch> copies_;  // of the farms; null unless requested
  aquafarm_msgs::Step step_;                     // reused buffer
  std::uint64_t sequence_;
  bool restarted_{};
  int restarts_{};  // since the last end of an episode

  std::uint64_t
      state_id_{};  // of the last result; a different one means that the farms have changed
  std::uint64_t seed_{};
  std::uint64_t next_episode_{};  // above all started episodes
  std::uint64_t offset_{};        // farm i of all plays episodes offset_ + i + k * share_.total
};

}  // namespace aquafarm_agents
