// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/Claim.h>

#include <cstdint>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm_agents/link/service_link.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {

/// Claims a ship for this node during its lifetime.
class ShipClaim {
 public:
  /// @param wait_limit_s max wait for the sim node
  /// @throws InputError if another node has claimed the ship; EnvironmentLost
  ShipClaim(ros::NodeHandle node, std::int32_t ship, double wait_limit_s,
            const std::atomic<bool>* stop)
      : node_(std::move(node)),
        name_(aquafarm_sim::names::Claim(ship)),
        link_(node_, wait_limit_s, stop) {
    Renew();
  }
  ~ShipClaim() {
    aquafarm_msgs::Claim claim;
    claim.request.release = true;
    try {
      ServiceLink(node_, kReleaseLimit_s, nullptr, kReleaseLimit_s).Call(name_, claim);
    } catch (const aquafarm::agents::EnvironmentLost&) {  // the claim expires by itself
    }
  }
  ShipClaim(const ShipClaim&) = delete;
  ShipClaim& operator=(const ShipClaim&) = delete;

  /// Renews the claim periodically, which also checks that the sim node is running. Must be called
  /// while no command is sent. @throws InputError, EnvironmentLost like the constructor
  void RenewWhenDue() {
    if ((ros::WallTime::now() - claimed_at_).toSec() >= kPeriod_s) Renew();
  }

 private:
  inline static constexpr double kPeriod_s = 3.0;
  inline static constexpr double kReleaseLimit_s = 1.0;

  void Renew() {
    aquafarm_msgs::Claim claim;
    link_.Call(name_, claim);
    claimed_at_ = ros::WallTime::now();
    if (!claim.response.ok) throw aquafarm::InputError("~ship: " + claim.response.message);
  }

  ros::NodeHandle node_;
  std::string name_;
  ServiceLink link_;
  ros::WallTime claimed_at_;
};

}  // namespace aquafarm_agents
