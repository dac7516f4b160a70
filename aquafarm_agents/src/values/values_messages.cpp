// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/values/values_messages.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aquafarm_agents {

using aquafarm::agents::GreedyAction;

nav_msgs::OccupancyGrid ValuesToGrid(const std::vector<GreedyAction>& moves,
                                     const aquafarm::Scenario& scenario,
                                     const std_msgs::Header& header) {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (const GreedyAction& move : moves) {
    if (!std::isfinite(move.value)) continue;
    lowest = std::min(lowest, move.value);
    highest = std::max(highest, move.value);
  }
  nav_msgs::OccupancyGrid grid;
  grid.header = header;
  grid.info.map_load_time = header.stamp;
  grid.info.resolution = static_cast<float>(scenario.cell_size_m);
  grid.info.width = static_cast<std::uint32_t>(scenario.width);
  grid.info.height = static_cast<std::uint32_t>(scenario.height);
  grid.info.origin.position.x = grid.info.origin.position.y = -0.5 * scenario.cell_size_m;
  grid.info.origin.orientation.w = 1.0;
  grid.data.assign(static_cast<std::size_t>(scenario.width) * grid.info.height, -1);
  const float range = std::max(highest - lowest, std::numeric_limits<float>::min());
  for (const GreedyAction& move : moves) {
    if (!std::isfinite(move.value)) continue;
    const auto share = std::lround(100.0F * (move.value - lowest) / range);
    grid.data[static_cast<std::size_t>(move.cell.y * scenario.width + move.cell.x)] =
        static_cast<std::int8_t>(share);
  }
  return grid;
}

sensor_msgs::PointCloud2 ValuesToPoints(const std::vector<GreedyAction>& moves,
                                        const aquafarm::Scenario& scenario,
                                        const std_msgs::Header& header) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(5, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "value", 1, PointField::FLOAT32, "action", 1,
                                PointField::UINT8);
  modifier.resize(moves.size());
  sensor_msgs::PointCloud2Iterator<float> at(cloud, "x");
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "value");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> action(cloud, "action");
  for (const GreedyAction& move : moves) {
    at[0] = static_cast<float>(move.cell.x * scenario.cell_size_m);
    at[1] = static_cast<float>(move.cell.y * scenario.cell_size_m);
    at[2] = 0.0F;
    *value = move.value;
    *action = move.action;
    ++at;
    ++value;
    ++action;
  }
  return cloud;
}

}  // namespace aquafarm_agents
