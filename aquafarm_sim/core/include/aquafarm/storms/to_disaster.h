// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// From a published track to a disaster of a farm (§2.1): each ring of wind becomes a circle, or by
/// option a ring by quadrants, with a risk, the worst inside.
///
///   64 kt (force 12) ── risks[0]      a track has the rings that its source speaks of: 64, 50, 34
///   50 kt (force 10) ── risks[1]      kt, or 50 and 30 of the JMA; what a fix does not say is
///   34 kt (force 7)  ── risks[2]      estimated (hazard_track.h) and counted

#include <array>
#include <vector>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/storms/track.h"

namespace aquafarm {

/// What becomes of the four quadrants of a ring.
enum class RingReduction : std::uint8_t {
  kEqualArea,  ///< the circle of the same area, the root of the mean square
  kLargest,    ///< the circle of the farthest quadrant: on the safe side
  kQuadrants,  ///< they stay
};
inline constexpr int kRingReductionCount = 3;
/// "equal_area", "largest", "quadrants".
std::string_view ToString(RingReduction value);

/// A fix with its rings.
struct StormWaypoint {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint position;
  StormGrade grade{};
  std::vector<double> radii_km;  ///< ascending, the strongest wind first; 0: no such wind
  bool estimated{};              ///< any of them
  /// Each ring's quadrants, NE, SE, SW, NW, where they stay; radii_km are then the largest
  std::vector<std::array<double, 4>> quadrants_km;
  std::optional<double> pressure_hpa;
  std::optional<double> wind_mps;
};

/// A storm as rings of wind.
struct StormRings {
  std::vector<std::int32_t> wind_kt;  ///< the strongest first; as many as each waypoint has radii
  std::vector<StormWaypoint> waypoints;
  std::int32_t estimated{};  ///< waypoints with an estimated radius
  std::int32_t silent{};     ///< waypoints of which neither radii nor wind are known: 0 there

  /// The storm at a time, between two waypoints as Farm interpolates; none outside of the track.
  std::optional<StormWaypoint> At(std::int64_t time) const;
};

/// Reduces a track to rings. A stronger wind never reaches beyond a weaker one.
StormRings ToRings(const HazardTrack& track, RingReduction reduction);

/// Gives the fixes of a track that say nothing of radii those of another track of the same storm at
/// the same time, interpolated between fixes of at most six hours; for best tracks, which have no
/// radii, from the bulletins.
/// @returns how many fixes were given some
std::int32_t BorrowRings(const HazardTrack& from, HazardTrack& track);

/// What `aquafarm scenario` writes, a risk for each of three rings: [decided]
const GradeRisks& DefaultGradeRisks();

/// Whole steps that a span of time takes, one at least.
/// @throws InputError beyond ten million, "duration: got …"
std::int32_t StepsToCover(double span_s, double step_duration_s);

/// The disaster that follows a storm on a grid. A storm of fewer rings than the table has takes the
/// last risks of a row, one of more the first again for those inside.
/// @param start_time UTC of step 0
DisasterSpec ToDisaster(const StormRings& storm, const GradeRisks& risks, const GeoFrame& frame,
                        double cell_size_m, double step_duration_s, std::int64_t start_time);

/// The forecast of a track that was issued last and goes beyond its fixes, of the agency named
/// first; null: none.
const HazardForecast* NewestForecast(const HazardTrack& track);

/// A storm as a bulletin leaves it: the fixes so far, then the newest forecast that was issued with
/// one, of the agency named first. Without a forecast it goes on for 24 hours as it moves now, with
/// the wind and rings it has now (persistence).
HazardTrack WithForecast(const HazardTrack& track);

/// The disaster that a bulletin announces to a running episode: with the grade_risks of the
/// disaster that it replaces, or else of the scenario's first that has some, or the default ones;
/// by quadrants where that disaster is.
/// @param id of the disaster that it replaces or adds
/// @param step_now of the episode: the disaster lasts from it to the last waypoint, at least a step
/// @throws InputError for a scenario without grid.origin or time.start
DisasterSpec ToDisaster(const HazardTrack& bulletin, const Scenario& scenario, std::int32_t id,
                        std::int32_t step_now);

/// When a ring of a storm lies over a place.
struct Passage {
  std::int64_t nearest_time{};   ///< UTC [s since 1970]
  double nearest_km{};           ///< of the centre
  double widest_h{};             ///< how long the widest ring was over the place [hours]
  std::int64_t first{};          ///< when it first was; 0 with widest_h == 0
  std::int64_t last{};           ///< and last
  std::int32_t worst_wind_kt{};  ///< of the strongest ring that came over it; 0: none
};

/// Follows a storm past a place, ten minutes a step.
/// @param margin_km by which rings count as wider: the half-diagonal of a ranch
Passage PassOver(const StormRings& storm, GeoPoint place, double margin_km);

}  // namespace aquafarm
