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
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm_agents/link/call_limit.h"

namespace aquafarm_agents {

struct RosEnvironmentOptions {
  std::int32_t farms{};  ///< 0: as many as the sim node has
  std::uint8_t encodings{aquafarm::agents::kIndexBit};
  bool hashes{};
  double wait_limit_s{20.0};        ///< for the sim node to be there, or to come back
  double call_limit_s{30.0};        ///< for one call
  double pause_limit_s{3600.0};     ///< for a paused (or paced) farm to go on
  const std::atomic<bool>* stop{};  ///< ends all waits at once; null: never
  std::function<void(const std::string&)> on_notice;  ///< is told of losses, waits and returns
};

/// Farms behind a sim node's services. Connections are persistent. A lost call is sent again with
/// its number, so that no farm steps twice; farms that another has moved, reset or loaded, or a sim
/// node that came back without its farms, are reset to fresh episodes of the same seed and
/// TakeRestarted() says so. Any call throws EnvironmentLost
/// when the sim node is gone for longer than the limits.
class RosEnvironment final : public aquafarm::agents::Environment {
 public:
  /// Waits for the sim node.
  /// @throws InputError when its farms cannot be used as asked
  RosEnvironment(const ros::NodeHandle& node, RosEnvironmentOptions options);

  const aquafarm::agents::EnvironmentSpec& spec() const override { return spec_; }
  const aquafarm::agents::Results& Reset(std::uint64_t seed,
                                         std::uint64_t first_episode = 0) override;
  const aquafarm::agents::Results& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const aquafarm::agents::Results& Load(const std::string& bytes) override;
  bool TakeRestarted() override;

 private:
  template <typename Service>
  bool Try(ros::ServiceClient& client, const std::string& name, Service& service);
  template <typename Service>
  void CallOrThrow(ros::ServiceClient& client, const std::string& name, Service& service);
  bool Stopped() const;
  void Notice(const std::string& text) const;
  void Sleep() const;
  void Restart(const std::string& why);
  void WaitForReturn(ros::WallTime& lost_since);
  void WaitToGoOn(const std::string& why, double& waited_s);
  void Take(aquafarm_msgs::StepResult& result);
  aquafarm_msgs::GetState::Response GetState(std::int32_t farm, bool with_spec);
  void ReadProgress();

  ros::NodeHandle node_;
  const RosEnvironmentOptions options_;
  std::uint8_t encodings_;  // bits of StepResult
  bool own_rewards_{};
  CallLimit limit_;
  ros::ServiceClient step_client_;
  ros::ServiceClient reset_client_;
  ros::ServiceClient get_client_;
  ros::ServiceClient save_client_;
  ros::ServiceClient load_client_;

  aquafarm::agents::EnvironmentSpec spec_;
  aquafarm::agents::Results results_;
  aquafarm_msgs::Step step_;  // its memory is reused
  std::uint64_t sequence_;
  bool restarted_{};
  int restarts_{};  // since an episode has ended

  std::uint64_t turn_{};  // of the last result: tells whether the farms are still as it left them
  std::uint64_t seed_{};
  std::uint64_t next_episode_{};  // beyond all that have begun
};

}  // namespace aquafarm_agents
