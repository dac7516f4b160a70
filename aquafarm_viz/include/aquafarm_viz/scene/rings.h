// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/DisasterState.h>

#include <array>

namespace aquafarm_viz {

/// Returns the radii of a ring to the north-east, south-east, south-west and north-west [cells].
/// The radii of a circular ring are equal. The disaster must pass CheckState.
/// @param ring index in DisasterState.radii
inline std::array<double, 4> RingQuadrants(const aquafarm_msgs::DisasterState& disaster,
                                           std::size_t ring) {
  std::array<double, 4> radii{};
  for (std::size_t q = 0; q < radii.size(); ++q) {
    radii[q] = disaster.quadrants.empty() ? disaster.radii[ring] : disaster.quadrants[4 * ring + q];
  }
  return radii;
}

}  // namespace aquafarm_viz
