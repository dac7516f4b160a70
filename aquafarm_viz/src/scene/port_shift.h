// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where a port is shown while a ship covers it; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <opencv2/core/types.hpp>

namespace aquafarm_viz {

/// Returns where the devices delivered at a port in row y stand: 1 north of it, -1 south, always
/// towards the middle of the farm.
inline int DeliveredSide(const aquafarm_msgs::FarmSpec& spec, int y) {
  return 2 * y >= spec.height ? -1 : 1;
}

/// Returns the direction in which a port's disc is shown: (0, 0) if no ship is in its cell, else
/// towards the diagonal neighbour (x to the east, y to the north) that is farthest from other
/// ports, ships and deployed devices; 2 cells are enough.
cv::Point PortShift(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                    const aquafarm_msgs::PortInfo& port);

}  // namespace aquafarm_viz
