// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Ticks of the axes of a map, in minutes of arc or in cells; private to this package.

#include <aquafarm_msgs/FarmSpec.h>

#include <vector>

namespace aquafarm_viz {

/// A tick of an axis in latitude or longitude.
struct ArcTick {
  int minutes{};  ///< latitude or longitude [minutes of arc]; negative in the south or west
  double at{};    ///< distance from the western or southern edge of the farm [cells]
};

/// Returns true if the axes of a farm show longitude and latitude: the farm has a geographic
/// position, and the latitude of cell (0, 0) is less than 85 degrees north or south.
bool HasGraticule(const aquafarm_msgs::FarmSpec& spec);

/// Returns the ticks of longitude, at least `min_cells` apart. HasGraticule must be true. The scale
/// is that at the latitude of cell (0, 0), so it fits the southern edge of the map. 100 km farther
/// north at latitude 30 degrees, a degree of longitude is 0.9 % shorter.
std::vector<ArcTick> LongitudeTicks(const aquafarm_msgs::FarmSpec& spec, double min_cells);

/// Returns the ticks of latitude, at least `min_cells` apart. HasGraticule must be true.
std::vector<ArcTick> LatitudeTicks(const aquafarm_msgs::FarmSpec& spec, double min_cells);

/// Returns the tick spacing of an axis in cells: the smallest of 1, 2, 5, 10, 20, 50, … that is at
/// least `min_cells`.
int CellTickStep(double min_cells);

}  // namespace aquafarm_viz
