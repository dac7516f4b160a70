// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Damage factors for real ranches, by kind of device and kind of disaster. Published reasons
/// determine which factors of a row or column are larger than others. The values themselves are our
/// assumption (docs/data.md, Damage by kinds).

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Value of damage.kinds in the shipped scenarios of real places, and in the scenarios that
/// `aquafarm scenario` writes. Rows: kind of device. Columns: kind of disaster.
inline constexpr DamageFactors kRealDamage{{
    // typhoon, storm_surge, wave, red_tide, oil_spill, chemical_spill
    {1.5F, 1.5F, 1.5F, 2.0F, 1.5F, 1.5F},     // temporary_breeding
    {1.25F, 0.5F, 1.5F, 0.0F, 0.25F, 0.25F},  // monitoring
    {1.0F, 1.0F, 1.0F, 1.5F, 1.5F, 1.5F},     // breeding_release
    {0.75F, 0.5F, 0.75F, 1.5F, 1.0F, 1.0F},   // deep_water_breeding
}};

}  // namespace aquafarm
