// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The shortest way by water from every cell to a place, as a chart plotter knows it: breadth-first
/// search over the 8 moves, around islands and rocks. Ships and disasters are not on a chart.

#include <cstdint>
#include <vector>

#include "aquafarm/grid/grid.h"

namespace aquafarm {

/// Further than any way on a map of a million cells.
inline constexpr std::int32_t kUnreachable = 1 << 28;

/// Moves by water from every cell of a chart to the nearest of `count` targets; kUnreachable on
/// land and where no water leads.
/// @param cells [H, W] CellBits
/// @param steps [H, W] is resized; no memory is allocated when it and `queue` have been so large
void StepsByWater(const Grid<std::uint8_t>& cells, const Cell* targets, std::size_t count,
                  Grid<std::int32_t>& steps, std::vector<Cell>& queue);

/// The way from one cell to one place: the next move and how many are left, of several shortest
/// ways the one whose next cell is nearest to the place as the crow flies.
struct Way {
  std::int32_t steps{kUnreachable};
  std::int8_t east{};  ///< of the next move; both 0 at the place and where no way leads to it
  std::int8_t north{};
};

/// Charts the ways from every cell to `target` into every `stride`-th of `ways`, by linear index.
/// @param ways [H · W · stride]
/// @param steps and `queue`: scratch, as in StepsByWater
void ChartWays(const Grid<std::uint8_t>& cells, Cell target, Way* ways, std::size_t stride,
               Grid<std::int32_t>& steps, std::vector<Cell>& queue);

}  // namespace aquafarm
