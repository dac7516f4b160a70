// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Places a storm on a farm, displaced by errors. The result is a member of an ensemble, or the
/// storm that an episode draws from an archive. Without errors, the result is the recorded storm.
/// Results are bit-identical on every machine.

#include <vector>

#include "aquafarm/tracks/storm_path.h"
#include "aquafarm/tracks/waypoint.h"

namespace aquafarm {

/// Displacement of one fix of a storm. The default values do not change the fix.
struct StormErrors {
  double along_km{};        ///< forward along the direction of motion
  double across_km{};       ///< to the right of the direction of motion
  double shift_s{};         ///< added to the time
  double wind_factor{1.0};  ///< multiplies the wind, before wind_add_mps
  double wind_add_mps{};    ///< added to the wind; the sum is at least 0
  double size_factor{1.0};  ///< multiplies every radius
};

/// Places storms and reuses memory. Place does not allocate if it has placed a path with as many
/// points and rings into the same vector before.
class StormPlacer {
 public:
  /// Computes the waypoints of a displaced storm.
  ///
  /// If the wind changes, the grade becomes that of the new wind, and the rings change:
  ///    - A radius is multiplied by the ratio of EstimateRadius for the new wind to that for the
  ///      old wind.
  ///    - A ring whose wind the storm no longer reaches gets radius 0.
  ///    - A ring whose wind the storm newly reaches gets the radius of EstimateRadius times a
  ///      ratio: the recorded radius divided by the estimated radius of the next weaker ring that
  ///      has both radii. If there is no such ring, the ratio is StormPoint::size.
  ///    - A ring with StormPoint::keeps_radii and a radius above 0 does not change.
  /// The rings of a fix whose wind and grade are both unknown do not change either. size_factor
  /// then multiplies all radii, and each ring is cut where it extends beyond a ring of a weaker
  /// wind. Each fix stays later than the previous one.
  /// @param errors no entry: no errors; one entry: for all fixes; else one entry per fix of the
  ///   path
  /// @param risks risks of the rings: one row per grade from 1 to 4, with the worst risk first.
  ///   If a row has fewer risks than the storm has rings, the innermost rings share its first risk.
  ///   If a row has more risks than the storm has rings, its last risks apply.
  /// @param waypoints result; one waypoint per fix, with steps relative to step 0 of the path
  void Place(const StormPath& path, const std::vector<StormErrors>& errors, const GradeRisks& risks,
             std::vector<Waypoint>& waypoints);
  /// Returns the waypoints in a new vector.
  std::vector<Waypoint> Place(const StormPath& path, const std::vector<StormErrors>& errors,
                              const GradeRisks& risks);

 private:
  std::vector<Waypoint> spare_;  // waypoints that the last path did not need, with their memory
};

}  // namespace aquafarm
