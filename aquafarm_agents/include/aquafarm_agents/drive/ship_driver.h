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
  std::int32_t ship{-1};            ///< -1: all ships of farm 0
  double wait_limit_s{20.0};        ///< max wait for the sim node
  const std::atomic<bool>* stop{};  ///< ends Drive if true; null if it cannot be stopped
};

/// Drives ships of a running ranch, paced or in lockstep, by ship commands. It loads the saved
/// state of the farms into local farms, which compute the observations exactly as in training.
class ShipDriver {
 public:
  /// Waits for the sim node.
  /// @throws InputError if there is no such ship, or the scenario does not support the observation
  ///         types
  /// @throws EnvironmentLost if the sim node does not respond within the limit
  ShipDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
             ShipDriverOptions options);
  ~ShipDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Drives the ships until `episodes` episodes have ended; 0: without limit. Returns early when
  /// stopped. If it drives a single ship, it claims the ship while it drives.
  /// @param seed seed of the policy's random draws
  /// @returns the summaries of the ended episodes
  /// @throws InputError if another node has claimed the ship; EnvironmentLost if the sim node is
  ///         unreachable for longer than the limit
  std::vector<aquafarm::EpisodeSummary> Drive(aquafarm::agents::Policy& policy, std::uint64_t seed,
                                              std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
