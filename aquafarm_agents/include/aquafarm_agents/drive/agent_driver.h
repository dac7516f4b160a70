// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/environment/policy.h"

namespace aquafarm_agents {

struct AgentDriverOptions {
  std::int32_t ship{};
  double wait_limit_s{20.0};        ///< max wait for the sim node
  const std::atomic<bool>* stop{};  ///< ends Drive if true; null if it cannot be stopped
};

/// Agent of one ship, as in a deployment. It subscribes only to that ship's observation, claims the
/// ship and calls its move, pickup and drop_off services. In lockstep its command waits for the
/// commands of the other ships, and it calls reset after the end of an episode. In paced running
/// the ship holds if its command is late. An agent that starts during an episode joins that
/// episode.
class AgentDriver {
 public:
  /// Waits for the sim node.
  /// @param observation_types observation types of the policy; kStatesBit is not supported, because
  ///        an observation does not contain the complete farm
  /// @throws InputError if there is no such ship, or the scenario has too many states for a policy
  ///         that requires the index
  /// @throws EnvironmentLost if the sim node does not respond within the limit
  AgentDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
              AgentDriverOptions options);
  ~AgentDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Claims the ship and drives it until `episodes` episodes in which it acted have ended; 0:
  /// without limit. Returns early when stopped.
  /// @param seed seed of the policy's random draws
  /// @returns by ended episode: whether every device was delivered
  /// @throws InputError if another node has claimed the ship; EnvironmentLost if the sim node is
  ///         unreachable for longer than the limit
  std::vector<bool> Drive(aquafarm::agents::Policy& policy, std::uint64_t seed,
                          std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
