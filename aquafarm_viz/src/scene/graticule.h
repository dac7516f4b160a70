// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Ticks of the axes of a map: minutes of arc, or cells; private to this package.

#include <aquafarm_msgs/FarmSpec.h>

#include <vector>

namespace aquafarm_viz {

/// A tick of an axis in latitude or longitude.
struct ArcTick {
  int minutes{};  ///< of arc; negative in the south or west
  double at{};    ///< from the western or southern edge of the farm [cells]
};

/// Returns whether the axes of a farm are longitude and latitude.
bool HasGraticule(const aquafarm_msgs::FarmSpec& spec);

/// Returns the ticks of longitude, at least `min_cells` apart. The farm has a graticule.
/// The plane touches the ellipsoid at cell (0, 0): over 100 km the error is below 1 % of the
/// distance.
std::vector<ArcTick> LongitudeTicks(const aquafarm_msgs::FarmSpec& spec, double min_cells);

/// Returns the ticks of latitude, as LongitudeTicks.
std::vector<ArcTick> LatitudeTicks(const aquafarm_msgs::FarmSpec& spec, double min_cells);

/// Returns the tick spacing of an axis of cells: 1, 2 or 5 times a power of ten, at least
/// `min_cells`.
int CellTickStep(double min_cells);

}  // namespace aquafarm_viz
