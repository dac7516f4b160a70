// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Published errors of storm forecasts, by lead time.
///
/// | lead time [h]             | 0    | 24   | 48    | 72    | 96    | 120   |
/// |---------------------------|------|------|-------|-------|-------|-------|
/// | mean position error [km]  | 14.1 | 66.2 | 119.5 | 176.3 | 244.3 | 328.5 |
/// | mean wind error [m/s]     | 1.4  | 4.37 | 6.5   | 7.78  |       |       |
///
/// Positions: China Meteorological Administration in 2015 (Verification on forecasts of tropical
/// cyclones over western North Pacific in 2015, Meteorological Monthly 43(4), 2017, abstract).
/// Winds: middle of the range of four centres in 2012 (Chen, Yu and Cao 2013, Meteorological
/// Monthly 39(10), 1350-1358, abstract). Winds at lead time 0: National Meteorological Centre in
/// 2021 (Verification on typhoon forecasts … in 2022, Meteorological Monthly 50(5), 2024,
/// abstract). Errors are linear between these lead times, and continue linearly after the last one.
///
/// The sources contain only mean errors. It is assumed that errors are normal, have the same size
/// along and across the track, and are correlated by exp(-difference of lead times / 48 h). An
/// error along the track changes the time of arrival.
///
/// **Radii.** All radii of a storm are multiplied by one log-normal factor. Without reported radii,
/// the factor has the same spread as the ratio of recorded radii to the result of EstimateRadius
/// (tracks/wind_radii.h).
/// This spread depends on the storm's wind at each time. For the radii of 30 and 34 kt winds, it
/// is 0.45 if the storm's wind is below 48 kt, 0.41 from 48 kt and 0.35 from 64 kt. After a report
/// with radii, the spread grows from the error of the report to this value. The logarithm of
/// radius / EstimateRadius, in units of this spread, decays with exp(-time / 165 h). The 165 h are
/// fitted to the JMA's best tracks of 2015 to 2021. The autocorrelation of this logarithm
/// for the 30 kt radii of one storm is 0.87 after 24 h (2,864 pairs), 0.76 after 48 h, 0.64 after
/// 72 h, 0.55 after 96 h and 0.48 after 120 h (798 pairs).

#include <vector>

#include "aquafarm/tracks/fine_rings.h"

namespace aquafarm::agents {

/// Statistics of forecast errors. The default lead times and mean errors are those of the table
/// above.
struct ForecastErrors {
  std::vector<double> position_lead_h{0.0, 24.0, 48.0, 72.0, 96.0, 120.0};
  std::vector<double> position_km{14.1, 66.2, 119.5, 176.3, 244.3, 328.5};  ///< mean distances
  std::vector<double> wind_lead_h{0.0, 24.0, 48.0, 72.0};
  std::vector<double> wind_mps{1.4, 4.37, 6.5, 7.78};  ///< mean absolute errors
  /// Difference of lead times over which the correlation falls by a factor of e (assumed).
  double correlation_h{48.0};
  double size_factor{1.0};              ///< factor of the spread of radii (assumed)
  double size_memory_h{kSizeMemory_h};  ///< see kSizeMemory_h (tracks/fine_rings.h)
  double size_report_error{0.1};        ///< log-standard deviation of a reported radius (assumed)
  double scale{1.0};                    ///< factor of all errors: 0.5 halves them, 0 removes them
};

/// Standard deviations of the errors at one lead time.
struct ForecastSpread {
  double position_km{};  ///< of the position along the track, and also of that across the track
  double wind_mps{};     ///< of the wind
};

/// Returns the standard deviations at a lead time, multiplied by errors.scale. They follow from the
/// mean errors. A normal error with standard deviation s in each of two directions has the mean
/// distance s · sqrt(pi / 2). A normal error in one direction has the mean absolute value
/// s · sqrt(2 / pi).
/// @param lead_h hours after the issue of the forecast; a negative value counts as 0
ForecastSpread SpreadAt(const ForecastErrors& errors, double lead_h);

/// Returns the log-standard deviation of a storm's radii, not multiplied by errors.scale.
/// @param log_sigma standard deviation of the logarithm of (recorded radius / EstimateRadius)
/// @param since_report_h hours after the last report with radii; infinity without such a report
double SizeSpreadAt(const ForecastErrors& errors, double log_sigma, double since_report_h);

}  // namespace aquafarm::agents
