// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/CommandResult.h>
#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/environment/policy.h"

namespace aquafarm_agents {

struct ShipDriverOptions {
  std::int32_t ship{-1};            ///< -1: all ships and self-propelled devices of farm 0
  double wait_limit_s{20.0};        ///< max wait for the sim node
  const std::atomic<bool>* stop{};  ///< if set to true, Drive and all waits end; may be null
};

/// Drives the ships of a running ranch through the service `command`, paced or in lockstep. Before
/// each decision it loads the state of the sim node's farms into local farms. The local farms
/// compute the observations exactly as in training.
class ShipDriver {
 public:
  /// Waits for the sim node.
  /// @throws InputError if there is no such ship, or if the scenario does not support the
  ///         observation types
  /// @throws EnvironmentLost if the sim node does not respond within the limit, or if the wait is
  ///         stopped
  ShipDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
             ShipDriverOptions options);
  ~ShipDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Drives the ships. Returns when it is stopped, or after `episodes` episodes. If the options
  /// select a single ship, Drive claims this ship until it returns.
  /// @param seed seed of the policy's random draws
  /// @param episodes number of episodes; 0: no limit
  /// @returns the summaries of the ended episodes
  /// @throws InputError if another node has claimed a ship
  /// @throws EnvironmentLost if the sim node refuses a call or does not respond within the limit;
  ///         after a stop, Drive returns the ended episodes instead
  std::vector<aquafarm::EpisodeSummary> Drive(aquafarm::agents::Policy& policy, std::uint64_t seed,
                                              std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
