// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A rescue plan as rviz markers in frame map, in metres, above those of the ranch.
///
///     | namespace    | id           | content                                             |
///     | plan_route   | ship         | route of a ship, in its colour                      |
///     | plan_ship    | ship         | name of the ship and its departure                  |
///     | plan_device  | device       | name, probability to come home, time of the pickup  |
///     | plan_port    | port         | name                                                |
///     | plan_track   | 0, 1         | recorded and later positions of the storm           |
///     | plan_cone    | lead time    | circle that holds the centre of 70 % of the storms  |
///     | plan_hour    | lead time    | its lead time and local time                        |
///     | plan_outcome | 0            | outcome, and what is outdated                       |

#include <aquafarm_msgs/RescuePlan.h>
#include <visualization_msgs/MarkerArray.h>

namespace aquafarm_agents {

/// Returns the markers of a plan; the first one deletes those of the plan before.
visualization_msgs::MarkerArray PlanMarkers(const aquafarm_msgs::RescuePlan& plan);

}  // namespace aquafarm_agents
