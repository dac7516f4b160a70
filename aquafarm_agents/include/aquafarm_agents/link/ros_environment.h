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
  /// Number of farms; 0: all farms of the sim node. If the sim node has another number, the
  /// constructor resets it to this number.
  std::int32_t farms{};
  /// Which of all farms this environment has, if several environments divide the farms. The farms
  /// play the same episodes as in an environment with all farms. Load expects the saved bytes of
  /// all farms. share.total = 0: this environment has all farms.
  aquafarm::agents::FarmShare share;
  std::uint8_t observation_types{aquafarm::agents::kIndexBit};  ///< mask of ObservationTypeBits
  bool hashes{};                    ///< whether the results contain state hashes
  double wait_limit_s{20.0};        ///< max wait for the sim node to start or to return
  double call_limit_s{30.0};        ///< max duration of one call
  double pause_limit_s{3600.0};     ///< max wait of Step for paused, paced or claimed farms
  const std::atomic<bool>* stop{};  ///< ends all waits if true; null: they cannot be stopped
  /// Called with a line of text when the environment waits for the sim node or restarts the farms.
  std::function<void(const std::string&)> on_notice;
};

/// The farms of a sim node, used through its services over persistent connections. A lost step or
/// reset is repeated with the same request id, so that the sim node executes it only once.
///
/// Another client may step, reset or load the farms, and the sim node may restart. The next Step
/// then resets the farms to new episodes of the same seed, and ConsumeRestart() returns true once.
///
/// Reset, Step, Save and Load throw EnvironmentLost if the sim node does not respond within the
/// limits, or if `stop` ends a wait. Step also throws EnvironmentLost if it must reset the farms
/// more than 20 times before an episode ends. If the sim node refuses the request, Reset and Load
/// throw InputError, and Step and Save throw EnvironmentLost. Reset also throws InputError if the
/// sim node plays another scenario than before. A Step that resets the farms also throws as Reset.
class RosEnvironment final : public aquafarm::agents::Environment {
 public:
  /// Waits for the sim node.
  /// @throws InputError if the sim node's farms do not support the options or run paced
  /// @throws EnvironmentLost in the same cases as Reset
  RosEnvironment(const ros::NodeHandle& node, RosEnvironmentOptions options);

  const aquafarm::agents::EnvironmentSpec& spec() const override { return spec_; }
  const aquafarm::agents::StepResults& Reset(std::uint64_t seed,
                                             std::uint64_t first_episode = 0) override;
  const aquafarm::agents::StepResults& Step(const std::vector<std::uint8_t>& actions) override;
  std::string Save() override;
  const aquafarm::agents::StepResults& Load(const std::string& bytes) override;
  bool ConsumeRestart() override;

 private:
  struct Outage {
    ros::WallTime since;  // end of the first failed attempt; zero: none has failed
    bool is_reported{};
  };

  /// Opens a connection. The constructor opens the connections to all services: if the master
  /// restarts later, it does not know these services, but open connections remain usable.
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
  void WaitForResponse(const std::string& name, Outage& outage);
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
  std::unique_ptr<aquafarm::FarmBatch> copies_;  // copies of the farms; null without kStatesBit
  aquafarm_msgs::Step step_;                     // reused buffer
  std::uint64_t sequence_;
  bool restarted_{};
  int restarts_{};  // since the last end of an episode

  std::uint64_t state_id_{};  // of the last result
  std::uint64_t seed_{};
  std::uint64_t next_episode_{};  // greater than the index of every started episode
  // Farm i of all farms plays the episodes offset_ + i + k * share_.total, k = 0, 1, …
  std::uint64_t offset_{};
};

}  // namespace aquafarm_agents
