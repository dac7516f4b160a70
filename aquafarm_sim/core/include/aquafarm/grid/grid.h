// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "aquafarm/grid/cell.h"

namespace aquafarm {

/// A layer of the farm: H rows (y) × W columns (x), row-major. The value of cell (x, y) is
/// grid(y, x), which is data()[y * W + x].
template <typename T>
using Grid = Eigen::Array<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the position of a cell in row-major data.
constexpr std::int32_t LinearIndex(Cell cell, std::int32_t width) {
  return cell.y * width + cell.x;
}

/// Returns the Chebyshev distance: the number of moves between two cells on open water. A diagonal
/// move counts as one.
constexpr std::int32_t MovesBetween(Cell a, Cell b) {
  const std::int32_t dx = a.x < b.x ? b.x - a.x : a.x - b.x;
  const std::int32_t dy = a.y < b.y ? b.y - a.y : a.y - b.y;
  return dx < dy ? dy : dx;
}

}  // namespace aquafarm
