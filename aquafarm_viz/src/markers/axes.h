// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Adds the axes of the farm in rviz; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

#include "markers/maker.h"

namespace aquafarm_viz {

/// Adds ticks and names of longitude below the farm and of latitude on its left, in the namespace
/// `axis`. Names have the form "122-36E", because rviz's font has no degree sign. If HasGraticule
/// is false, the axes are in cells.
void AddAxes(visualization_msgs::MarkerArray& array, const Maker& maker,
             const aquafarm_msgs::FarmSpec& spec);

}  // namespace aquafarm_viz
