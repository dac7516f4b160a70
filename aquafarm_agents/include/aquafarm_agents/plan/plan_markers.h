// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A rescue plan as rviz markers in frame map, in metres, above the markers of the ranch.
///
///     | namespace    | id           | content                                             |
///     | plan_route   | ship         | route of a ship, in its colour                      |
///     | plan_ship    | ship         | name, departure; without a route: what to do        |
///     | plan_device  | device       | name; probability to come home and pickup, if any   |
///     | plan_port    | port         | name                                                |
///     | plan_track   | 0, 1         | recorded and later positions of the storm           |
///     | plan_cone    | point        | circle that holds 70 % of the possible centres      |
///     | plan_hour    | point        | lead time and local time of that circle             |
///     | plan_outcome | 0            | RescuePlan.text, and RescuePlan.fault if it is set  |
///
/// A point is an index in RescuePlan.forecast_error.

#include <aquafarm_msgs/RescuePlan.h>
#include <visualization_msgs/MarkerArray.h>

namespace aquafarm_agents {

/// Returns the markers of a plan. The first one deletes the markers of the previous plan.
visualization_msgs::MarkerArray PlanMarkers(const aquafarm_msgs::RescuePlan& plan);

}  // namespace aquafarm_agents
