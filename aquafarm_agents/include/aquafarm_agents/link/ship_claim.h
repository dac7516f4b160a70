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

/// Holds a ship for this node as long as it lives.
class ShipClaim {
 public:
  /// @param wait_limit_s for the sim node
  /// @throws InputError when another node holds the ship, EnvironmentLost
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
    } catch (const aquafarm::agents::EnvironmentLost&) {  // the claim ends by itself
    }
  }
  ShipClaim(const ShipClaim&) = delete;
  ShipClaim& operator=(const ShipClaim&) = delete;

  /// Claims anew now and then, which also finds out whether the sim node is there. To be called
  /// while nothing is commanded. @throws InputError, EnvironmentLost as at the start
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
