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
  double wait_limit_s{20.0};  ///< for the sim node
  const std::atomic<bool>* stop{};
};

/// One ship's own agent, as it would be deployed: it subscribes to that ship's observation, claims
/// the ship and calls its move, pickup and drop_off; of the rest it knows what its ship does. In
/// lockstep its command waits for the other ships', paced it is in time or its ship holds. Begun in
/// the middle of an episode it joins there.
class AgentDriver {
 public:
  /// Waits for the sim node.
  /// @param encodings of the policy; not kStatesBit, which asks for the whole farm
  /// @throws InputError when there is no such ship, EnvironmentLost
  AgentDriver(const ros::NodeHandle& node, std::uint8_t encodings, AgentDriverOptions options);
  ~AgentDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Claims the ship, and drives it until `episodes` have ended, or for ever when 0; returns early
  /// when stopped.
  /// @returns of those episodes that it saw end, whether every device was delivered
  /// @throws InputError when another node holds the ship, EnvironmentLost when the sim node is gone
  ///         for longer than the limit
  std::vector<bool> Drive(aquafarm::agents::Policy& policy, std::uint64_t seed,
                          std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
