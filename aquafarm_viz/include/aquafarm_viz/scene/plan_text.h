// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A rescue plan as text for the panel, independent of Qt and nodes.

#include <aquafarm_msgs/RescuePlan.h>

#include <string>
#include <vector>

namespace aquafarm_viz {

using PlanRow = std::vector<std::string>;

/// Returns the outcome, the time from which no ship should leave, and what is outdated.
std::string PlanHeadline(const aquafarm_msgs::RescuePlan& plan);

/// Column titles of the tables. Each row has the same number of entries.
const PlanRow& PlanShipColumns();
const PlanRow& PlanDeviceColumns();

/// Returns the next order of each ship at a time of the ranch: {"ship 1", "fetch D3", "14:05",
/// "87 %"}.
std::vector<PlanRow> PlanShips(const aquafarm_msgs::RescuePlan& plan, ros::Time now);

/// Returns the probability of each device to come home, and its deadlines: the latest departures
/// for 95, 80 and 50 %.
std::vector<PlanRow> PlanDevices(const aquafarm_msgs::RescuePlan& plan);

/// Returns a local time, with day if it is not that of the plan's start: "14:05", "25 Jul 02:10".
std::string PlanTime(const aquafarm_msgs::RescuePlan& plan, ros::Time time);

}  // namespace aquafarm_viz
