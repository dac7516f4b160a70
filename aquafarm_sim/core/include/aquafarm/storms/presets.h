// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Disasters other than storms with a track (§1), from what people know of them: a wave height, a
/// warning level, an area, a wind and a current. docs/data.md names the source of every number.
///
///   storm:wind_mps=18,radius_km=50                       signal by mean wind
///   storm_surge:level=3,radius_km=30                     warning tide level reached
///   wave:height_m=4,radius_km=10                         significant height near the shore
///   red_tide:area_km2=120,current_mps=0.3,current_to_deg=45
///   oil_spill:area_km2=2,wind_mps=8,wind_from_deg=315,current_mps=0.2,current_to_deg=90
///   chemical_spill:…                                     as oil_spill
///
/// Each has grade, two rings (all of it, and the half of its area around the middle) with the risks
/// of its grade, and drifts: with the current, spills besides with 3 % of the wind, 15 degrees to
/// the right of it in the north (to the left in the south). `growth_m_h` widens both rings,
/// `duration_h` (24) ends it.

#include <string>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// What turns metres and hours into cells and steps.
struct GridScale {
  double cell_size_m{1000.0};
  double step_duration_s{180.0};
  bool south{};  ///< of the equator
};

/// The disaster that a text describes; its centre is drawn anywhere on the enlarged map.
/// @throws InputError "disaster: wave: height_m: got 1, expected [2.5, 30]"; an unknown kind or key
///         is answered with those there are
DisasterSpec ParseDisasterPreset(const std::string& text, const GridScale& scale);

}  // namespace aquafarm
