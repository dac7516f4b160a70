// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Copies a farm for each cell that ship 0 can occupy and places ship 0 there. Up to kCellsAtOnce
/// copies form one environment, so that a policy chooses the actions for many cells at once.

#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

constexpr std::size_t kCellsAtOnce = 64;

/// Returns the cells that ship 0 can occupy, row by row from the south-west.
inline std::vector<Cell> FreeCells(const Farm& farm) {
  std::vector<Cell> cells;
  for (std::int32_t y = 0; y < farm.scenario().height; ++y) {
    for (std::int32_t x = 0; x < farm.scenario().width; ++x) {
      if (farm.CanPlaceShip(0, {x, y})) cells.push_back({x, y});
    }
  }
  return cells;
}

/// Makes farm i of `farms` a copy of `farm` with ship 0 in cells[first + i]. Returns the results.
inline const StepResults& PlaceInEach(const Farm& farm, const std::vector<Cell>& cells,
                                      std::size_t first, LocalEnvironment& farms) {
  return farms.Change([&](std::size_t i, Farm& one) {
    one.CopyStateFrom(farm);
    one.PlaceShip(0, cells[first + i]);
  });
}

}  // namespace aquafarm::agents
