// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The wind rings of a storm along its track, with recorded or estimated radii (wind_radii.h). This
/// file also declares the continuation of a track by a forecast, and the passage of the rings over
/// a place.

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
  kEqualArea,  ///< a circle of the same area: its radius is the root mean square of the four radii
  kLargest,    ///< a circle with the largest of the four radii, to be on the safe side
  kQuadrants,  ///< the quadrants are kept
};
inline constexpr int kRingReductionCount = 3;
/// Returns "equal_area", "largest" or "quadrants".
std::string_view ToString(RingReduction value);

/// A fix with its wind rings.
struct StormWaypoint {
  std::int64_t time{};  ///< UTC [s since 1970]
  GeoPoint position;
  StormGrade grade{};
  std::vector<double> radii_km;  ///< ascending, the strongest wind first; 0: no ring or unknown
  bool estimated{};              ///< true if at least one radius is estimated
  std::int32_t averaging_min{};  ///< averaging period of wind_mps [min]; see EstimateRadius
  /// With kQuadrants: the radii of each ring by quadrant (NE, SE, SW, NW), and radii_km are their
  /// maxima. Else empty.
  std::vector<std::array<double, 4>> quadrants_km;
  std::optional<double> pressure_hpa;
  std::optional<double> wind_mps;
  bool forecast{};     ///< predicted, not observed; see StormRings::At
  bool silent{};       ///< radii and wind are unknown, so radii_km are 0; see StormRings::At
  bool is_reported{};  ///< the radius of the weakest wind is above 0 and comes from a ring of the
                       ///< fix (for 34 kt also from a ring of 30 kt), not from EstimateRing
  /// By ring, see StormPoint. Empty: false for all rings. CarrySize sets it; ToRings does not.
  std::vector<bool> keeps_radii;
  double size{1.0};  ///< see StormPoint; CarrySize sets it, ToRings does not
};

/// A storm as rings of wind.
struct StormRings {
  std::string name;                   ///< name of the storm; may be empty
  std::vector<std::int32_t> wind_kt;  ///< winds of the rings, the strongest first
  std::vector<StormWaypoint> waypoints;
  std::int32_t estimated{};  ///< number of waypoints with StormWaypoint::estimated
  std::int32_t silent{};     ///< number of waypoints with StormWaypoint::silent

  /// Returns the storm at a time; nullopt outside the track. Position and radii are interpolated
  /// linearly, as in Farm. Grade, wind and pressure are those of the previous waypoint. `forecast`
  /// and `silent` are true if they are true for one of the two neighbouring waypoints.
  /// @param time UTC [s since 1970]
  std::optional<StormWaypoint> At(std::int64_t time) const;
};

/// Reduces a track to rings. A ring of a stronger wind is cut where it extends beyond the ring of a
/// weaker wind. Missing radii are estimated from the wind. If the wind is unknown and the grade is
/// at least TS, the lower limit of the grade replaces the wind. If the weakest wind is 34 kt, a
/// fix with a ring of 30 kt but none of 34 kt gets a ring of 34 kt that is derived from the ring of
/// 30 kt.
/// @param winds_kt winds of the rings, the strongest first. If empty: 64, 50 and 34, or 50 and 30
///   if the track has rings of 30 kt but none of 34 kt.
/// @returns one waypoint for each fix of the track
StormRings ToRings(const StormTrack& track, RingReduction reduction,
                   const std::vector<std::int32_t>& winds_kt = {});

/// Copies the radii of another track of the same storm to the fixes of `track` that have no radii.
/// The radii are interpolated in time between fixes at most six hours apart. Used to add the radii
/// of bulletins to best tracks without radii.
/// @returns the number of fixes that received radii
std::int32_t BorrowRings(const StormTrack& from, StormTrack& track);

/// Returns the newest forecast that extends beyond the last fix of a track and was issued at most
/// 24 hours before this fix; nullptr if there is none. Of several with the same time of issue,
/// returns the first one.
/// @throws LogicError if the track has no fix
const StormForecast* NewestForecast(const StormTrack& track);

/// Continuation of a track without a forecast.
enum class NoForecast : std::uint8_t {
  kEnd,      ///< no continuation: the storm is known only until its last fix
  kPersist,  ///< 24 hours with the motion, wind and rings of the last fix; a storm without a known
             ///< motion stands still
};

/// Returns a track continued by the later fixes of its newest forecast, which are marked with
/// StormFix::forecast. A forecast point without wind and radii gets those of the previous point.
/// @param track with at least one fix
/// @param fallback continuation if NewestForecast returns nullptr
StormTrack WithForecast(const StormTrack& track, NoForecast fallback);

/// The period for which a storm is known.
struct StormKnowledge {
  std::int64_t recorded_until{};  ///< UTC of the last recorded fix [s since 1970]; 0 without one
  std::int64_t known_until{};     ///< UTC of the last fix, including those of WithForecast
  std::int64_t issued{};          ///< UTC at which the forecast was issued; 0 without a forecast
  std::string agency;             ///< agency of the forecast; may be empty
};
/// Returns the period for which a storm is known.
/// @param whole result of WithForecast for `recorded`
StormKnowledge KnowledgeOf(const StormTrack& recorded, const StormTrack& whole);
/// Returns a description, such as "recorded until …, then forecast until … (issued … by 中国)" or
/// "known until … only".
std::string Describe(const StormKnowledge& knowledge);

/// The passage of a storm near a place.
struct Passage {
  std::int64_t nearest_time{};   ///< time of the closest approach, UTC [s since 1970]
  double nearest_km{};           ///< distance of the centre at that time
  double widest_h{};             ///< total time for which the widest ring is over the place [hours]
  std::int64_t first{};          ///< first time at which the widest ring is over it; 0 if never
  std::int64_t last{};           ///< last time at which the widest ring is over it; 0 if never
  std::int32_t worst_wind_kt{};  ///< wind of the strongest ring that passes over the place; 0 if
                                 ///< no ring does
  bool nearest_forecast{};       ///< nearest_time is in the forecast part of the track
  bool nearest_at_end{};         ///< nearest_time is the last known time; later the storm may come
                                 ///< nearer
  bool over_at_start{};          ///< the widest ring is over the place at the first known time
  bool over_at_end{};            ///< the widest ring is over the place at the last known time
  /// First and last time at which wind and radii are unknown while the place is within
  /// kLargestGale_km of the centre; 0 if there is no such time.
  std::array<std::int64_t, 2> unknown{};
};

/// Distance of the centre within which a storm is relevant for a place.
inline constexpr double kStormConcern_km = 500.0;
/// 34 kt radius of the largest known storm, Tip 1979 (Dunnavan and Diercks 1980, Mon. Wea. Rev.
/// 108, 1915-1923).
inline constexpr double kLargestGale_km = 1110.0;

/// Computes the passage of a storm near a place, from its first to its last known time in steps of
/// ten minutes.
/// @param margin_km added to the radius of each ring and to kLargestGale_km, for example the
///   half-diagonal of a ranch
Passage ClosestApproach(const StormRings& storm, GeoPoint place, double margin_km);

}  // namespace aquafarm
