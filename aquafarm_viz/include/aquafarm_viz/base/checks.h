// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Guards in front of everything that draws: messages come from a network.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <string>

namespace aquafarm_viz {

inline constexpr int kMaxSide = 4096;          ///< cells along a side
inline constexpr int kMaxShips = 4096;         ///< ships in a state
inline constexpr int kMaxDevices = 65536;      ///< devices in a state
inline constexpr int kMaxDisasters = 256;      ///< disasters in a state
inline constexpr int kMaxRings = 4;            ///< rings of a disaster
inline constexpr double kMaxDistance = 1.0e6;  ///< cells from the origin or between ring and centre

/// Says in one line why a spec cannot be drawn; empty when it can.
std::string CheckSpec(const aquafarm_msgs::FarmSpec& spec);

/// Says in one line why a state cannot be drawn; empty when it can. Things
/// outside the grid are no fault here: they are left out of the drawing.
std::string CheckState(const aquafarm_msgs::FarmState& state);

/// Says whether a cell lies on the farm.
inline bool InGrid(const aquafarm_msgs::FarmSpec& spec, int x, int y) {
  return x >= 0 && y >= 0 && x < spec.width && y < spec.height;
}

/// Says whether the state belongs to the episode of the spec.
inline bool SameEpisode(const aquafarm_msgs::FarmSpec& spec,
                        const aquafarm_msgs::FarmState& state) {
  return spec.seed == state.seed && spec.episode == state.episode;
}

}  // namespace aquafarm_viz
