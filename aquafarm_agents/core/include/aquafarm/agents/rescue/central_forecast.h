// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The storm that an ensemble perturbs, and the size of the ensemble.

#include <cstdint>
#include <limits>
#include <vector>

#include "aquafarm/agents/rescue/forecast_errors.h"
#include "aquafarm/scenario/scenario.h"
#include "aquafarm/tracks/storm_path.h"

namespace aquafarm::agents {

/// A storm as an authority forecasts it, or, in a hindcast, as it was recorded later.
struct CentralForecast {
  StormPath path;  ///< in steps of the ensemble; step 0 is the start of the plan
  /// Time from the issue of the forecast to each point [h]; negative for earlier points.
  std::vector<double> lead_h;
  /// Lead time of the last observed point with reported radii [h]; minus infinity if none has them.
  double size_report_h{-std::numeric_limits<double>::infinity()};
  GradeRisks risks;  ///< risks of the rings for grades 1 to 4
};

/// Size and resolution of an ensemble.
struct EnsembleOptions {
  std::int32_t members{1000};
  std::uint64_t seed{1};
  ForecastErrors errors;
  std::int32_t width{};   ///< of the ranch [cells]
  std::int32_t height{};  ///< of the ranch [cells]
  double cell_size_km{};
  double step_s{};       ///< duration of a step [s]
  std::int32_t steps{};  ///< number of steps; step i is at the time i · step_s
};

}  // namespace aquafarm::agents
