// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Parts of MakeRescueCase, and helpers that several files of this folder use.

#include "aquafarm/agents/rescue/rescue_case.h"

namespace aquafarm::agents {

/// Age from which on a bulletin is old [h].
inline constexpr double kOldBulletin_h = 12.0;

/// Reads the storm file. Sets `start`, `storm`, `forecast` and `ensemble` of the case, and adds
/// warnings.
/// @throws InputError if the file is wrong, or if the storm is not known at and after the start of
///   the plan
void ReadStorm(const RescueRequest& request, RescueCase& rescue);
/// Sets the storm's name, rings, `held` and passage, the central forecast and the options of the
/// ensemble. storm.file, storm.issued, storm.known_until and `start` must be set.
/// @param track the reports and the forecast as one track
/// @throws InputError if the storm is not known after the start of the plan
void UseStorm(const StormTrack& track, const RescueRequest& request, RescueCase& rescue);
/// Returns RescueProblem::exposure_damage: the ranch's damage per step, converted to steps of the
/// ensemble.
double ExposureDamage(const RescueCase& rescue);
/// Sets water, ports, devices, ships and parameters of the problem of the case. Does not set
/// abort_ring.
/// @throws InputError if a file is wrong, if a position is not on water, or if no route by water
///   leads from a device of the CSV file to the first port
void ReadFleet(const RescueRequest& request, RescueCase& rescue);
/// Returns whether energy or ship-hours have a price.
bool IsPriced(const RescueProblem& problem);
/// Returns the name of a time zone: "UTC+8", "UTC-3:30".
std::string ZoneName(std::int32_t offset_min);
/// Formats a number with `digits` digits after the point.
std::string Short(double value, int digits);

}  // namespace aquafarm::agents
