// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A rescue plan as rviz markers. Positions are in metres, above the markers of the ranch.
///
///     | namespace    | id           | content                                             |
///     | plan_route   | ship         | route of a ship, in its colour                      |
///     | plan_ship    | ship         | name; departure, or what to do without a route      |
///     | plan_device  | device       | name; probability of delivery, ship, pickup time    |
///     | plan_port    | port         | name                                                |
///     | plan_track   | 0, 1         | recorded and later positions of the storm           |
///     | plan_cone    | point        | circle around 70 % of the possible storm centres    |
///     | plan_hour    | point        | lead time and local time of that circle             |
///     | plan_outcome | 0            | RescuePlan.text, and RescuePlan.fault if it is set  |
///
/// A point is an index in RescuePlan.forecast_error. If no ship fetches a device, its name is
/// followed by "stays" or "left behind". If the result of the plan is STORM_UNKNOWN, the name of
/// each device is followed by "odds unknown".

#include <aquafarm_msgs/RescuePlan.h>
#include <visualization_msgs/MarkerArray.h>

namespace aquafarm_agents {

/// Returns the markers of a plan, with the header of the plan. The first marker deletes those of
/// the previous plan. It is the only marker if there is no plan yet (RescuePlan.width is 0).
visualization_msgs::MarkerArray PlanMarkers(const aquafarm_msgs::RescuePlan& plan);

}  // namespace aquafarm_agents
