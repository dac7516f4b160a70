// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// V_π and best moves as standard messages, for rviz, Foxglove and bags.

#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "aquafarm/agents/evaluation/greedy_actions.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm_agents {

/// 0 the lowest of the values … 100 the highest; -1 where there is none. All -1 without values.
nav_msgs::OccupancyGrid ValuesToGrid(const std::vector<aquafarm::agents::BestMove>& moves,
                                     const aquafarm::Scenario& scenario,
                                     const std_msgs::Header& header);

/// A point for each cell: float32 x, y, z [m] of its centre, float32 value as it is (NaN: none),
/// uint8 action as in FarmState.
sensor_msgs::PointCloud2 ValuesToPoints(const std::vector<aquafarm::agents::BestMove>& moves,
                                        const aquafarm::Scenario& scenario,
                                        const std_msgs::Header& header);

}  // namespace aquafarm_agents
