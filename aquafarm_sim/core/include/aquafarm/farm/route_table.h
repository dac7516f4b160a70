// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Shortest routes by water from every cell to a target, as shown by a chart plotter: breadth-first
/// search over the 8 moves, around islands and rocks. Ships and disasters are ignored.

#include <cstdint>
#include <vector>

#include "aquafarm/grid/grid.h"

namespace aquafarm {

/// Distance of unreachable cells; longer than any route on a map of a million cells.
inline constexpr std::int32_t kUnreachable = 1 << 28;

/// Computes the number of moves by water from every cell of a chart to the nearest of `count`
/// targets; kUnreachable on land and where no route exists.
/// @param cells [H, W] CellBits
/// @param steps [H, W], resized; nothing is allocated if `steps` and `queue` are large enough
void StepsByWater(const Grid<std::uint8_t>& cells, const Cell* targets, std::size_t count,
                  Grid<std::int32_t>& steps, std::vector<Cell>& queue);

/// The route from one cell to one target: the next move and the number of moves left. Of several
/// shortest routes, the one whose next cell is nearest to the target in a straight line.
struct RouteEntry {
  std::int32_t steps{kUnreachable};
  std::int8_t east{};  ///< next move; both 0 at the target and where no route exists
  std::int8_t north{};
};

/// Writes the routes from every cell to `target` to every `stride`-th element of `routes`, by
/// linear index.
/// @param routes [H · W · stride]
/// @param steps scratch, like `queue`, as in StepsByWater
void ComputeRoutes(const Grid<std::uint8_t>& cells, Cell target, RouteEntry* routes,
                   std::size_t stride, Grid<std::int32_t>& steps, std::vector<Cell>& queue);

}  // namespace aquafarm
