// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What a policy thinks of each cell: V_π and its best move there, from the topic `values/points`.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// Values and best moves of a farm of width x height cells, row by row from the south.
struct Values {
  static constexpr std::uint8_t kNoAction = 255;

  int width{};
  int height{};
  std::vector<float> values;          ///< NaN: none
  std::vector<std::uint8_t> actions;  ///< 0-7 moves, 8 pickup, 9 drop-off; kNoAction: none
  float lowest{};                     ///< of the values; both 0 without any
  float highest{};
  ros::Time stamp;
  std::optional<std::uint64_t> step;  ///< of the state that they are of, once known

  /// Notes the step where the state is the one that they are of.
  void Pair(const aquafarm_msgs::FarmState& state) {
    if (stamp == state.header.stamp) step = state.step;
  }
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Reads a cloud of the farm of `spec`. Points outside of it are left out.
/// @throws std::invalid_argument "values/points: got no field value …"
Values ReadValues(const sensor_msgs::PointCloud2& cloud, const aquafarm_msgs::FarmSpec& spec);

/// The best moves as markers: `moves` 0 are arrows, 1 pickups, 2 drop-offs.
visualization_msgs::MarkerArray MoveMarkers(const Values& values,
                                            const aquafarm_msgs::FarmSpec& spec);

/// What another policy would do with each ship in a state, as markers: `choice` by ship. They are
/// deleted where the choice is of another state.
visualization_msgs::MarkerArray ChoiceMarkers(const aquafarm_msgs::PolicyChoice& choice,
                                              const aquafarm_msgs::FarmSpec& spec,
                                              const aquafarm_msgs::FarmState& state);

/// Whether a choice was made in this state.
bool IsOf(const aquafarm_msgs::PolicyChoice& choice, const aquafarm_msgs::FarmState& state);

}  // namespace aquafarm_viz
