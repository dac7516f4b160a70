// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The orders of a plan, and its outcome for each device and each member of the ensemble.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_order.h"

namespace aquafarm::agents {

/// Route and orders of one ship.
struct ShipRoute {
  std::int32_t ship{};  ///< index in RescueProblem::ships
  double km{};          ///< length of the route
  double kwh{};         ///< energy; 0 without RescueProblem::energy
  double hours{};       ///< time under way and at work; 0 without RescueProblem::energy
  std::vector<RescueOrder> orders;
  std::vector<TimedCell> path;
};

/// Outcome of a plan for one device. Times are in seconds after the start of the plan.
struct DeviceOutcome {
  std::int32_t ship{kNone};  ///< ship that delivers the device; kNone: no ship delivers it
  std::int32_t port{kNone};  ///< port of the delivery
  double fetch_s{};          ///< end of the pickup; if aboard at the start: RescueShip::ready_s
  double deliver_s{};        ///< end of the delivery
  double home{};             ///< probability that the device reaches a port
  /// By ring: probability that the device is in port before the ring reaches its site, or that it
  /// is in port and the ring never reaches its site.
  std::vector<double> home_before;
  double mean_loss{};
  double mean_loss_idle{};  ///< mean loss if no ship leaves
};

/// Orders of all ships, and their outcome.
struct RescuePlan {
  std::vector<ShipRoute> routes;         ///< one for each ship that leaves
  std::vector<DeviceOutcome> devices;    ///< by device
  std::vector<float> loss;               ///< by member, in the unit of the devices' values
  std::vector<float> loss_idle;          ///< by member: loss if no ship leaves
  std::vector<std::uint8_t> home_count;  ///< by member: number of devices delivered by ships
  double saved{};                        ///< mean loss if no ship leaves minus mean loss
  double bound{};                        ///< upper bound of `saved` over all plans
  double cost{};                         ///< cost of energy and ship-hours
  /// With risk_averse: upper bound of the difference between the objective of this plan and the
  /// smallest objective of any plan of the kind in rescue_plan.h. The objective is the mean loss of
  /// the worst members plus the cost. Infinity if the search was not exhaustive. Without
  /// risk_averse: 0.
  double averse_gap{};
  bool is_exhaustive{};  ///< whether the search was exhaustive (rescue_plan.h)
};

/// Rule by which a ship without a plan chooses the next device.
enum class FetchRule : std::uint8_t {
  kValue,    ///< the most valuable remaining device
  kNearest,  ///< the nearest remaining device
};

}  // namespace aquafarm::agents
