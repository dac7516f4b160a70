// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Checks one disaster on its own: numbers finite and in range, radii ascending, as many risks as
/// radii. Serves scenario files and set_disaster alike.
/// @throws InputError "radii[1]: got 2, expected more than radii[0] = 4"
void ValidateDisaster(const DisasterSpec& disaster);

/// Checks what a reader of single keys cannot see: cells on the map, things not on one another,
/// counts that fit. A Scenario made in code must pass it before a Farm is built.
/// @throws InputError with the key path first
void ValidateScenario(const Scenario& scenario);

}  // namespace aquafarm
