// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Positions at which ships and delivered devices in a port are drawn, so that the port stays
/// visible; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <opencv2/core/types.hpp>

namespace aquafarm_viz {

/// Returns on which side of a port in row y its delivered devices are drawn: 1 north, -1 south. It
/// is the side towards the middle of the farm.
inline int DeliveredSide(const aquafarm_msgs::FarmSpec& spec, int y) {
  return 2 * y >= spec.height ? -1 : 1;
}

/// Returns the position at which ships in a cell are drawn [cells]. In a cell without a port this
/// is the cell itself. At a port it is one of four diagonal positions next to the port. The chosen
/// position is the farthest from other ports, deployed devices and ships in other cells; distances
/// above 2 cells count as 2. Positions on water are preferred to positions on land, and positions
/// on land to positions off the map.
/// @param aside  distance from the port along each axis [cells]
cv::Point2d ShipPlace(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      int x, int y, double aside);

}  // namespace aquafarm_viz
