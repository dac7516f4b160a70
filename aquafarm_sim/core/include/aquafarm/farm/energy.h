// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The energy that a ship or a self-propelled device consumes in one step:
///
///   idle_per_step + per_km · distance · (1 + per_device · aboard) · (1 + rough_sea · risk / -20)
///
/// The distance is that between the cells' centres: a diagonal move covers √2 cells. A move that
/// does not leave its cell (edge, crash, collision) covers none. The risk is that at the cell of
/// the ship after its action, as in the reward. See docs/model.md.

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

/// Returns the energy of one step [kWh]. @param distance_km travelled in the step
/// @param aboard devices aboard @param risk at the cell reached, 0 or negative
inline double EnergyOf(const EnergyFigures& figures, double distance_km, std::int32_t aboard,
                       float risk) {
  const double load = 1.0 + figures.per_device * aboard;
  const double sea =
      1.0 + figures.rough_sea * static_cast<double>(risk) / static_cast<double>(kWorstRisk);
  return figures.idle_per_step + figures.per_km * distance_km * load * sea;
}

}  // namespace aquafarm
