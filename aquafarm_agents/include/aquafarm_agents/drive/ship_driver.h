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
  std::int32_t ship{-1};      ///< -1: all ships of farm 0
  double wait_limit_s{20.0};  ///< max wait for the sim node
  const std::atomic<bool>* stop{};
};

/// Drives ships of a running ranch, paced or lockstep, by ship commands. It loads the farm's saved
/// state into a local farm, which computes the policy's observation types exactly as in training.
class ShipDriver {
 public:
  /// Waits for the sim node. @throws InputError, EnvironmentLost
  ShipDriver(const ros::NodeHandle& node, std::uint8_t observation_types,
             ShipDriverOptions options);
  ~ShipDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Drives until `episodes` episodes have ended, or without end if 0. Returns early when stopped.
  /// A single ship is claimed until then.
  /// @throws InputError if another node has claimed the ship; EnvironmentLost if the sim node is
  ///         unreachable for longer than the limit
  std::vector<aquafarm::EpisodeSummary> Drive(aquafarm::agents::Policy& policy, std::uint64_t seed,
                                              std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
