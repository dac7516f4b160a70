// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/Marker.h>

namespace aquafarm_viz {

/// Adds the 9 points of a flat arrow, a shaft and a head, to a triangle list.
/// @param x, y  middle of the arrow [cells]
/// @param cell_m  side of a cell [m]
/// @param bearing_deg  direction, clockwise from north
/// @param size  the arrow is 0.7 * size cells long
void AddArrow(visualization_msgs::Marker& marker, double x, double y, int bearing_deg,
              double cell_m, double size = 1.0);

/// Adds the 24 points of a square frame to a triangle list. The frame is just inside the border of
/// cell (x, y). A symbol in the cell does not cover the corners of the frame.
void AddFrame(visualization_msgs::Marker& marker, double x, double y, double cell_m);

}  // namespace aquafarm_viz
