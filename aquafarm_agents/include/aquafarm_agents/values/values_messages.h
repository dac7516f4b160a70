// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Values (V_π) and greedy actions by cell as standard messages, for rviz, Foxglove and bags.

#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "aquafarm/agents/evaluation/greedy_actions.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm_agents {

/// Returns the grid of values, scaled from 0 (lowest) to 100 (highest). Cells without a value are
/// -1.
nav_msgs::OccupancyGrid ValuesToGrid(const std::vector<aquafarm::agents::GreedyAction>& moves,
                                     const aquafarm::Scenario& scenario,
                                     const std_msgs::Header& header);

/// Returns one point per entry of `moves`: float32 x, y, z [m] of the cell's centre (z is 0),
/// float32 value in the unit of the rewards (NaN: no value), uint8 action as in ShipState.
sensor_msgs::PointCloud2 ValuesToPoints(const std::vector<aquafarm::agents::GreedyAction>& moves,
                                        const aquafarm::Scenario& scenario,
                                        const std_msgs::Header& header);

}  // namespace aquafarm_agents
