// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Steps of MakeRescueCase.

#include "aquafarm/agents/rescue/rescue_case.h"

namespace aquafarm::agents {

/// Reads the storm: sets storm, start, the time that is known, and the central forecast.
void ReadStorm(const RescueRequest& request, RescueCase& rescue);
/// Reads ports, devices and ships.
void ReadFleet(const RescueRequest& request, RescueCase& rescue);
/// Formats a number with few digits.
std::string Short(double value, int digits);

}  // namespace aquafarm::agents
