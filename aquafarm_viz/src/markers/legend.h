// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend below the map in rviz; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

#include "aquafarm_viz/scene/values.h"

namespace aquafarm_viz {

/// Adds a scale bar and the colours of risks, in the namespaces `legend` and `legend_text`.
void AddLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec);

/// Adds a second line, in the namespaces `sign_legend` and `sign_legend_text`: the circle around a
/// device in danger, the pointer to a centre, and the meanings of ring patterns and dashed paths.
void AddSignLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec);

/// Adds a third line, in the namespaces `value_legend` and `value_legend_text`: the range and the
/// colours of values, and the symbols of best moves.
void AddValueLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec,
                    const Values& values);

}  // namespace aquafarm_viz
