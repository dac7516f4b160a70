// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Steps of MakeRescueCase.

#include "aquafarm/agents/rescue/rescue_case.h"

namespace aquafarm::agents {

/// Age from which a bulletin is old [h].
inline constexpr double kOldBulletin_h = 12.0;

/// Reads the storm. Sets storm, start, known time and central forecast.
void ReadStorm(const RescueRequest& request, RescueCase& rescue);
/// Sets name, rings, passage, central forecast and the steps of the ensemble from the whole track.
/// Requires storm.file, storm.issued, storm.known_until and start.
void UseStorm(const StormTrack& track, const RescueRequest& request, RescueCase& rescue);
/// Converts the damage per step of the ranch to damage per step of the ensemble.
double ExposureDamage(const RescueCase& rescue);
/// Reads ports, devices and ships.
void ReadFleet(const RescueRequest& request, RescueCase& rescue);
/// Whether the plan has costs of energy or ship-hours.
bool IsPriced(const RescueProblem& problem);
/// Formats a number with few digits.
std::string Short(double value, int digits);

}  // namespace aquafarm::agents
