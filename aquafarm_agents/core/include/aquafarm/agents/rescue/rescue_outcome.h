// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The orders of a plan, and its outcome for each device and each member.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_order.h"

namespace aquafarm::agents {

struct ShipRoute {
  std::int32_t ship{};
  double km{};
  double kwh{};    ///< 0 without RescueProblem::energy
  double hours{};  ///< from each departure to the delivery before the next one
  std::vector<RescueOrder> orders;
  std::vector<TimedCell> path;
};

/// Outcome of a plan for one device.
struct DeviceOutcome {
  std::int32_t ship{kNone};  ///< kNone: it is left behind
  std::int32_t port{kNone};
  double fetch_s{};
  double deliver_s{};
  double home{};                    ///< probability that it reaches a port
  std::vector<double> home_before;  ///< by ring: that it is in port before the ring is at its site
  double mean_loss{};
  double mean_loss_idle{};  ///< if no ship leaves
};

struct RescuePlan {
  std::vector<ShipRoute> routes;         ///< of the ships that leave
  std::vector<DeviceOutcome> devices;    ///< by device
  std::vector<float> loss;               ///< by member, in the currency of the devices' values
  std::vector<float> loss_idle;          ///< by member, if no ship leaves
  std::vector<std::uint8_t> home_count;  ///< by member: devices in port at the end
  double saved{};                        ///< mean value saved, compared with no departure
  double bound{};                        ///< upper bound of `saved` over all plans
  double cost{};                         ///< of energy and ship-hours
  /// With risk_averse: the mean of the worst members plus cost is at most this above the least one
  /// of all sequences of direct trips; infinity if the search was not exhaustive.
  double averse_gap{};
  bool is_exhaustive{};
};

/// How a skipper without a plan chooses the next device.
enum class FetchRule : std::uint8_t {
  kValue,    ///< the most valuable one that is left
  kNearest,  ///< the nearest one that is left
};

}  // namespace aquafarm::agents
