// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where ships in a port are shown, so that the port stays visible; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <opencv2/core/types.hpp>

namespace aquafarm_viz {

/// Returns where the devices delivered at a port in row y stand: 1 north of it, -1 south, always
/// towards the middle of the farm.
inline int DeliveredSide(const aquafarm_msgs::FarmSpec& spec, int y) {
  return 2 * y >= spec.height ? -1 : 1;
}

/// Returns the position at which ships in a cell are drawn [cells]: the cell, or if it has a port,
/// `aside` cells towards the diagonal neighbour that is farthest from other ports, ships and
/// deployed devices (distances above 2 cells count as 2);
/// on land or off the map only if all are.
/// @param aside  distance from the port along each axis [cells]
cv::Point2d ShipPlace(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      int x, int y, double aside);

}  // namespace aquafarm_viz
