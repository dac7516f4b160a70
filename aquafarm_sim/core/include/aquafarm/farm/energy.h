// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The energy that a ship or a self-propelled device consumes in one step:
///
///   idle_per_step + per_km · distance · (1 + per_device · aboard) · (1 + rough_sea · risk / -20)
///
/// `distance` is the distance travelled in the step [km]: √2 cells for a diagonal move, and 0 for a
/// ship that stays in its cell, for example because it crashes. `aboard` is the number of devices
/// aboard, and `risk` is the risk at the cell of the ship, both after the action. The other names
/// are fields of EnergyFigures. See docs/model.md.

#include <cmath>

#include "aquafarm/grid/action.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Returns the length of a move [cells]; 0 for an action that is not a move.
inline double MoveLength(Action action) {
  if (action >= Action::kPickup) return 0.0;
  const Cell move = kMoves[static_cast<std::size_t>(action)];
  return move.x != 0 && move.y != 0 ? 1.4142135623730951 : 1.0;
}

/// Returns the energy of one step [kWh].
/// @param distance_km distance travelled in the step
/// @param aboard number of devices aboard after the action
/// @param risk risk at the cell after the action, 0 or negative
inline double EnergyOf(const EnergyFigures& figures, double distance_km, std::int32_t aboard,
                       float risk) {
  const double load = 1.0 + figures.per_device * aboard;
  const double sea =
      1.0 + figures.rough_sea * static_cast<double>(risk) / static_cast<double>(kWorstRisk);
  return figures.idle_per_step + figures.per_km * distance_km * load * sea;
}

}  // namespace aquafarm
