// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Places a storm on a farm, displaced by errors: one member of an ensemble, or one episode's draw
/// from an archive. Without errors it is the storm as recorded. Results are bit-identical on every
/// machine.

#include <vector>

#include "aquafarm/tracks/storm_path.h"
#include "aquafarm/tracks/waypoint.h"

namespace aquafarm {

/// Displacement of one fix of a storm. The default is none.
struct StormErrors {
  double along_km{};        ///< forward along the direction of motion
  double across_km{};       ///< to the right of the direction of motion
  double shift_s{};         ///< added to the time
  double wind_factor{1.0};  ///< multiplies the wind, before wind_add_mps
  double wind_add_mps{};
  double size_factor{1.0};  ///< multiplies every radius
};

/// Places storms. It keeps buffers: once it has placed a path with as many points, Place into the
/// same vector does not allocate.
class StormPlacer {
 public:
  /// Computes the waypoints of a displaced storm.
  ///
  /// A changed wind scales each radius by the ratio of EstimateRadius for the new and the old wind,
  /// removes rings of winds that the storm no longer reaches, and adds an estimated ring for a wind
  /// that it newly reaches, scaled as the next weaker one, or by StormPoint::size without one. The
  /// grade is then that of the new wind. A fix without known wind keeps its rings; so does one with
  /// StormPoint::keeps_radii, ring by ring. Times stay in order: a shift never moves a fix before
  /// the previous one.
  /// @param errors empty (none), one for all fixes, or one per fix of the path
  /// @param risks of grades 1 to 4, worst first. A row with fewer columns than rings repeats its
  ///   first risk for the inner rings; a row with more columns uses its last ones
  /// @param waypoints replaced; steps are relative to step 0 of the path
  void Place(const StormPath& path, const std::vector<StormErrors>& errors, const GradeRisks& risks,
             std::vector<Waypoint>& waypoints);
  /// Returns them in a new vector.
  std::vector<Waypoint> Place(const StormPath& path, const std::vector<StormErrors>& errors,
                              const GradeRisks& risks);

 private:
  std::vector<Waypoint> spare_;  // waypoints that the last path did not need, with their memory
};

}  // namespace aquafarm
