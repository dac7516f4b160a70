// SPDX-License-Identifier: BSD-3-Clause
// Forecasts and storms that arrive during an episode, and access to bulletins.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/scenario/validate.h"
#include "base/text.h"

namespace aquafarm {
namespace {

// Returns a disaster of the farm. @throws InputError if there is no such disaster
const Disaster& Present(const Farm& farm, std::int32_t disaster) {
  const auto count = static_cast<std::int32_t>(farm.disasters().size());
  if (disaster >= 0 && disaster < count) {
    return farm.disasters()[static_cast<std::size_t>(disaster)];
  }
  throw InputError("disaster: got " + std::to_string(disaster) + ", expected one of the " +
                   std::to_string(count) + " disasters of this episode; add it without " +
                   "forecast_only");
}

// Checks the numbers of a forecast with ValidateDisaster. The forecast is checked as part of a spec
// that has as many rings as `disaster`. All other values of this spec are valid.
void CheckNumbers(const Disaster& disaster, const IssuedForecast& forecast) {
  DisasterSpec spec;
  spec.track = {RingsOf(disaster)};
  Waypoint& first = spec.track[0];
  for (std::size_t k = 0; k < first.radii.size(); ++k) {  // radii and risks that pass every check
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

// Returns the newest forecast of a storm. If this forecast is issued after `step`, returns another
// forecast instead: it is issued at `step`, and its points are the waypoints of the track after
// `step`.
IssuedForecast IssuedBy(float step, const DisasterSpec& storm) {
  IssuedForecast forecast = storm.forecasts.back();
  if (forecast.step <= step) return forecast;
  forecast.step = step;
  forecast.points.clear();
  for (const Waypoint& point : storm.track) {
    if (point.step > step) forecast.points.push_back(point);
  }
  return forecast;
}

// Throws InputError about a step of a forecast if `fits` is false.
void RequireStep(const char* what, float got, const std::string& expected, bool fits) {
  if (fits) return;
  throw InputError(std::string("forecast.") + what + ": got " + internal::Format(got) +
                   ", expected " + expected);
}

}  // namespace

void CheckForecast(const Farm& farm, std::int32_t disaster, const IssuedForecast& forecast) {
  CheckNumbers(Present(farm, disaster), forecast);
  const auto now = static_cast<float>(farm.step());
  const std::string present = "the present step, " + internal::Format(now);
  RequireStep("step", forecast.step, "at most " + present, forecast.step <= now);
  const float last = forecast.points.back().step;
  RequireStep("points", last, "a last point after " + present, last > now);
  if (const IssuedForecast* newest = NewestForecast(farm, disaster, farm.step())) {
    RequireStep("step", forecast.step,
                "at least the step of the newest forecast, " + internal::Format(newest->step),
                forecast.step >= newest->step);
  }
}

IssuedForecast FitForecast(const Farm& farm, std::int32_t disaster, const DisasterSpec& storm) {
  const auto now = static_cast<float>(farm.step());
  IssuedForecast forecast = IssuedBy(now, storm);
  const Disaster& present = Present(farm, disaster);
  const bool same = storm.track[0].radii.size() == static_cast<std::size_t>(present.rings) &&
                    storm.track[0].quadrants.empty() != present.by_quadrant;
  for (Waypoint& point : forecast.points) {
    if (same) continue;
    point.radii.clear();
    point.risks.clear();
    point.quadrants.clear();
  }
  return forecast;
}

void FitArrival(const Farm& farm, std::int32_t disaster, DisasterSpec& spec) {
  if (spec.forecasts.empty()) return;
  const auto now = static_cast<float>(farm.step());
  IssuedForecast& newest = spec.forecasts.back();
  newest = IssuedBy(now, spec);
  const ViewSpec& view = farm.scenario().view;
  if (view.forecast_error_km.empty()) return;
  const std::array<float, 2> unit = ForecastErrorVector(farm.seed(), farm.episode(), disaster);
  for (Waypoint& point : spec.track) {
    if (point.step <= newest.step) continue;
    const float error = MeanForecastError(farm.scenario(), point.step - newest.step);
    point.x -= error * unit[0];
    point.y -= error * unit[1];
  }
}

const Bulletin& Farm::BulletinOf(std::size_t disaster) const {
  static const Bulletin kNotIssued;
  return bulletins_.empty() ? kNotIssued : bulletins_[disaster];
}

void Farm::IssueForecast(std::int32_t id, const IssuedForecast& forecast) {
  CheckForecast(*this, id, forecast);
  const auto k = static_cast<std::size_t>(id);
  // Drops the forecasts that were set earlier. No ship can still observe one of them, because in
  // partial view a bulletin is issued now.
  forecasts_[k] = std::make_shared<const std::vector<IssuedForecast>>(1, forecast);
  if (scenario_->view.mode == ViewMode::kPartial) IssueBulletin(k);
}

}  // namespace aquafarm
