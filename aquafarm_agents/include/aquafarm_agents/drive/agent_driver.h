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
  const std::atomic<bool>* stop{};  ///< if true, Drive and all waits end; null: never stopped
};

/// Agent of one ship, as in a deployment. It subscribes only to the observation of its ship. It
/// claims the ship and steers it through the service `command`. In lockstep, a command waits for
/// the commands of the other ships, and the agent calls reset when the episode has ended. In paced
/// running, the ship holds if its command is late. An agent that starts during an episode joins
/// this episode.
class AgentDriver {
 public:
  /// Waits for the sim node.
  /// @param observation_types observation types of the policy; kStatesBit is not supported, because
  ///        an observation does not contain the complete farm
  /// @throws InputError if there is no such ship, or if the policy requires the index and the
  ///         scenario has too many states for it
  /// @throws EnvironmentLost if the sim node does not respond within the limit, or if the wait is
  ///         stopped
  AgentDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
              AgentDriverOptions options);
  ~AgentDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Claims the ship and drives it. Returns when it is stopped, or after `episodes` episodes in
  /// which the ship acted.
  /// @param seed seed of the policy's random draws
  /// @param episodes number of episodes; 0: no limit
  /// @returns for each ended episode in which the ship acted: whether every device was delivered
  /// @throws InputError if another node has claimed the ship
  /// @throws EnvironmentLost if the sim node refuses a call or does not respond within the limit;
  ///         after a stop, Drive returns the ended episodes instead
  std::vector<bool> Drive(aquafarm::agents::Policy& policy, std::uint64_t seed,
                          std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
