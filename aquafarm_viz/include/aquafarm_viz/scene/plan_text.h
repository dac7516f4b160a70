// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The texts of a rescue plan in the panel. This code requires neither Qt nor a ROS node.

#include <aquafarm_msgs/RescuePlan.h>

#include <string>
#include <vector>

namespace aquafarm_viz {

/// The texts of one row of a table.
using PlanRow = std::vector<std::string>;

/// The panel warns that the plan is not renewed if it has received neither a plan nor a heartbeat
/// of plan_node for this time [s]. The heartbeat has a period of 1 s.
inline constexpr double kPlanSilence_s = 5.0;

/// Returns the result of the plan. Further texts follow if they apply: the time after which no ship
/// should leave, or until which ships may leave; the warnings of severity "stop"; why the plan is
/// outdated; for how long plan_node has been silent (kPlanSilence_s).
/// @param silent_s time since the last plan or heartbeat of plan_node [s]
std::string PlanHeadline(const aquafarm_msgs::RescuePlan& plan, double silent_s);

/// Returns the column titles of the table of PlanShips. Rows have the same number of entries.
const PlanRow& PlanShipColumns();
/// Returns the column titles of the table of PlanDevices.
const PlanRow& PlanDeviceColumns();

/// Returns a row for each ship: its name, its next order, and the time and the probability of this
/// order, {"ship 1", "fetch F3", "14:05", "87 %"}. For a ship without a route the second text is
/// WithoutRouteText, and for a ship without further orders "all done". Time and probability are
/// then empty.
/// @param now world time [UTC]; earlier orders are skipped
std::vector<PlanRow> PlanShips(const aquafarm_msgs::RescuePlan& plan, ros::Time now);

/// Returns a row for each device. After its name follows the probability that a ship brings it to a
/// port, or "stays", "left behind" or "unknown". Then follow three deadlines: the latest departure
/// with which a ship that fetches this device before any other brings it to a port with a
/// probability of at least 95, 80 and 50 %.
std::vector<PlanRow> PlanDevices(const aquafarm_msgs::RescuePlan& plan);

}  // namespace aquafarm_viz
