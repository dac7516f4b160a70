// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Disasters without a track (paper §1, see docs/model.md), described by observed quantities: wave
/// height, warning level, area, wind or current. docs/data.md lists the source of every number.
///
///   storm:wind_mps=18,radius_km=50                       grade from the mean wind
///   storm_surge:level=3,radius_km=30                     warning tide level reached, 1 to 4
///   wave:height_m=4,radius_km=10                         significant height near the shore
///   red_tide:area_km2=120,current_mps=0.3,current_to_deg=45
///   oil_spill:area_km2=2,wind_mps=8,wind_from_deg=315,current_mps=0.2,current_to_deg=90
///   chemical_spill:…                                     as oil_spill
///
/// Each disaster has a grade and two rings with the risks of that grade. At the start the inner
/// ring has half of the area of the outer ring. The observed quantity determines the grade; for a
/// spill, the key `grade` (default 3) does. Every disaster drifts with the current. Spills also
/// drift with 3 percent of the wind speed. This drift is turned from the direction of the wind by
/// 15 degrees: to the right in the northern hemisphere, to the left in the southern. Both radii
/// grow by `growth_m_h` [m/h] (default 0). The disaster ends after `duration_h` hours (default 24).

#include <string>
#include <vector>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Scale of a farm, which converts metres and hours to cells and steps.
struct GridScale {
  double cell_size_m{1000.0};
  double step_duration_s{180.0};
  bool south{};  ///< true if south of the equator
};

/// Returns the names of the presets, such as "oil_spill".
std::vector<std::string> DisasterPresetNames();

/// Parses the description of a disaster. DisasterSpec::start remains unset, so that each episode
/// draws the centre.
/// @throws InputError "disaster: wave: height_m: got 1, expected [2.5, 30]". For an unknown kind or
///   key, the message lists the valid ones.
DisasterSpec ParseDisasterPreset(const std::string& text, const GridScale& scale);

}  // namespace aquafarm
