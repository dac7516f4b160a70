// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The shortest way by water from every cell to a place, as a chart plotter knows it: breadth-first
/// search over the 8 moves, around islands and rocks. Ships and disasters are not on a chart.

#include <cstdint>
#include <vector>

#include "aquafarm/grid.h"

namespace aquafarm {

/// Further than any way on a map of a million cells.
inline constexpr std::int32_t kUnreachable = 1 << 28;

/// Moves by water from every cell of a chart to the nearest of `count` targets; kUnreachable on
/// land and where no water leads.
/// @param cells [H, W] CellBits
/// @param steps [H, W] is resized; no memory is allocated when it and `queue` have been so large
void StepsByWater(const Grid<std::uint8_t>& cells, const Cell* targets, std::size_t count,
                  Grid<std::int32_t>& steps, std::vector<Cell>& queue);

/// The ways from every cell to one place.
struct Waterway {
  Grid<std::int32_t> steps;  ///< [H, W] moves that are left
  /// [H, W] index into kMoves of the next move, of several the one that ends nearest to the place
  /// as the crow flies, then the first; kNoMove at the place and where none leads to it.
  Grid<std::uint8_t> move;
};
inline constexpr std::uint8_t kNoMove = 255;

/// Charts the ways to `target`. @param way and `queue` as in StepsByWater
void ChartWaterway(const Grid<std::uint8_t>& cells, Cell target, Waterway& way,
                   std::vector<Cell>& queue);

}  // namespace aquafarm
