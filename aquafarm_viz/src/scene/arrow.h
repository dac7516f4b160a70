// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/Marker.h>

namespace aquafarm_viz {

/// Adds a flat arrow of a head and a shaft to a triangle list: 9 points around (x, y) [cells],
/// 0.7 * size cells long, pointing along a bearing.
void AddArrow(visualization_msgs::Marker& marker, double x, double y, int bearing_deg,
              double cell_m, double size = 1.0);

/// Adds a frame inside the border of the cell (x, y) to a triangle list: 24 points. The symbol of a
/// device or a port in the cell leaves its corners visible.
void AddFrame(visualization_msgs::Marker& marker, double x, double y, double cell_m);

}  // namespace aquafarm_viz
