// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A rescue plan (plan.json) as messages. The functions need no ROS node.

#include <aquafarm_msgs/RescuePlan.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>

#include <cstdint>
#include <string>

namespace aquafarm_agents {

/// A plan file as messages.
struct PlanMessages {
  aquafarm_msgs::RescuePlan plan;  ///< without header, fault, follows_ranch, episode and step
  nav_msgs::OccupancyGrid chart;   ///< land and rocks are 100, water is 0; without header
};

/// Converts the content of a plan file (plan.schema.json). A null becomes NaN, time 0, id -1,
/// grade 0 or an empty string, depending on the field.
/// @param where name of the file for errors
/// @throws InputError "plan.json: …; expected a plan file of version 1, …"
PlanMessages ReadPlan(const std::string& json, const std::string& where);

/// Returns the route of a ship, with the header of the plan. Each entry of RescueRoute.path becomes
/// a pose [m], stamped with the time of that entry. A ship without a route has no poses.
///
/// A pose points to the next cell. The path lists the cell of a stop twice, on arrival and on
/// departure. The pose on arrival and the last pose of the route point to the east.
nav_msgs::Path PathOfShip(const aquafarm_msgs::RescuePlan& plan, std::int32_t ship);

}  // namespace aquafarm_agents
