// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Estimates the radius of a storm's wind rings from its max wind and its latitude.
///
///   ln r = a + b sqrt(V / w - 1) + c (|latitude| - 25)       r in km, V and w in the same unit
///
/// Winds of at least w blow in an area that equals the area of a circle with radius r. V is the max
/// mean wind of the storm. b and c depend on w. The coefficient a depends on w and on the
/// authority, which the averaging period of the wind identifies.
///
/// b and c are fitted to 5,891 rings of 169 storms of the JMA, 30 and 50 kt, 2015 to 2021. For the
/// CMA, the coefficient a corrects an earlier estimate by the median errors of that estimate over
/// 24,494 rings of bulletins. docs/data.md states errors and sources. tools/fit_wind_radii.py
/// repeats the fit.

#include <cstdint>

#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// Estimate of a radius.
struct RadiusEstimate {
  double median_km{};  ///< 0 if the wind does not blow anywhere in the storm
  double log_sigma{};  ///< standard deviation of ln(radius); 0 if median_km is 0
};

/// Estimates the radius within which winds of at least `wind_kt` blow.
/// @param wind_kt 30, 34, 50 or 64
/// @param storm_wind_mps max mean wind of the storm. The estimate is 0 if this wind is below 98 %
///   of wind_kt. The 2 % allow for the rounded lower limits of the grades (TS from 17.2 m/s, which
///   is 33.4 kt).
/// @param latitude [degrees], north or south
/// @param averaging_min averaging period of the wind [min]: 10 selects the JMA, 1 the JTWC, another
///   number the CMA
RadiusEstimate EstimateRadius(std::int32_t wind_kt, double storm_wind_mps, double latitude,
                              std::int32_t averaging_min);

/// Returns RadiusEstimate::log_sigma of EstimateRadius. If the wind of the storm is unknown (NaN or
/// 0) or below `wind_kt`, `wind_kt` replaces it.
double SizeSigma(std::int32_t wind_kt, double storm_wind_mps, double latitude,
                 std::int32_t averaging_min);

/// Adds the ring of a wind, marked as estimated, to a fix that has no ring of this wind. The ring
/// is a circle with the median radius of EstimateRadius, which may be 0.
/// @param wind_kt 30, 34, 50 or 64
/// @returns whether a ring was added; false if the fix already has the ring or has no known wind
bool EstimateRing(StormFix& fix, std::int32_t wind_kt);

}  // namespace aquafarm
