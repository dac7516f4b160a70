// SPDX-License-Identifier: BSD-3-Clause
// Forecasts that are issued during an episode.
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/scenario/validate.h"
#include "base/text.h"

namespace aquafarm {
namespace {

// Checks the numbers of a forecast by the rules for a disaster with the rings of the present one.
void CheckForecast(const Disaster& disaster, const IssuedForecast& forecast) {
  DisasterSpec spec;
  spec.track = {RingsOf(disaster)};
  Waypoint& first = spec.track[0];
  for (std::size_t k = 0; k < first.radii.size(); ++k) {  // sizes that every rule accepts
    first.radii[k] = static_cast<float>(k + 1);
    first.risks[k] = kWorstRisk;
    if (!first.quadrants.empty()) first.quadrants[k].fill(first.radii[k]);
  }
  first.grade = 1;
  spec.radii = first.radii;
  spec.risks = first.risks;
  spec.quadrants = first.quadrants;
  spec.forecasts = {forecast};
  ValidateDisaster(spec);
}

void RequireStep(const char* what, float got, const std::string& expected, bool fits) {
  if (fits) return;
  throw InputError(std::string("forecast.") + what + ": got " + internal::Format(got) +
                   ", expected " + expected);
}

}  // namespace

void Farm::IssueForecast(std::int32_t id, const IssuedForecast& forecast) {
  const auto count = static_cast<std::int32_t>(disasters_.size());
  if (id < 0 || id >= count) {
    throw InputError("disaster: got " + std::to_string(id) + ", expected [0, " +
                     std::to_string(count - 1) + "], a disaster of this episode");
  }
  const auto k = static_cast<std::size_t>(id);
  CheckForecast(disasters_[k], forecast);
  const auto now = static_cast<float>(record_.steps);
  const std::string present = "the present step, " + internal::Format(now);
  RequireStep("step", forecast.step, "at most " + present, forecast.step <= now);
  const float last = forecast.points.back().step;
  RequireStep("points", last, "a last point after " + present, last > now);
  if (const IssuedForecast* newest = NewestForecast(*this, id, record_.steps)) {
    RequireStep("step", forecast.step,
                "at least that of the newest forecast, " + internal::Format(newest->step),
                forecast.step >= newest->step);
  }
  // Earlier forecasts are not kept: the bulletin tells all ships the new one.
  forecasts_[k] = std::make_shared<const std::vector<IssuedForecast>>(1, forecast);
  if (scenario_->view.mode == ViewMode::kPartial) IssueBulletin(k);
}

}  // namespace aquafarm
