// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "aquafarm_agents/link/service_link.h"

namespace aquafarm_agents {

/// Claims a ship for this node. The destructor releases the ship. If the sim node does not respond
/// to the release, the claim expires after claim_timeout_s (parameter of the sim node).
class ShipClaim {
 public:
  /// @param wait_limit_s max wait for the sim node; the last call may end up to
  ///        ServiceLink::kCallLimit_s later
  /// @param stop ends the wait if true. If it is null, the wait cannot be stopped.
  /// @throws InputError if another node has claimed the ship
  /// @throws EnvironmentLost if the sim node does not respond in time, or if the wait is stopped
  ShipClaim(const ros::NodeHandle& node, std::int32_t ship, double wait_limit_s,
            const std::atomic<bool>* stop);
  ~ShipClaim();
  ShipClaim(const ShipClaim&) = delete;
  ShipClaim& operator=(const ShipClaim&) = delete;

  /// Renews the claim if the last renewal is at least 3 s old. A renewal also checks that the sim
  /// node is running. The node must call this function repeatedly while it sends no commands,
  /// because only commands and renewals keep the claim.
  /// @throws InputError, EnvironmentLost in the same cases as the constructor
  void RenewWhenDue();

 private:
  void Renew();

  ros::NodeHandle node_;
  std::string name_;
  ServiceLink link_;
  ros::WallTime claimed_at_;
};

}  // namespace aquafarm_agents
