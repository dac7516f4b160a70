// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Steps of MakeRescueCase.

#include "aquafarm/agents/rescue/rescue_case.h"

namespace aquafarm::agents {

/// Age from which a bulletin is old [h].
inline constexpr double kOldBulletin_h = 12.0;

/// Reads the storm: sets storm, start, the time that is known, and the central forecast.
void ReadStorm(const RescueRequest& request, RescueCase& rescue);
/// Sets name, rings, passage and central forecast from the whole track, and the steps of the
/// ensemble. Needs storm.file, start, and storm.issued and known_until.
void UseStorm(const StormTrack& track, const RescueRequest& request, RescueCase& rescue);
/// Damage per step of the ensemble, from that per step of the ranch.
double ExposureDamage(const RescueCase& rescue);
/// Reads ports, devices and ships.
void ReadFleet(const RescueRequest& request, RescueCase& rescue);
/// Whether the plan has costs of energy or ship-hours.
bool IsPriced(const RescueProblem& problem);
/// Formats a number with few digits.
std::string Short(double value, int digits);

}  // namespace aquafarm::agents
