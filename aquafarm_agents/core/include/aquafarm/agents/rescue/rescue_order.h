// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Orders to a ship, and the positions on its route.

#include <cstdint>
#include <string_view>
#include <vector>

#include "aquafarm/grid/action.h"
#include "aquafarm/grid/cell.h"

namespace aquafarm::agents {

/// What a ship does: leave its cell, fetch one device, or deliver all devices aboard at a port.
enum class OrderKind : std::uint8_t { kLeave, kFetch, kDeliver };
inline constexpr int kOrderKindCount = 3;
/// Returns "leave", "fetch" or "deliver".
std::string_view ToString(OrderKind value);

/// An order to a ship.
struct RescueOrder {
  OrderKind kind{};
  double time_s{};             ///< departure, or end of handling [s after the start of the plan]
  Cell cell{};                 ///< where the order is carried out
  std::int32_t device{kNone};  ///< fetch: index of the device
  std::int32_t port{kNone};    ///< deliver, or leave from a port: index of the port; else kNone
  std::vector<std::int32_t> devices;  ///< deliver: indices of the devices that the ship unloads
  double km{};                        ///< distance since the previous order [km]
  double kwh{};          ///< energy since the previous order [kWh]; 0 without RescueProblem::energy
  double probability{};  ///< share of the ensemble members in which it is carried out
};

/// A cell on the route of a ship.
struct TimedCell {
  Cell cell{};
  double time_s{};  ///< time at which the ship enters the cell [s after the start of the plan]
};

}  // namespace aquafarm::agents
