// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Messages of a small ranch, as the sim node publishes them.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

namespace aquafarm_viz::test {

inline aquafarm_msgs::Cell MakeCell(int x, int y) {
  aquafarm_msgs::Cell cell;
  cell.x = x;
  cell.y = y;
  return cell;
}

inline aquafarm_msgs::DeviceState MakeDevice(int id, std::uint8_t kind, int x, int y,
                                             float health) {
  aquafarm_msgs::DeviceState device;
  device.id = id;
  device.kind = kind;
  device.x = x;
  device.y = y;
  device.value = 75.0F;
  device.health = health;
  device.health_known = true;
  device.carrier = -1;
  return device;
}

inline aquafarm_msgs::ShipState MakeShip(int id, int x, int y) {
  aquafarm_msgs::ShipState ship;
  ship.id = id;
  ship.x = x;
  ship.y = y;
  ship.visible = true;
  ship.own_device = -1;
  ship.capacity = 1;
  ship.active = true;
  ship.action = 10;
  ship.outcome = 6;
  return ship;
}

inline aquafarm_msgs::DisasterState MakeDisaster(int id, float x, float y) {
  aquafarm_msgs::DisasterState disaster;
  disaster.id = id;
  disaster.grade = 3;
  disaster.x = x;
  disaster.y = y;
  disaster.heading_deg = 90;
  disaster.speed = 0.5F;
  disaster.radii = {2.0F, 4.0F, 6.0F};
  disaster.risks = {-20.0F, -12.0F, -5.0F};
  disaster.steps_left = 983;
  disaster.known = true;
  disaster.visible = true;
  return disaster;
}

/// Returns a ranch of side x side cells with an island in the south-west, up to `side` rocks and
/// four ports.
inline aquafarm_msgs::FarmSpec MakeSpec(int side = 25) {
  aquafarm_msgs::FarmSpec spec;
  spec.header.frame_id = "map";
  spec.version = "0.1.0";
  spec.scenario_name = "paper";
  spec.seed = 7;
  spec.episode = 12;
  spec.farms = 1;
  spec.width = side;
  spec.height = side;
  spec.cell_size_m = 1000.0;
  spec.step_duration_s = 180.0;
  spec.step_limit = 5000;
  for (int y = 0; y < side / 4; ++y) {
    for (int x = 0; x < side / 4 - y / 2; ++x) spec.islands.push_back(MakeCell(x, y));
  }
  for (int i = 0; i < side; ++i) {
    const int x = (i * 7 + 3) % side;
    const int y = (i * 11 + 5) % side;
    if (x < side / 3 && y < side / 3) continue;
    aquafarm_msgs::RockInfo rock;
    rock.cell = MakeCell(x, y);
    rock.reward = -3.0F;
    spec.rocks.push_back(rock);
  }
  const int shore = side / 4;
  for (int i = 0; i < 4; ++i) {
    aquafarm_msgs::PortInfo port;
    port.id = i;
    port.cell = i < 2 ? MakeCell(shore, i * (shore - 1)) : MakeCell((i - 2) * (shore / 2), shore);
    spec.ports.push_back(port);
  }
  spec.ships = 1;
  spec.agents = 1;
  spec.capacity = 1;
  return spec;
}

/// Returns a state of MakeSpec's ranch: ship 0 moves, three devices are deployed and one is
/// delivered, and there is one disaster.
inline aquafarm_msgs::FarmState MakeState(int side = 25) {
  aquafarm_msgs::FarmState state;
  state.header.frame_id = "map";
  state.header.stamp = ros::Time(17, 0);
  state.observer = -1;
  state.seed = 7;
  state.episode = 12;
  state.step = 17;
  state.world_time = ros::Time(17 * 180, 0);
  auto ship = MakeShip(0, side / 2, side / 3);
  ship.action = 5;
  ship.outcome = 0;
  ship.terms.disaster = -5.0F;
  ship.reward = -5.0F;
  state.ships.push_back(ship);
  for (int kind = 0; kind < 4; ++kind) {
    state.devices.push_back(MakeDevice(kind, static_cast<std::uint8_t>(kind),
                                       side / 4 + kind * side / 6, side * 3 / 4 - kind,
                                       1.0F - 0.3F * static_cast<float>(kind)));
  }
  state.devices[1].status = aquafarm_msgs::DeviceState::DELIVERED;
  state.devices[1].x = side / 4;
  state.devices[1].y = 0;
  state.disasters.push_back(
      MakeDisaster(0, static_cast<float>(side) * 0.6F, static_cast<float>(side) * 0.45F));
  state.joint_reward = -5.0F;
  state.joint_return = -42.5F;
  return state;
}

/// Returns a state of MakeSpec's ranch without ships, devices and disasters.
inline aquafarm_msgs::FarmState MakeEmptyState(int side = 25) {
  aquafarm_msgs::FarmState state = MakeState(side);
  state.ships.clear();
  state.devices.clear();
  state.disasters.clear();
  return state;
}

/// Returns a message of `values/points` for MakeSpec's ranch: cell (x, y) has the value x + y, and
/// the greedy action is north-east in all cells.
inline sensor_msgs::PointCloud2 MakeCloud(int side = 25) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "map";
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  using sensor_msgs::PointField;
  modifier.setPointCloud2Fields(5, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "value", 1, PointField::FLOAT32, "action", 1,
                                PointField::UINT8);
  modifier.resize(static_cast<std::size_t>(side * side));
  sensor_msgs::PointCloud2Iterator<float> at(cloud, "x");
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "value");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> action(cloud, "action");
  for (int cell = 0; cell < side * side; ++cell, ++at, ++value, ++action) {
    at[0] = 1000.0F * static_cast<float>(cell % side);
    at[1] = 1000.0F * static_cast<float>(cell / side);
    at[2] = 0.0F;
    *value = static_cast<float>(cell % side + cell / side);
    *action = 5;
  }
  return cloud;
}

/// Returns the choice of a compared policy in the state of MakeState: north-west.
inline aquafarm_msgs::PolicyChoice MakeChoice() {
  aquafarm_msgs::PolicyChoice choice;
  choice.seed = 7;
  choice.episode = 12;
  choice.step = 17;
  choice.policy = "dqn";
  choice.actions = {4};
  choice.values = {87.5F};
  return choice;
}

/// Makes the first index entry of a bag invalid. The reader of rosbag does not notice this.
inline void DamageIndex(const std::string& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  std::stringstream content;
  content << file.rdbuf();
  // The header of the index record ends with `ver`. Then follow the length of its data (4 bytes), a
  // time (8 bytes) and the offset that is overwritten.
  const std::string version("ver=\x01\0\0\0", 8);
  file.seekp(static_cast<std::streamoff>(content.str().find(version) + version.size() + 4 + 8));
  file.write("\xf0\xff\xff\x7f", 4);
}

}  // namespace aquafarm_viz::test
