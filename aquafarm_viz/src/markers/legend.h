// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend below the map in rviz; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

namespace aquafarm_viz {

/// Adds a scale bar, the colours of risks and north, in the namespaces `legend` and `legend_text`.
void AddLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec);

}  // namespace aquafarm_viz
