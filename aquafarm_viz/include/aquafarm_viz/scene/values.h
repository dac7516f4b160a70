// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// V_π and the greedy action of a policy in each cell, from the topic `values/points`.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm_viz {

/// Values and greedy actions of a farm, [height, width] row-major, from the south.
struct Values {
  static constexpr std::uint8_t kNoAction = 255;

  int width{};
  int height{};
  std::vector<float> values;          ///< NaN: no value
  std::vector<std::uint8_t> actions;  ///< 0-7 moves, 8 pickup, 9 drop-off; kNoAction: no action
  float lowest{};                     ///< min of the values; lowest and highest are 0 without any
  float highest{};
  ros::Time stamp;
  std::optional<std::uint64_t> step;  ///< step of the state that they belong to; nullopt if unknown

  /// Sets `step` if the values belong to this state.
  void Pair(const aquafarm_msgs::FarmState& state) {
    if (stamp == state.header.stamp) step = state.step;
  }
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Reads a cloud for the farm of `spec`. Points outside the farm are ignored.
/// @throws std::invalid_argument "values/points: got no field value …"
Values ReadValues(const sensor_msgs::PointCloud2& cloud, const aquafarm_msgs::FarmSpec& spec);

/// Returns the cells whose greedy action is shown: every `every`-th cell along each axis, so that
/// the map stays readable, and up to 12 pickups and drop-offs wherever they are.
std::vector<cv::Point> ShownActions(const Values& values, int every);

/// Returns the greedy actions as markers: `moves` 0 are arrows, 1 pickups, 2 drop-offs. Along the
/// longer side of a farm there are at most 13.
visualization_msgs::MarkerArray MoveMarkers(const Values& values,
                                            const aquafarm_msgs::FarmSpec& spec);

/// Returns the choice of a compared policy as markers: namespace `choice`, id of the ship. They
/// delete the markers if the choice belongs to another state.
visualization_msgs::MarkerArray ChoiceMarkers(const aquafarm_msgs::PolicyChoice& choice,
                                              const aquafarm_msgs::FarmSpec& spec,
                                              const aquafarm_msgs::FarmState& state);

/// Returns true if a choice was made in this state.
inline bool IsOf(const aquafarm_msgs::PolicyChoice& choice, const aquafarm_msgs::FarmState& state) {
  return choice.seed == state.seed && choice.episode == state.episode && choice.step == state.step;
}

}  // namespace aquafarm_viz
