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
  bool forecast{};  ///< predicted, not observed; between two waypoints: one of them is
  bool silent{};    ///< neither radii nor wind are known: radii_km are 0; between two: of one
};

/// A storm as rings of wind.
struct StormRings {
  std::vector<std::int32_t> wind_kt;  ///< the strongest first; as many as each waypoint has radii
  std::vector<StormWaypoint> waypoints;
  std::int32_t estimated{};  ///< waypoints with an estimated radius
  std::int32_t silent{};     ///< waypoints of which neither radii, wind nor grade are known

  /// The storm at a time, between two waypoints as Farm interpolates; none outside of the track.
  std::optional<StormWaypoint> At(std::int64_t time) const;
};

/// Reduces a track to rings. A stronger wind never reaches beyond a weaker one. Radii that are not
/// given are estimated from the wind, or from the lowest wind of the grade where the wind is
/// unknown.
StormRings ToRings(const StormTrack& track, RingReduction reduction);

/// Gives the fixes of a track that say nothing of radii those of another track of the same storm at
/// the same time, interpolated between fixes of at most six hours; for best tracks, which have no
/// radii, from the bulletins.
/// @returns how many fixes were given some
std::int32_t BorrowRings(const StormTrack& from, StormTrack& track);

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

/// The newest forecast of a track that extends beyond its fixes, of the agency named first; nullptr
/// without such a forecast, or if it was issued more than 24 hours before the last fix.
const StormForecast* NewestForecast(const StormTrack& track);

/// What continues a track without a forecast.
enum class NoForecast : std::uint8_t {
  kEnd,      ///< nothing: the storm is known until its last fix only
  kPersist,  ///< 24 hours with the motion, wind and rings of the last fix; without a motion the
             ///< storm stands still
};

/// The recorded fixes of a track, then the newest forecast, marked as StormFix::forecast. A
/// forecast point without wind and radii keeps those of the point before.
StormTrack WithForecast(const StormTrack& track, NoForecast otherwise);

/// Until when a storm is known.
struct StormKnowledge {
  std::int64_t recorded_until{};  ///< UTC of the last recorded fix [s since 1970]; 0: none is
  std::int64_t known_until{};     ///< UTC of the last fix; later than recorded_until: a forecast
  std::int64_t issued{};          ///< UTC of the forecast; 0 without one
  std::string agency;             ///< of the forecast; may be empty
};
/// Reads it from a track that WithForecast made of `recorded`.
StormKnowledge KnowledgeOf(const StormTrack& recorded, const StormTrack& whole);
/// "recorded until …, then forecast until … (issued … by 中国)", "known until … only", or with
/// persistence "… ; no forecast: it is assumed to keep its motion until …".
std::string Describe(const StormKnowledge& knowledge);

/// The disaster that a bulletin announces to a running episode: with the grade_risks of the
/// disaster that it replaces, or else of the scenario's first that has some, or the default ones;
/// by quadrants where that disaster is.
/// @param id of the disaster that it replaces or adds
/// @param step_now of the episode: the disaster lasts from it to the last waypoint, at least a step
/// @throws InputError for a scenario without grid.origin or time.start, or a bulletin that is known
///   until a time before step_now only
DisasterSpec ToDisaster(const StormTrack& bulletin, const Scenario& scenario, std::int32_t id,
                        std::int32_t step_now);

/// When a ring of a storm lies over a place.
struct Passage {
  std::int64_t nearest_time{};   ///< UTC [s since 1970]
  double nearest_km{};           ///< of the centre
  double widest_h{};             ///< how long the widest ring was over the place [hours]
  std::int64_t first{};          ///< when it first was; 0 with widest_h == 0
  std::int64_t last{};           ///< and last
  std::int32_t worst_wind_kt{};  ///< of the strongest ring that came over it; 0: none
  bool nearest_forecast{};       ///< nearest_time lies in the forecast part of the track
  bool nearest_at_end{};         ///< nearest_time is the last known time: it may come nearer
  bool over_at_start{};          ///< the widest ring is over the place at the first known time
  bool over_at_end{};            ///< and at the last known time
  /// First and last time at which wind and radii are unknown and the centre is so near that the
  /// largest known storm has its gale over the place; 0: never
  std::array<std::int64_t, 2> unknown{};
};

/// Distance of the centre within which a storm concerns a place.
inline constexpr double kStormConcern_km = 500.0;
/// Radius of 34 kt of the largest storm known, Tip 1979 (Dunnavan and Diercks 1980, Mon. Wea. Rev.
/// 108, 1915-1923).
inline constexpr double kLargestGale_km = 1110.0;

/// Follows a storm past a place from its first to its last known time, every ten minutes.
/// @param margin_km by which rings count as wider: the half-diagonal of a ranch
Passage ClosestApproach(const StormRings& storm, GeoPoint place, double margin_km);

}  // namespace aquafarm
