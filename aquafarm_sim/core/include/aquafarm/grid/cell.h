// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Axes and units of the farm, and the cells of its grid.
///
///        y (north)
///        ^        (0, H-1) . . . (W-1, H-1)
///        |           .               .        linear index = y * W + x,
///        |         (0, 0)  . . . (W-1, 0)     as in nav_msgs/OccupancyGrid; image row 0 is north
///        +------> x (east)
///
/// Lengths are in cells and times in steps, unless a name or comment states another unit. Source:
/// §2.4 and Eq. 1 of the paper, see docs/model.md.

#include <cstdint>

namespace aquafarm {

/// A grid cell; its centre has the integer coordinates (x, y).
struct Cell {
  std::int32_t x{};
  std::int32_t y{};
  friend constexpr bool operator==(Cell a, Cell b) { return a.x == b.x && a.y == b.y; }
  friend constexpr bool operator!=(Cell a, Cell b) { return !(a == b); }
};

}  // namespace aquafarm
