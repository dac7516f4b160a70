// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Waypoints of a disaster on a farm, in cells and steps.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace aquafarm {

/// Radii of a ring to the north-east, south-east, south-west and north-west [cells]; 0: no ring in
/// that quadrant.
using QuadrantRadii = std::array<float, 4>;

/// A waypoint of a disaster at a step. Positions, radii and risks are interpolated between
/// waypoints. The grade is that of the last waypoint passed.
struct Waypoint {
  float step{};  ///< steps since the episode's start; may be negative
  float x{};     ///< [cells]
  float y{};
  std::int32_t grade{1};
  std::vector<float> radii{};  ///< [cells], ascending; one per risk of the disaster; 0: no ring
  std::vector<float> risks{};  ///< one per radius
  /// Radii by quadrant, one entry per ring; `radii` then holds the largest radius of each ring.
  /// Empty if all rings are circles.
  std::vector<QuadrantRadii> quadrants{};
  /// Max mean wind near the centre [m/s]. Pictures and rviz show this wind. It does not affect the
  /// farm.
  std::optional<float> wind_mps{};
};

/// Risks of the rings for grades 1 to 4, worst risk first; empty if unset.
using GradeRisks = std::vector<std::vector<float>>;

}  // namespace aquafarm
