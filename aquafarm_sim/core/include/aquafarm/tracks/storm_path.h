// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A storm in the units of a farm: its track and its rings in cells and steps. The path is computed
/// once per storm and farm. StormPlacer (place_storm.h) displaces it many times at low cost.
///
///   StormTrack ──ToRings──> StormRings ──ToPath──> StormPath ──StormPlacer──> waypoints

#include <array>
#include <cstdint>
#include <vector>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/tracks/storm_rings.h"

namespace aquafarm {

/// Max number of rings of a storm: 64, 50 and 34 kt.
inline constexpr std::size_t kMaxStormRings = 3;

/// A fix of a storm on a farm.
struct StormPoint {
  double step{};  ///< steps since step 0 of the path; may be negative
  double x{};     ///< [cells]
  double y{};
  double east{};  ///< (east, north): unit vector of the motion; (0, 1) without motion
  double north{1.0};
  double latitude{};  ///< [degrees]
  double wind_mps{};  ///< if unknown: lower limit of the grade; 0 if both are unknown
  std::int32_t averaging_min{};
  StormGrade grade{};
  std::array<double, kMaxStormRings> radius{};     ///< [cells], the strongest wind first
  std::array<double, kMaxStormRings> median_km{};  ///< EstimateRadius for `wind_mps`
  std::array<std::array<double, kQuadrantCount>, kMaxStormRings> quadrants{};  ///< [cells]
  /// By ring: true if errors of the wind (StormErrors) do not change the radii of the ring. True
  /// for reported radii of recorded points, and at points that ToFineRings adds with the larger
  /// radii of both ends. False for reported radii of forecast points.
  std::array<bool, kMaxStormRings> keeps_radii{};
  /// Ratio of the storm's radii to EstimateRadius. StormPlacer uses it for rings whose winds the
  /// storm reaches only because of an error of the wind.
  double size{1.0};
};

/// A storm on a farm.
struct StormPath {
  std::array<std::int32_t, kMaxStormRings> wind_kt{};  ///< the strongest first
  std::size_t rings{};                                 ///< number of rings
  bool by_quadrant{};                                  ///< `quadrants` of the points apply
  double cell_size_km{1.0};
  double step_duration_s{1.0};
  std::vector<StormPoint> points;  ///< in order of time
};

/// Converts the part of a storm that is within 60 degrees of the frame's origin.
/// @param storm with at least one waypoint and at most kMaxStormRings rings
/// @param start_time UTC of step 0 of the path [s since 1970]
/// @throws InputError if the storm never comes within 60 degrees of the frame's origin, or leaves
///   this area and comes back
StormPath ToPath(const StormRings& storm, const GeoFrame& frame, double cell_size_m,
                 double step_duration_s, std::int64_t start_time);

/// Closest approach of a path to a point.
struct PathApproach {
  double step{};      ///< step of the path, with a fraction
  double distance{};  ///< [cells]
};
/// Returns the closest approach of a path to a point. The path is linear between fixes.
/// @param path with at least one point
/// @param x, y the point [cells]
/// @param along, across displacement of every fix: forward along its motion and to the right of it
///   [cells]
PathApproach ClosestApproach(const StormPath& path, double x, double y, double along = 0.0,
                             double across = 0.0);

}  // namespace aquafarm
