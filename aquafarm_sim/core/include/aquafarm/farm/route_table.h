// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Shortest routes by water from every cell to a target: a breadth-first search over the eight
/// moves, around islands and rocks. Ships and disasters are ignored.

#include <cstdint>
#include <vector>

#include "aquafarm/grid/grid.h"

namespace aquafarm {

/// Stands for the number of moves if there is no route; larger than the number of any route.
inline constexpr std::int32_t kUnreachable = 1 << 28;

/// Computes the number of moves by water from every cell of a chart to the nearest of `count`
/// targets. On islands and rocks, and where no route exists, the number is kUnreachable.
/// @param cells [H, W] CellBits
/// @param targets [count] cells of the chart
/// @param steps [H, W] result; resized
/// @param queue scratch memory. Nothing is allocated if `steps` already has its size and the
///   capacity of `queue` is at least H · W.
void StepsByWater(const Grid<std::uint8_t>& cells, const Cell* targets, std::size_t count,
                  Grid<std::int32_t>& steps, std::vector<Cell>& queue);

/// The next move of a shortest route from a cell to a target, and the number of moves left. If
/// several moves are on shortest routes, the entry has the move to the cell with the smallest
/// straight-line distance to the target.
struct RouteEntry {
  std::int32_t steps{kUnreachable};  ///< moves left; 0 at the target
  /// Eastward component of the next move: -1, 0 or 1. 0 at the target, or if there is no route.
  std::int8_t east{};
  std::int8_t north{};  ///< northward component, as `east`
};

/// Computes the routes from every cell to `target`. The route of the cell with linear index i is
/// written to routes[i * stride].
/// @param cells [H, W] CellBits
/// @param routes first element to write; the array has (H · W - 1) · stride + 1 or more elements
/// @param steps, queue scratch memory, as in StepsByWater
void ComputeRoutes(const Grid<std::uint8_t>& cells, Cell target, RouteEntry* routes,
                   std::size_t stride, Grid<std::int32_t>& steps, std::vector<Cell>& queue);

}  // namespace aquafarm
