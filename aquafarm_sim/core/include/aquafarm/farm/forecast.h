// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What agents are told of a disaster's way while the truth follows its track: what an authority
/// forecast (a disaster's `forecasts`), or a forecast whose positions are off by an error that
/// grows with lead time (view.forecast_error_km).
///
///      truth     o----o----o----o      forecast(t) = truth(t) + mean error(t - issued) · u
///      forecast  o-----o-----o-----o   between waypoints straight, at once exact
///               issued +24 h +48 h
///
/// Of an authority's forecasts the newest counts, from where the storm is on to those of its points
/// that are to come, then on as between the last two, while the truth has a track. Before the first
/// was issued, and after the newest has run out, agents are told how the storm moves now. So they
/// are of a storm that a bulletin has replaced in play.
///
/// u is drawn once an episode and disaster, with a mean length of 1 and any direction: successive
/// forecasts of one storm err to the same side, and each is better than the one before. [decided]

#include <array>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

/// Steps after now for which agents are told where a disaster will be.
inline constexpr std::int32_t kForecastSteps = 10;

/// Mean distance of a forecast position from the true one [cells]: straight between nothing at
/// once and the errors after 24, 48 and 72 hours, and on as between the last two.
/// @param lead [steps], at least 0 @param scenario with view.forecast_error_km
float MeanForecastError(const Scenario& scenario, float lead);

/// u of a disaster in an episode: near to a normal distribution in both parts, mean length 1.
std::array<float, 2> ForecastErrorVector(std::uint64_t seed, std::uint64_t episode,
                                         std::int32_t disaster);

/// Whether at a step agents of a farm are told a forecast of a disaster.
bool HasForecast(const Farm& farm, std::int32_t disaster, std::int32_t issued);

/// Where the forecast told at one step has a disaster at a later one [cells]. Only positions are
/// off: radii and risks are the truth's.
std::array<float, 2> ForecastAt(const Farm& farm, std::int32_t disaster, std::int32_t issued,
                                std::int32_t step);

/// The forecast told at a step as a track, from then on.
std::vector<Waypoint> ForecastTrack(const Farm& farm, std::int32_t disaster, std::int32_t issued);

}  // namespace aquafarm
