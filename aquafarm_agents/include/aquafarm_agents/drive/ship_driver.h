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
  std::int32_t ship{-1};      ///< -1: all of farm 0
  double wait_limit_s{20.0};  ///< for the sim node
  const std::atomic<bool>* stop{};
};

/// Drives ships of a running ranch, paced or lockstep, by their own commands. It sees what the
/// policy's encodings say: the farm's saved state is read into a farm of its own, whose encoder
/// and view are those of training.
class ShipDriver {
 public:
  /// Waits for the sim node. @throws InputError, EnvironmentLost
  ShipDriver(const ros::NodeHandle& node, std::uint8_t encodings, ShipDriverOptions options);
  ~ShipDriver();

  const aquafarm::agents::EnvironmentSpec& spec() const;

  /// Drives until `episodes` have ended, or for ever when 0; returns early when stopped. A ship
  /// that it drives alone is claimed until then.
  /// @throws InputError when another node holds the ship, EnvironmentLost when the sim node is gone
  /// for longer than the limit
  std::vector<aquafarm::agents::EpisodeResult> Drive(aquafarm::agents::Policy& policy,
                                                     std::uint64_t seed, std::int32_t episodes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aquafarm_agents
