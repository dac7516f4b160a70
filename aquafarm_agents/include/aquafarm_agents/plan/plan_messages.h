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
  nav_msgs::OccupancyGrid chart;   ///< 100 land and rocks, 0 water, as topic chart; without header
};

/// Converts the content of a plan file (plan.schema.json). A null becomes NaN, time 0 or id -1.
/// @param where name of the file for errors
/// @throws InputError "plan.json: ...; expected a plan file of version 1"
PlanMessages ReadPlan(const std::string& json, const std::string& where);

/// Returns the route of a ship: a pose in frame map [m] for each cell, with the time of entering
/// the cell as stamp. There are no poses if the ship stays. Each pose points to the next cell, the
/// last one to the east.
nav_msgs::Path PathOfShip(const aquafarm_msgs::RescuePlan& plan, std::int32_t ship);

}  // namespace aquafarm_agents
