// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/Outcome.h>

#include <memory>
#include <string>
#include <vector>

#include "aquafarm_sim/server/farm_server.h"
#include "tiny_farms.h"

namespace aquafarm_sim::test {

using aquafarm_msgs::CommandResult;
using aquafarm_msgs::Outcome;

inline constexpr std::uint8_t kNorth = 0;
inline constexpr std::uint8_t kSouth = 1;
inline constexpr std::uint8_t kPickup = 8;
inline constexpr std::uint8_t kHold = 10;

/// Creates a ranch of the tiny farm of core/test, in lockstep with a short barrier timeout.
inline std::unique_ptr<FarmServer> MakeRanchOf(const aquafarm::Scenario& scenario,
                                               const ServerOptions& options) {
  aquafarm::ValidateScenario(scenario);
  return std::make_unique<FarmServer>(std::make_shared<const aquafarm::Scenario>(scenario),
                                      options);
}

inline std::unique_ptr<FarmServer> MakeRanch(const aquafarm::Scenario& scenario,
                                             std::int32_t farms = 1, bool paced = false) {
  ServerOptions options;
  options.farms = farms;
  options.seed = 5;
  options.paced = paced;
  options.barrier_timeout_s = 1.0;
  return MakeRanchOf(scenario, options);
}

inline aquafarm::Scenario TwoShips() {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.ships.count = 2;
  return scenario;
}

/// Returns the state of a farm as a message.
inline aquafarm_msgs::FarmState StateOf(FarmServer& ranch, std::int32_t farm = 0) {
  aquafarm_msgs::GetState call;
  call.request.farm = farm;
  ranch.GetState(call.request, call.response);
  return call.response.state;
}

inline aquafarm_msgs::Reset::Response ResetTo(FarmServer& ranch, std::uint64_t seed) {
  aquafarm_msgs::Reset call;
  call.request.has_seed = true;
  call.request.seed = seed;
  ranch.Reset(call.request, call.response);
  return call.response;
}

}  // namespace aquafarm_sim::test
