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

/// Returns true if the axes of a map show longitude and latitude: the farm has a geographic
/// position, and cell (0, 0) is between 85 degrees south and 85 degrees north.
bool HasGraticule(const aquafarm_msgs::FarmSpec& spec);

/// Returns the ticks of longitude, at least `min_cells` but at most 10 degrees apart. HasGraticule
/// must be true. All ticks have the scale at the latitude of cell (0, 0), which is exact at the
/// southern edge of the map. For a farm at 30 degrees north, a degree of longitude is 0.9 % shorter
/// 100 km north of this edge.
std::vector<ArcTick> LongitudeTicks(const aquafarm_msgs::FarmSpec& spec, double min_cells);

/// Returns the ticks of latitude, at least `min_cells` but at most 10 degrees apart. HasGraticule
/// must be true.
std::vector<ArcTick> LatitudeTicks(const aquafarm_msgs::FarmSpec& spec, double min_cells);

/// Returns the tick spacing of an axis in cells: the smallest of 1, 2, 5, 10, 20, 50, … that is at
/// least `min_cells`.
int CellTickStep(double min_cells);

}  // namespace aquafarm_viz
