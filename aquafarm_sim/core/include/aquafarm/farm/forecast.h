// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Forecasts of a disaster's track that agents observe. The disaster itself follows its true track.
/// There are two sources of forecasts. The first is an authority (DisasterSpec::forecasts and
/// Farm::IssueForecast). The second is the true track plus a position error that grows with the
/// lead time (view.forecast_error_km).
///
///      truth     o----o----o----o      second source: truth(t) + error(t - issued) · u,
///      forecast  o-----o-----o-----o   linear between waypoints; error is MeanForecastError,
///               issued +24 h +48 h     which is 0 at the step of issue
///
/// The newest forecast of an authority applies until the step of its last point; see
/// NewestForecast. Its path leads from the last known position to its later points. After the last
/// point the path continues with the motion between the last two points, or with the last known
/// motion of the disaster if there is only one point. The path ends at the end of the true track
/// or, without a track, when the disaster ends.
///
/// The rings of a forecast of an authority (ForecastTrack) are those of its points. If the points
/// have no rings, the rings of the true track apply. If there is also no true track, the current
/// rings apply and grow by radius_growth per step. If the points have rings but there is no true
/// track, the rings of the points grow only after the last point, and only if radius_growth is
/// positive.
///
/// While no forecast of an authority applies, agents observe the second source if the scenario has
/// view.forecast_error_km and the disaster has a track. If not, they observe the last known motion.
/// The forecasts of the scenario apply only while the disaster follows the track in the scenario.
///
/// The vector u is drawn once per episode and disaster. Its mean length is 1, and its direction is
/// random. Successive forecasts of one disaster therefore err to the same side. Their error at a
/// given time shrinks as this time comes closer. [decided], see docs/model.md

#include <array>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

/// Number of steps from now to the forecast position that agents observe.
inline constexpr std::int32_t kForecastSteps = 10;

/// Returns the mean distance between the forecast and the true position [cells]. It is interpolated
/// linearly between 0 at lead time 0 and the errors after 24, 48 and 72 hours. Beyond 72 hours it
/// is extrapolated from the last two errors.
/// @param scenario must have view.forecast_error_km
/// @param lead lead time [steps], at least 0
float MeanForecastError(const Scenario& scenario, float lead);

/// Returns the vector u of a disaster in an episode. Its components are approximately normal, and
/// its mean length is 1.
std::array<float, 2> ForecastErrorVector(std::uint64_t seed, std::uint64_t episode,
                                         std::int32_t disaster);

/// Returns the forecast of an authority that applies at step `issued`; nullptr if there is none.
/// Only forecasts issued at or before `issued` count. The candidates are the newest of these in the
/// scenario and the newest of these in Farm::forecasts. A candidate without a point after `issued`
/// is excluded. Returns the newer candidate. The pointer is valid until the farm changes.
const IssuedForecast* NewestForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Checks a forecast. @throws InputError if Farm::IssueForecast does not accept it
void CheckForecast(const Farm& farm, std::int32_t disaster, const IssuedForecast& forecast);

/// Prepares a storm for Farm::SetDisaster. Does nothing if the storm has no forecast. If its newest
/// forecast is issued after the farm's current step, changes the forecast: it is then issued now,
/// and its points are the later waypoints of the track. With view.forecast_error_km, also subtracts
/// the error (MeanForecastError times ForecastErrorVector) from the waypoints after the step of
/// issue. The true track then differs from the forecast as real tracks differ from published
/// forecasts. Without view.forecast_error_km the track does not change.
void FitArrival(const Farm& farm, std::int32_t disaster, DisasterSpec& spec);

/// Returns the newest forecast of a storm, prepared for Farm::IssueForecast. If the forecast is
/// issued after the farm's current step, the result is issued now, and its points are the later
/// waypoints of the storm's track. The result has no rings if storm and disaster differ in the
/// number of rings, or if only one of the two has quadrants.
/// @param storm must have a forecast and a track
/// @throws InputError if the farm has no such disaster
IssuedForecast FitForecast(const Farm& farm, std::int32_t disaster, const DisasterSpec& storm);

/// Returns the current position, grade and rings of a disaster as a waypoint of step 0.
Waypoint RingsOf(const ObservableDisaster& disaster);

/// Implements HasForecast for a disaster with a track or an issued forecast.
bool HasForecastOfTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Returns whether agents observe a forecast of a disaster. Inline, because each observation calls
/// it, and most disasters have neither a track nor an issued forecast.
/// @param issued step of the agents' newest information on the disaster
inline bool HasForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued) {
  const auto id = static_cast<std::size_t>(disaster);
  if (farm.tracks()[id]->empty() && farm.forecasts()[id] == nullptr) return false;
  return HasForecastOfTrack(farm, disaster, issued);
}

/// Returns the position of a disaster at `step` in the forecast of step `issued` [cells].
/// @param issued the current step, or the step of the last bulletin
/// @param step at least `issued`
std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step);

/// Returns the forecast of step `issued` as a track with rings that starts at that step.
std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

}  // namespace aquafarm
