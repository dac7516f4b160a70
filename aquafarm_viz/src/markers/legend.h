// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend below the map in rviz; for the nodes of this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

#include "aquafarm_viz/scene/values.h"

namespace aquafarm_viz {

/// Adds a scale bar, the colours of risks and north, in the namespaces `legend` and `legend_text`.
void AddLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec);

/// Adds the symbols of danger: of a device, and of a disaster's centre and motion, a line below the
/// legend, in the namespaces `sign_legend` and `sign_legend_text`.
void AddSignLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec);

/// Adds the range and colours of values and the symbols of best moves, two lines below the legend,
/// in the namespaces `value_legend` and `value_legend_text`.
void AddValueLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec,
                    const Values& values);

}  // namespace aquafarm_viz
