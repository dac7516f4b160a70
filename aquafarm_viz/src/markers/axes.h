// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The axes of the farm in rviz; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

#include "markers/maker.h"

namespace aquafarm_viz {

/// Adds longitude below the farm and latitude on its left, such as "122-36E" (rviz's font has no
/// sign of a degree), in the namespace `axis`; cells on a farm without a geographic position.
void AddAxes(visualization_msgs::MarkerArray& array, const Maker& maker,
             const aquafarm_msgs::FarmSpec& spec);

}  // namespace aquafarm_viz
