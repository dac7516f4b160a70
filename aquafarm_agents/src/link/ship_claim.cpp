// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/link/ship_claim.h"

#include <aquafarm_msgs/Claim.h>

#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {
namespace {

constexpr double kPeriod_s = 3.0;
constexpr double kReleaseLimit_s = 1.0;

}  // namespace

ShipClaim::ShipClaim(const ros::NodeHandle& node, std::int32_t ship, double wait_limit_s,
                     const std::atomic<bool>* stop)
    : node_(node), name_(aquafarm_sim::names::Claim(ship)), link_(node_, wait_limit_s, stop) {
  Renew();
}

ShipClaim::~ShipClaim() {
  aquafarm_msgs::Claim claim;
  claim.request.release = true;
  try {
    ServiceLink(node_, kReleaseLimit_s, nullptr, kReleaseLimit_s).Call(name_, claim);
  } catch (const aquafarm::agents::EnvironmentLost&) {  // the claim expires by itself
  }
}

void ShipClaim::RenewWhenDue() {
  if ((ros::WallTime::now() - claimed_at_).toSec() >= kPeriod_s) Renew();
}

void ShipClaim::Renew() {
  aquafarm_msgs::Claim claim;
  link_.Call(name_, claim);
  claimed_at_ = ros::WallTime::now();
  if (!claim.response.ok) throw aquafarm::InputError("~ship: " + claim.response.message);
}

}  // namespace aquafarm_agents
