// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A rescue plan as text for the panel, independent of Qt and nodes.

#include <aquafarm_msgs/RescuePlan.h>

#include <string>
#include <vector>

namespace aquafarm_viz {

using PlanRow = std::vector<std::string>;

/// Silence of plan_node after which its plan counts as no longer renewed [s]. Its heartbeat has a
/// period of 1 s.
inline constexpr double kPlanSilence_s = 5.0;

/// Returns the outcome, the time from which no ship should leave, and what is outdated.
/// @param silent_s time since the last plan or heartbeat of plan_node [s]
std::string PlanHeadline(const aquafarm_msgs::RescuePlan& plan, double silent_s);

/// Column titles of the tables. Each row has the same number of entries.
const PlanRow& PlanShipColumns();
const PlanRow& PlanDeviceColumns();

/// Returns the next order of each ship at a time of the ranch: {"ship 1", "fetch D3", "14:05",
/// "87 %"}.
std::vector<PlanRow> PlanShips(const aquafarm_msgs::RescuePlan& plan, ros::Time now);

/// Returns the probability of each device to come home, and its deadlines: the latest departures
/// for 95, 80 and 50 %.
std::vector<PlanRow> PlanDevices(const aquafarm_msgs::RescuePlan& plan);

}  // namespace aquafarm_viz
