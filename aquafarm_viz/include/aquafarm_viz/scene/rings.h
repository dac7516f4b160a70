// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/DisasterState.h>

#include <array>

namespace aquafarm_viz {

/// Returns the radii of a ring to the north-east, south-east, south-west and north-west [cells].
/// The radii of a circular ring are equal. A disaster without all quadrants has circular rings.
/// @param ring index in DisasterState.radii
inline std::array<double, 4> RingQuadrants(const aquafarm_msgs::DisasterState& disaster,
                                           std::size_t ring) {
  std::array<double, 4> radii{};
  const bool is_circular = disaster.quadrants.size() < 4 * disaster.radii.size();
  for (std::size_t q = 0; q < radii.size(); ++q) {
    radii[q] = is_circular ? disaster.radii[ring] : disaster.quadrants[4 * ring + q];
  }
  return radii;
}

}  // namespace aquafarm_viz
