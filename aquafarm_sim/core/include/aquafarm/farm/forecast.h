// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Forecasts of a disaster's track that agents observe. The disaster itself follows its true track.
/// A forecast is either one issued by an authority (a disaster's `forecasts` and
/// Farm::IssueForecast) or the true track with a position error that grows with lead time
/// (view.forecast_error_km).
///
///      truth     o----o----o----o      forecast(t) = truth(t) + mean error(t - issued) · u
///      forecast  o-----o-----o-----o   linear between waypoints, exact at lead time 0
///               issued +24 h +48 h
///
/// The newest forecast of an authority applies. It leads from the current position to the points
/// that lie in the future. After its last point the disaster keeps the motion between the last two
/// points, or its present motion if there is one point, until the true track or the disaster ends.
/// Its rings are those of its points, or the true ones if its points have none. The rings of a
/// disaster without a track grow by radius_growth from the present step on. If points have rings,
/// growth starts after the last of these points, and shrinking is ignored. Before the first
/// forecast is issued and after the newest one expires, agents observe the current motion of the
/// storm. If a new track replaces that of the scenario, the forecasts of the scenario no longer
/// apply.
///
/// u is drawn once per episode and disaster, with a mean length of 1 and a random direction.
/// Successive forecasts of one storm therefore err to the same side, and each is more accurate than
/// the previous one. [decided], see docs/model.md

#include <array>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

/// Lead time, counted from now, of the forecast position that agents observe [steps].
inline constexpr std::int32_t kForecastSteps = 10;

/// Returns the mean distance between the forecast and the true position [cells]. It is interpolated
/// linearly between 0 at lead time 0 and the errors after 24, 48 and 72 hours, and extrapolated
/// from the last two.
/// @param lead [steps], at least 0 @param scenario with view.forecast_error_km
float MeanForecastError(const Scenario& scenario, float lead);

/// Returns u of a disaster in an episode: approximately normal in both components, mean length 1.
std::array<float, 2> ForecastErrorVector(std::uint64_t seed, std::uint64_t episode,
                                         std::int32_t disaster);

/// Returns the forecast of an authority that applies at step `issued`; nullptr if there is none or
/// the newest one has expired. The pointer is valid until the farm changes.
const IssuedForecast* NewestForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Checks whether Farm::IssueForecast accepts a forecast. @throws InputError if it does not
void CheckForecast(const Farm& farm, std::int32_t disaster, const IssuedForecast& forecast);

/// Fits a storm to a farm before Farm::SetDisaster. A forecast that is issued in the farm's future
/// is issued now. Without view.forecast_error_km the true track follows the forecast. With it, the
/// waypoints after the issue of the newest forecast are moved by minus the error of the farm's
/// episode. The truth is then as far from the forecast as storms are from published forecasts.
void FitArrival(const Farm& farm, std::int32_t disaster, DisasterSpec& spec);

/// Returns the newest forecast of a storm, fitted to a farm for Farm::IssueForecast: a forecast
/// that is issued in the farm's future is issued now and begins with the storm's next waypoint. Its
/// rings are left out if the disaster has another number of rings.
/// @param storm with a forecast
IssuedForecast FitForecast(const Farm& farm, std::int32_t disaster, const DisasterSpec& storm);

/// Returns the present position and rings of a disaster as a waypoint of step 0.
Waypoint RingsOf(const ObservableDisaster& disaster);

/// HasForecast for a disaster that has a track or an issued forecast; called by it.
bool HasForecastOfTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Returns whether the agents of a farm observe a forecast of a disaster at step `issued`. Each
/// observation calls it; most disasters have neither a track nor an issued forecast.
inline bool HasForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const auto id = static_cast<std::size_t>(disaster);
  if (farm.tracks()[id]->empty() && farm.forecasts()[id] == nullptr) return false;
  return HasForecastOfTrack(farm, disaster, issued);
}

/// Returns the position of a disaster at `step` in the forecast of step `issued` [cells].
std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step);

/// Returns the forecast of step `issued` as a track that starts at that step.
std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

}  // namespace aquafarm
