// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Forecasts of a disaster's track that agents observe. The disaster itself follows its true track.
/// There are two sources of forecasts: an authority (DisasterSpec::forecasts and
/// Farm::IssueForecast), or the true track plus a position error that grows with the lead time
/// (view.forecast_error_km).
///
///      truth     o----o----o----o      second source: truth(t) + error(t - issued) · u,
///      forecast  o-----o-----o-----o   linear between waypoints; error is MeanForecastError,
///               issued +24 h +48 h     which is 0 at the step of issue
///
/// The newest forecast of an authority applies until the step of its last point; see
/// NewestForecast. Its path leads from the current position to its points in the future. After the
/// last point the disaster keeps the motion between the last two points, or its current motion if
/// there is only one point. It stops where the true track or the disaster ends.
///
/// The rings of this forecast are those of its points. If the points have no rings, the rings are
/// those of the true track, or for a disaster without a track the current ones, which grow by
/// radius_growth per step. If the points of a disaster without a track have rings, these grow after
/// the last point by radius_growth if it is positive.
///
/// While no forecast of an authority applies, agents observe the second source if the scenario has
/// view.forecast_error_km and the disaster has a track. If not, they observe the current motion.
/// The forecasts of the scenario apply only while the disaster follows the track of the scenario.
///
/// u is drawn once per episode and disaster, with a mean length of 1 and a random direction.
/// Successive forecasts of one storm therefore err to the same side, and their error at a given
/// time shrinks as the time comes closer. [decided], see docs/model.md

#include <array>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

/// Number of steps from now to the forecast position that agents observe.
inline constexpr std::int32_t kForecastSteps = 10;

/// Returns the mean distance between the forecast and the true position [cells]. It is interpolated
/// linearly between 0 at lead time 0 and the errors after 24, 48 and 72 hours. Beyond 72 hours it
/// is extrapolated from the last two errors.
/// @param scenario must have view.forecast_error_km @param lead lead time [steps], at least 0
float MeanForecastError(const Scenario& scenario, float lead);

/// Returns the vector u of a disaster in an episode. Its components are approximately normal, and
/// its mean length is 1.
std::array<float, 2> ForecastErrorVector(std::uint64_t seed, std::uint64_t episode,
                                         std::int32_t disaster);

/// Returns the newest forecast of an authority that was issued by step `issued` and has a point
/// after it; nullptr if there is none. The pointer is valid until the farm changes.
const IssuedForecast* NewestForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Checks a forecast for Farm::IssueForecast. @throws InputError if it is not acceptable
void CheckForecast(const Farm& farm, std::int32_t disaster, const IssuedForecast& forecast);

/// Prepares a storm for Farm::SetDisaster; does nothing if it has no forecast. If the step of its
/// newest forecast is after the farm's current step, the forecast is issued now, with the later
/// waypoints of the track as its points. Without view.forecast_error_km the track stays as it is.
/// With view.forecast_error_km, the error (MeanForecastError times ForecastErrorVector) is
/// subtracted from the waypoints after the step of issue. The truth then differs from the forecast
/// as real storms differ from published forecasts.
void FitArrival(const Farm& farm, std::int32_t disaster, DisasterSpec& spec);

/// Returns the newest forecast of a storm, prepared for Farm::IssueForecast. If its step is after
/// the farm's current step, it is issued now, with the later waypoints of the storm's track as its
/// points. Its rings are left out if the disaster has another number of rings, or if only one of
/// them has quadrants.
/// @param storm must have a forecast
/// @throws InputError if the farm has no such disaster
IssuedForecast FitForecast(const Farm& farm, std::int32_t disaster, const DisasterSpec& storm);

/// Returns the current position, grade and rings of a disaster as a waypoint of step 0.
Waypoint RingsOf(const ObservableDisaster& disaster);

/// Implements HasForecast for a disaster with a track or an issued forecast.
bool HasForecastOfTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Returns whether agents whose newest information on a disaster is from step `issued` observe a
/// forecast of it. This check is inline because each observation calls it and most disasters have
/// neither a track nor an issued forecast.
inline bool HasForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const auto id = static_cast<std::size_t>(disaster);
  if (farm.tracks()[id]->empty() && farm.forecasts()[id] == nullptr) return false;
  return HasForecastOfTrack(farm, disaster, issued);
}

/// Returns the position of a disaster at `step` in the forecast of step `issued` [cells].
/// @param issued the current step, or the step of the last bulletin @param step at least `issued`
std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step);

/// Returns the forecast of step `issued` as a track that starts at that step.
std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

}  // namespace aquafarm
