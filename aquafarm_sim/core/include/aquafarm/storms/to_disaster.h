// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts a published track to a disaster of a farm (paper §2.1, see docs/model.md). Each wind
/// ring becomes a ring with a risk: a circle, or a ring with four quadrants. The innermost risk is
/// the worst.
///
///   64 kt (force 12) ── risks[0]      The winds are 64, 50 and 34 kt, or 50 and 30 kt for tracks
///   50 kt (force 10) ── risks[1]      of the JMA. The radius of a ring that a fix does not contain
///   34 kt (force 7)  ── risks[2]      is estimated (tracks/wind_radii.h).

#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "aquafarm/tracks/storm_path.h"
#include "aquafarm/tracks/storm_rings.h"

namespace aquafarm {

/// Returns the risks that `aquafarm scenario` writes for storms: for each of the grades 1 to 4, the
/// risks of three rings. They are our choice; the paper has no such table.
const GradeRisks& DefaultGradeRisks();

/// Returns the smallest number of whole steps that cover a period, at least one.
/// @throws InputError "duration: got …" if this is more than ten million steps
std::int32_t StepsToCover(double span_s, double step_duration_s);

/// Returns the disaster that follows a storm on a grid. If a row of `risks` has more risks than the
/// storm has rings, the last risks of the row apply. If the row has fewer risks, the innermost
/// rings share its first risk.
/// @param storm with at least one waypoint and at most three rings
/// @param risks of the grades 1 to 4
/// @param start_time UTC of step 0 [s since 1970]
/// @throws InputError in the same cases as ToPath and StepsToCover
DisasterSpec ToDisaster(const StormRings& storm, const GradeRisks& risks, const GeoFrame& frame,
                        double cell_size_m, double step_duration_s, std::int64_t start_time);

/// Returns the disaster that a bulletin announces during an episode. Its risks by grade are those
/// of disaster `id` of the scenario. If that disaster does not exist or has no risks by grade, they
/// are those of the first disaster of the scenario that has them, else DefaultGradeRisks. The new
/// disaster has quadrants if disaster `id` of the scenario has quadrants.
///
/// The disaster follows the recorded positions and then the newest forecast. Without a forecast the
/// storm keeps its motion for 24 hours. The rings between the points are those of ToFineRings, as
/// in a rescue plan. DisasterSpec::forecasts contains the forecast, issued at the last recorded
/// position. With view.forecast_error_km, FitArrival (farm/forecast.h) later moves the true
/// waypoints.
/// @param id id of the disaster that is replaced or added
/// @param step_now present step of the episode; the disaster lasts from this step to its last
///   waypoint
/// @throws InputError if the scenario has no grid.origin or time.start, or if the storm is not
///   known after step_now; also in the same cases as ToPath and StepsToCover
DisasterSpec ToDisaster(const StormTrack& bulletin, const Scenario& scenario, std::int32_t id,
                        std::int32_t step_now);

}  // namespace aquafarm
