// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts a published track to a disaster of a farm (§2.1). Each wind ring becomes a circle, or
/// optionally a ring with four quadrants, with a risk. The innermost risk is the worst.
///
///   64 kt (force 12) ── risks[0]      the winds are 64, 50 and 34 kt, or 50 and 30 kt if the
///   50 kt (force 10) ── risks[1]      source is the JMA; a ring that a fix does not contain is
///   34 kt (force 7)  ── risks[2]      estimated (tracks/wind_radii.h) and counted

#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "aquafarm/tracks/storm_path.h"
#include "aquafarm/tracks/storm_rings.h"

namespace aquafarm {

/// The default risks that `aquafarm scenario` writes, one for each of three rings. [decided]
const GradeRisks& DefaultGradeRisks();

/// Returns the number of whole steps that cover a period, at least one.
/// @throws InputError "duration: got …" for more than ten million
std::int32_t StepsToCover(double span_s, double step_duration_s);

/// Returns the disaster that follows a storm on a grid. A storm with fewer rings than `risks` has
/// columns uses the last risks of a row. A storm with more rings repeats the first risk for the
/// inner ones.
/// @param start_time UTC of step 0
DisasterSpec ToDisaster(const StormRings& storm, const GradeRisks& risks, const GeoFrame& frame,
                        double cell_size_m, double step_duration_s, std::int64_t start_time);

/// Returns the disaster that a bulletin announces to a running episode. The grade_risks are those
/// of the disaster that it replaces, else those of the first disaster of the scenario with
/// grade_risks, else the defaults. It has quadrants if the replaced disaster has quadrants.
/// It follows the recorded positions and then the newest forecast; its rings between their points
/// are those of ToFineRings, as in a rescue plan. Agents receive the forecast
/// as one of DisasterSpec::forecasts, issued at the last recorded position. FitArrival
/// (farm/forecast.h) then sets the truth apart from it.
/// @param id of the disaster that is replaced or added
/// @param step_now of the episode: the disaster lasts from this step to the last waypoint, at least
///   one step
/// @throws InputError for a scenario without grid.origin or time.start, or for a bulletin that is
///   known only until before step_now
DisasterSpec ToDisaster(const StormTrack& bulletin, const Scenario& scenario, std::int32_t id,
                        std::int32_t step_now);

}  // namespace aquafarm
