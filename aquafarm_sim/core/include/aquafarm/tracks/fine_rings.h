// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The rings of a storm between the points of its track, for farms, pictures and rescue plans.
///
/// A storm's radii are not linear in time: ln r grows with the square root of the wind, and the
/// radius of 34 kt is about 160 km as soon as the wind reaches 34 kt. Linear radii between the
/// points of a bulletin, 12 to 24 hours apart, are too small.
///
///   wind   35 kt ●━━━━━━━━━━━━━━━━━━━━● 30 kt    position and wind are linear, at most 3 h apart;
///   radius 170 km ●━━━●━━━●━━━●                   radii that are not reported follow from the wind
///                              ╲___●___● 0        and from the size of the last report

#include <cstdint>
#include <optional>
#include <vector>

#include "aquafarm/tracks/storm_rings.h"

namespace aquafarm {

/// Max time between two points of a track with a known wind [s].
inline constexpr std::int64_t kFineTrack_s = 3 * 3600;
/// Time in which the logarithm of a storm's size relative to its estimate, in units of SizeSigma,
/// falls by a factor of e [h]; docs/plan.md has its source.
inline constexpr double kSizeMemory_h = 165.0;

/// Returns the track with points at most kFineTrack_s apart. Position and wind of a new point are
/// linear between its neighbours. It has the rings that both of them have, linear as well, unless
/// exactly one of them has radius 0 for this wind; its other rings are left to be estimated from
/// its wind. No points are added next to a point without a known wind, between winds of different
/// averaging periods, or in legs that end at or before `from`.
/// @param from UTC [s since 1970]
StormTrack FineTrack(const StormTrack& track, std::int64_t from);

/// Scales the radii that are estimated after the last report with radii: each becomes the estimate
/// times a factor. At the report the factor is reported radius / estimate. After it, the logarithm
/// of the factor, in units of its standard deviation at the storm's wind (SizeSigma), decays with
/// `memory_h`.
/// @param storm rings of `track`, with the same fixes
/// @param memory_h see kSizeMemory_h
/// @returns UTC of that report; nullopt if there is none
std::optional<std::int64_t> CarrySize(const StormTrack& track, double memory_h, StormRings& storm);

/// A storm with points between those of its track.
struct FineRings {
  StormRings storm;     ///< `estimated` and `silent` count the track's own points
  std::int32_t held{};  ///< legs with points of the larger radii of both ends
};
/// Returns the rings of a track as FineTrack and CarrySize make them. Between two points that
/// FineTrack does not interpolate, the larger radii of both hold at points at most kFineTrack_s
/// apart, to be on the safe side. No points are added next to a point whose wind and radii are
/// unknown.
/// @param from no points are added in legs that end at or before it, UTC [s since 1970]
/// @param winds_kt see ToRings
FineRings ToFineRings(const StormTrack& track, RingReduction reduction, std::int64_t from,
                      const std::vector<std::int32_t>& winds_kt = {},
                      double memory_h = kSizeMemory_h);

}  // namespace aquafarm
