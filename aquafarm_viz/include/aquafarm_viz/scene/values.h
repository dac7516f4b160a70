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

/// Values and greedy actions of the cells of a farm, [height, width] row-major; row 0 is the
/// southernmost.
struct Values {
  static constexpr std::uint8_t kNoAction = 255;

  int width{};
  int height{};
  std::vector<float> values;          ///< NaN: the cell has no value
  std::vector<std::uint8_t> actions;  ///< 0-7 moves, 8 pickup, 9 drop-off; kNoAction: no action
  float lowest{};                     ///< min of the values; 0 if no cell has a value
  float highest{};                    ///< max of the values; 0 if no cell has a value
  ros::Time stamp;                    ///< stamp of the message
  std::optional<std::uint64_t> step;  ///< step of the state with this stamp; nullopt if unknown

  /// Sets `step` if the state has the stamp of the message, as in the bags that bag_policy writes.
  void Pair(const aquafarm_msgs::FarmState& state) {
    if (stamp == state.header.stamp) step = state.step;
  }
  /// Returns the index of a cell in `values` and `actions`.
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Reads a message of `values/points` for the farm of `spec`. Points outside the farm are ignored.
/// @throws std::invalid_argument if a field is missing ("values/points: got no field value,
///        expected x, y, value and action") or has another type, or if the data have a wrong size
Values ReadValues(const sensor_msgs::PointCloud2& cloud, const aquafarm_msgs::FarmSpec& spec);

/// Returns the cells whose greedy action is drawn: one of `every` cells along each axis, so that
/// the map stays readable. If at most 12 of the other cells have the action pickup or drop-off,
/// these cells are added.
std::vector<cv::Point> ShownActions(const Values& values, int every);

/// Returns values and greedy actions as markers. The namespace `values` has one marker, id 0: the
/// coloured cells. In the namespace `moves`, id 0 contains the arrows of the moves, id 1 the
/// pickups and id 2 the drop-offs. Moves are drawn in at most 13 cells along the longer side of the
/// farm, see ShownActions. A marker without points has the action DELETE.
visualization_msgs::MarkerArray MoveMarkers(const Values& values,
                                            const aquafarm_msgs::FarmSpec& spec);

/// Returns the choice of a compared policy as a marker for each ship: namespace `choice`, id of the
/// ship. A marker has the action DELETE if the choice was made in another state or has no action
/// for the ship, or if the ship is not drawn.
visualization_msgs::MarkerArray ChoiceMarkers(const aquafarm_msgs::PolicyChoice& choice,
                                              const aquafarm_msgs::FarmSpec& spec,
                                              const aquafarm_msgs::FarmState& state);

/// Returns true if a choice was made in this state.
inline bool IsOf(const aquafarm_msgs::PolicyChoice& choice, const aquafarm_msgs::FarmState& state) {
  return choice.seed == state.seed && choice.episode == state.episode && choice.step == state.step;
}

}  // namespace aquafarm_viz
