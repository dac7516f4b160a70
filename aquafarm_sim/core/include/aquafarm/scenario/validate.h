// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Validates one disaster, such as one that set_disaster receives. For example, numbers must be
/// finite and in range, radii must ascend, and each radius must have a risk.
/// @throws InputError "radii[1]: got 2, expected more than radii[0] = 4"
void ValidateDisaster(const DisasterSpec& disaster);

/// Validates all values of a scenario and the constraints between them. For example, cells must be
/// on the map, each cell may have only one object, and counts must fit the map. Only island blocks
/// may overlap. A Scenario created in code must pass this check before a Farm is constructed from
/// it.
/// @throws InputError whose message begins with the path of the invalid key
void ValidateScenario(const Scenario& scenario);

}  // namespace aquafarm
