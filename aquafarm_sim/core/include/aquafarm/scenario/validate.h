// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Validates one disaster: numbers are finite and in range, radii ascend, and each radius has a
/// risk. Used for scenario files and for set_disaster.
/// @throws InputError "radii[1]: got 2, expected more than radii[0] = 4"
void ValidateDisaster(const DisasterSpec& disaster);

/// Validates constraints between keys: cells are on the map, objects do not overlap, and counts fit
/// the map. A Scenario created in code must pass it before it is used to construct a Farm.
/// @throws InputError with the key path first
void ValidateScenario(const Scenario& scenario);

}  // namespace aquafarm
