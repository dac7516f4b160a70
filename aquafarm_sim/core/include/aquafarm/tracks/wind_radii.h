// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Radius of the winds of a storm from its greatest wind and its latitude.
///
///   ln r = a + b sqrt(V / w - 1) + c (|latitude| - 25)          r in km, V and w in one unit
///
/// r is the radius of the circle with the area of the ring of winds of at least w. b and c depend
/// on w, a on w and on the authority, which is recognized by the averaging period of its winds.
///
/// b and c are fitted to 5,891 rings of 169 storms, 2015 to 2021 (JMA, 30 and 50 kt). a of the CMA
/// also reproduces the median errors of the former estimate over 24,494 bulletin rings.
/// docs/data.md states errors and sources; tools/fit_wind_radii.py makes the fit again.

#include <cstdint>

#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// Estimate of a radius with its uncertainty: ln(radius) has the standard deviation log_sigma.
struct RadiusEstimate {
  double median_km{};  ///< 0 if the wind does not blow anywhere in the storm
  double log_sigma{};  ///< 0 if median_km is 0
};

/// Estimates the radius of the winds of at least `wind_kt`.
/// @param wind_kt 30, 34, 50 or 64
/// @param storm_wind_mps greatest mean wind of the storm. A wind of at least 98 % of wind_kt counts
///   as reaching it: the lower limits of the grades are rounded (TS from 17.2 m/s, which is 33.4
///   kt)
/// @param latitude [degrees], north or south
/// @param averaging_min averaging period of the wind: 10 (JMA), 1 (JTWC), else as the CMA
RadiusEstimate EstimateRadius(std::int32_t wind_kt, double storm_wind_mps, double latitude,
                              std::int32_t averaging_min);

/// Returns the log-standard deviation of recorded radii of a wind about EstimateRadius, by the
/// storm's greatest wind; that of the weakest storms if it does not reach `wind_kt` or is unknown.
double SizeSigma(std::int32_t wind_kt, double storm_wind_mps, double latitude,
                 std::int32_t averaging_min);

/// Adds the ring of a wind, marked as estimated, to a fix that has no ring of this wind: a circle
/// with the median radius of EstimateRadius.
/// @param wind_kt 30, 34, 50 or 64
/// @returns whether a ring was added; false if the wind is unknown
bool EstimateRing(StormFix& fix, std::int32_t wind_kt);

}  // namespace aquafarm
