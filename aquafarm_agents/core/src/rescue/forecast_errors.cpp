// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/forecast_errors.h"

#include <algorithm>
#include <cmath>

#include "aquafarm/base/angle.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

// Interpolates linearly between the points. Before the first and after the last point, extrapolates
// linearly from the nearest two points.
double Interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  AQUAFARM_CHECK_EQ(x.size(), y.size());
  AQUAFARM_CHECK_LE(std::size_t{2}, x.size());
  const auto after = std::upper_bound(x.begin(), x.end(), at) - x.begin();
  const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(after, 1, static_cast<std::ptrdiff_t>(x.size()) - 1));
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

}  // namespace

ForecastSpread SpreadAt(const ForecastErrors& errors, double lead_h) {
  const double lead = std::max(0.0, lead_h);
  const double position = Interpolate(errors.position_lead_h, errors.position_km, lead);
  const double wind = Interpolate(errors.wind_lead_h, errors.wind_mps, lead);
  return {errors.scale * position / std::sqrt(kPi / 2.0),
          errors.scale * wind * std::sqrt(kPi / 2.0)};
}

double SizeSpreadAt(const ForecastErrors& errors, double log_sigma, double since_report_h) {
  const double kept = std::exp(-std::max(0.0, since_report_h) / errors.size_memory_h);
  const double spread = errors.size_factor * log_sigma;
  return std::hypot(errors.size_report_error * kept, spread * std::sqrt(1.0 - kept * kept));
}

}  // namespace aquafarm::agents
