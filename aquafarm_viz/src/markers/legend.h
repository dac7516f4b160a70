// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Adds the legend below the map in rviz; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

#include "aquafarm_viz/scene/values.h"

namespace aquafarm_viz {

/// Adds a scale bar and the colours of risks, in the namespaces `legend` and `legend_text`.
void AddLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec);

/// The signs that AddSignLegend explains.
struct MapSigns {
  bool circle{};       ///< circle around a device in danger
  bool two_circles{};  ///< two circles around a device that is hit first
  bool pointer{};      ///< pointer to a centre outside the farm
  bool pattern{};      ///< pattern of rings over the farm
  bool dashes{};       ///< dashed path of a ship with nothing aboard
};

/// Adds a second line with the meanings of these signs, in the namespaces `sign_legend` and
/// `sign_legend_text`. Deletes the markers of the other signs.
void AddSignLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec,
                   const MapSigns& signs);

/// Adds a third line, in the namespaces `value_legend` and `value_legend_text`: the range and the
/// colours of values, the arrow of a best move, and the frames of pickups and drop-offs. Deletes
/// the markers of the values if all values are equal, and those of a frame whose action does not
/// occur.
void AddValueLegend(visualization_msgs::MarkerArray& array, const aquafarm_msgs::FarmSpec& spec,
                    const Values& values);

}  // namespace aquafarm_viz
