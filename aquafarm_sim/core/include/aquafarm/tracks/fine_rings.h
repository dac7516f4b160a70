// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The rings of a storm between the points of its track, for farms, pictures and rescue plans.
///
/// A storm's radii are not linear in time. For the radius r of a ring of wind w, ln r is linear in
/// sqrt(V / w - 1), where V is the wind of the storm (wind_radii.h). By the estimate for the CMA,
/// the 34 kt radius is about 160 km as soon as V reaches 34 kt. The forecast points of a bulletin
/// are 12 to 24 hours apart. Linear interpolation of the radii between these points gives
/// radii that are too small.
///
///   wind   35 kt ●━━━━━━━━━━━━━━━━━━━━● 30 kt    points at most 3 h apart; position and wind are
///   radius 170 km ●━━━●━━━●━━━●                   linear; radii that are not reported follow from
///                              ╲___●___● 0        the wind and from the size of the last report

#include <cstdint>
#include <optional>
#include <vector>

#include "aquafarm/tracks/storm_rings.h"

namespace aquafarm {

/// Max time between neighbouring points where FineTrack or ToFineRings adds points [s].
inline constexpr std::int64_t kFineTrack_s = 3 * 3600;
/// Decay time of the size of a storm [h]. The size is ln(reported radius / estimated radius) in
/// units of SizeSigma. In the decay time it falls by a factor of e. docs/plan.md describes the fit.
inline constexpr double kSizeMemory_h = 165.0;

/// Adds points to a track, so that neighbouring points are at most kFineTrack_s apart. The position
/// and wind of a new point are interpolated linearly between its neighbours, and so are the rings
/// that both neighbours have. A ring whose radius is 0 at exactly one neighbour is left out.
/// ToRings estimates the missing rings from the wind. No points are added next to a point without a
/// known wind, between winds of different averaging periods, or between two points at or before
/// `from`.
/// @param from UTC [s since 1970]
StormTrack FineTrack(const StormTrack& track, std::int64_t from);

/// Scales the estimated radii after the last report. The last report is the last recorded point
/// with a reported radius of the weakest wind. Each radius becomes its estimate times a factor. At
/// the report, the factor is reported radius / estimate. After the report, ln(factor) in units of
/// SizeSigma decays with the decay time `memory_h`. Also sets StormWaypoint::keeps_radii of the
/// recorded points and StormWaypoint::size of the scaled points.
/// @param storm result of ToRings for `track`
/// @param memory_h see kSizeMemory_h
/// @returns UTC of the last report [s since 1970]; nullopt if there is none
std::optional<std::int64_t> CarrySize(const StormTrack& track, double memory_h, StormRings& storm);

/// A storm with points between those of its track.
struct FineRings {
  StormRings storm;     ///< `estimated` and `silent` count the track's own points
  std::int32_t held{};  ///< number of intervals in which the larger radii of both ends apply
};
/// Returns the rings of a track after FineTrack and CarrySize. Also adds points, at most
/// kFineTrack_s apart, to intervals that are longer than kFineTrack_s and that FineTrack did not
/// divide. Each of these points has the larger radii of both ends, to be on the safe side. No
/// points are added next to a point whose wind and radii are unknown.
/// @param from no points are added between two points at or before this time, UTC [s since 1970]
/// @param winds_kt see ToRings
/// @param memory_h see kSizeMemory_h
FineRings ToFineRings(const StormTrack& track, RingReduction reduction, std::int64_t from,
                      const std::vector<std::int32_t>& winds_kt = {},
                      double memory_h = kSizeMemory_h);

}  // namespace aquafarm
