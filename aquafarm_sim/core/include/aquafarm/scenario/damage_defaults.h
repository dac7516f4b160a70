// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Factors of the damage by kinds for real ranches. The order of the numbers in a row and in a
/// column follows published reasons; their sizes are our assumption (docs/data.md, Damage by
/// kinds).

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// damage.kinds of the shipped real ranches and of ranches that `aquafarm scenario` makes.
inline constexpr DamageFactors kRealDamage{{
    // typhoon, storm_surge, wave, red_tide, oil_spill, chemical_spill
    {1.5F, 1.5F, 1.5F, 2.0F, 1.5F, 1.5F},     // temporary_breeding
    {1.25F, 0.5F, 1.5F, 0.0F, 0.25F, 0.25F},  // monitoring
    {1.0F, 1.0F, 1.0F, 1.5F, 1.5F, 1.5F},     // breeding_release
    {0.75F, 0.5F, 0.75F, 1.5F, 1.0F, 1.0F},   // deep_water_breeding
}};

}  // namespace aquafarm
