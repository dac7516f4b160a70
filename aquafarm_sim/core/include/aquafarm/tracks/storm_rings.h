// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The wind rings of a storm along its track: recorded radii or estimated ones (wind_radii.h), the
/// continuation of a track by a forecast, and the passage of the rings over a place.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// Shape of a ring on the farm.
enum class RingReduction : std::uint8_t {
  kEqualArea,  ///< a circle of the same area: its radius is the root mean square
  kLargest,    ///< a circle with the largest radius: on the safe side
  kQuadrants,  ///< the quadrants are kept
};
inline constexpr int kRingReductionCount = 3;
/// "equal_area", "largest", "quadrants".
std::string_view ToString(RingReduction value);

/// A fix with its wind rings.
struct StormWaypoint {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint position;
  StormGrade grade{};
  std::vector<double> radii_km;  ///< ascending, the strongest wind first; 0 if no such wind blows
  bool estimated{};              ///< true if at least one radius is estimated
  std::int32_t averaging_min{};  ///< of wind_mps; see EstimateRadius
  /// Quadrants of each ring (NE, SE, SW, NW) with kQuadrants; radii_km are then their maxima.
  std::vector<std::array<double, 4>> quadrants_km;
  std::optional<double> pressure_hpa;
  std::optional<double> wind_mps;
  bool forecast{};     ///< predicted, not observed; between two waypoints: at least one of them is
  bool silent{};       ///< radii and wind are unknown and radii_km are 0; between two waypoints: at
                       ///< least one of them is silent
  bool is_reported{};  ///< the radius of the weakest wind is recorded, or derived from one
  /// By ring, see StormPoint; empty: none. ToRings leaves this and `size` as they are.
  std::vector<bool> keeps_radii;
  double size{1.0};  ///< see StormPoint
};

/// A storm as rings of wind.
struct StormRings {
  std::string name;                   ///< of the storm; empty: it has none
  std::vector<std::int32_t> wind_kt;  ///< the strongest first; as many as radii per waypoint
  std::vector<StormWaypoint> waypoints;
  std::int32_t estimated{};  ///< waypoints with an estimated radius
  std::int32_t silent{};     ///< waypoints without known radii, wind and grade

  /// Returns the storm at a time, interpolated between two waypoints as in Farm; nullopt outside
  /// the track.
  std::optional<StormWaypoint> At(std::int64_t time) const;
};

/// Reduces a track to rings. A ring of a stronger wind never extends beyond one of a weaker wind.
/// Missing radii are estimated from the wind, or from the lower limit of the grade if the wind is
/// unknown.
/// @param winds_kt of the rings, the strongest first; empty: 64, 50 and 34, or 50 and 30 if the
///   track has rings of 30 kt only. A ring of 34 kt is derived from a recorded one of 30 kt, if
///   there is one.
/// @returns one waypoint for each fix of the track
StormRings ToRings(const StormTrack& track, RingReduction reduction,
                   const std::vector<std::int32_t>& winds_kt = {});

/// Copies radii to the fixes of `track` without radii from another track of the same storm at the
/// same time, interpolated between fixes at most six hours apart. It adds the radii of bulletins to
/// best tracks, which have none.
/// @returns the number of fixes that received radii
std::int32_t BorrowRings(const StormTrack& from, StormTrack& track);

/// Returns the newest forecast of a track that extends beyond its fixes, from the agency listed
/// first; nullptr if there is none or if it was issued more than 24 hours before the last fix.
const StormForecast* NewestForecast(const StormTrack& track);

/// Continuation of a track without a forecast.
enum class NoForecast : std::uint8_t {
  kEnd,      ///< no continuation: the storm is known only until its last fix
  kPersist,  ///< 24 hours with the motion, wind and rings of the last fix; a storm without a known
             ///< motion stands still
};

/// Returns the recorded fixes of a track, followed by the fixes of the newest forecast, marked with
/// StormFix::forecast. A forecast point without wind and radii keeps those of the previous point.
StormTrack WithForecast(const StormTrack& track, NoForecast fallback);

/// The period for which a storm is known.
struct StormKnowledge {
  std::int64_t
      recorded_until{};        ///< UTC of the last recorded fix [s since 1970]; 0 if there is none
  std::int64_t known_until{};  ///< UTC of the last fix; later than recorded_until with a forecast
  std::int64_t issued{};       ///< UTC at which the forecast was issued; 0 without one
  std::string agency;          ///< of the forecast; may be empty
};
/// Derives it from a track `whole` that WithForecast made of `recorded`.
StormKnowledge KnowledgeOf(const StormTrack& recorded, const StormTrack& whole);
/// Returns "recorded until …, then forecast until … (issued … by 中国)", "known until … only", or
/// with persistence "… ; no forecast: it is assumed to keep its motion until …".
std::string Describe(const StormKnowledge& knowledge);

/// The passage of a storm near a place.
struct Passage {
  std::int64_t nearest_time{};   ///< time of the closest approach, UTC [s since 1970]
  double nearest_km{};           ///< distance of the centre at that time
  double widest_h{};             ///< duration for which the widest ring was over the place [hours]
  std::int64_t first{};          ///< start of that duration; 0 if widest_h is 0
  std::int64_t last{};           ///< end of that duration
  std::int32_t worst_wind_kt{};  ///< wind of the strongest ring that passed over the place; 0 if
                                 ///< there was none
  bool nearest_forecast{};       ///< nearest_time is in the forecast part of the track
  bool nearest_at_end{};         ///< nearest_time is the last known time: the storm may come nearer
  bool over_at_start{};          ///< the widest ring is over the place at the first known time
  bool over_at_end{};            ///< the widest ring is over the place at the last known time
  /// First and last time at which wind and radii are unknown and the centre is so near that the
  /// gale radius of the largest known storm would include the place; 0 if there is no such time.
  std::array<std::int64_t, 2> unknown{};
};

/// Distance of the centre within which a storm is relevant for a place.
inline constexpr double kStormConcern_km = 500.0;
/// 34 kt radius of the largest known storm, Tip 1979 (Dunnavan and Diercks 1980, Mon. Wea. Rev.
/// 108, 1915-1923).
inline constexpr double kLargestGale_km = 1110.0;

/// Computes the passage of a storm near a place from its first to its last known time, in steps of
/// ten minutes.
/// @param margin_km added to the radius of each ring: the half-diagonal of a ranch
Passage ClosestApproach(const StormRings& storm, GeoPoint place, double margin_km);

}  // namespace aquafarm
