// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Validates messages before they are drawn, because any program on the network may have sent them.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <string>

namespace aquafarm_viz {

inline constexpr int kMaxSide = 4096;      ///< max number of cells along a side
inline constexpr int kMaxShips = 4096;     ///< max number of ships in a state
inline constexpr int kMaxDevices = 65536;  ///< max number of devices in a state
inline constexpr int kMaxDisasters = 256;  ///< max number of disasters in a state
inline constexpr int kMaxRings = 4;        ///< max number of rings of a disaster
/// Max radius of a ring, and max |x| and |y| of the centre of a disaster [cells].
inline constexpr double kMaxDistance = 1.0e6;

/// Returns the reason why a spec cannot be drawn, in one line; empty if it can be drawn.
std::string CheckSpec(const aquafarm_msgs::FarmSpec& spec);

/// Returns the reason why a state cannot be drawn, in one line; empty if it can be drawn. Ships and
/// devices outside the grid are allowed and are not drawn. Disasters whose `known` is false are not
/// checked.
std::string CheckState(const aquafarm_msgs::FarmState& state);

/// Returns true if a cell is inside the farm.
inline bool InGrid(const aquafarm_msgs::FarmSpec& spec, int x, int y) {
  return x >= 0 && y >= 0 && x < spec.width && y < spec.height;
}

/// Returns true if the centre of a disaster lies on the farm.
inline bool IsCentreInFarm(const aquafarm_msgs::FarmSpec& spec,
                           const aquafarm_msgs::DisasterState& disaster) {
  return disaster.x >= -0.5F && disaster.y >= -0.5F && disaster.x <= float(spec.width) - 0.5F &&
         disaster.y <= float(spec.height) - 0.5F;
}

/// Returns true if the state belongs to the episode of the spec.
inline bool SameEpisode(const aquafarm_msgs::FarmSpec& spec,
                        const aquafarm_msgs::FarmState& state) {
  return spec.seed == state.seed && spec.episode == state.episode;
}

}  // namespace aquafarm_viz
