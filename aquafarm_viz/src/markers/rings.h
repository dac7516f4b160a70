// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The rings of disasters in rviz: bands, edges and the pattern that marks the kind of disaster.
/// They are clipped to the farm. Private to this package.

#include <aquafarm_msgs/DisasterState.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/MarkerArray.h>

namespace aquafarm_viz {

class Maker;

/// Adds the markers `ring`, `ring_edge` and `ring_pattern` of a disaster. Deletes those of which no
/// part lies on the farm.
/// @param is_drawn  false: deletes all of them
void AddRings(visualization_msgs::MarkerArray& array, const Maker& maker,
              const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::DisasterState& disaster,
              bool is_drawn);

}  // namespace aquafarm_viz
