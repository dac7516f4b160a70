// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Slots for the features of the disasters that a ship knows (view.disaster_slots). With slots, the
/// features are ordered by danger instead of by disaster id. Slot 0 describes the most dangerous
/// disaster, slot 1 the next one, and so on (RankByDanger in view.h). To a learner, disasters that
/// arrive during an episode therefore look the same as those of the scenario.
///
/// The number of slots is the number of disasters in the scenario plus view.disaster_slots. If
/// there are more known disasters than slots, the least dangerous ones are left out. Unused slots
/// contain zeros.

#include <string>
#include <vector>

#include "aquafarm/observation/view.h"

namespace aquafarm {

/// Returns the number of slots; 0 if view.disaster_slots is 0.
std::int32_t SlotCount(const Scenario& scenario);

/// Returns the names of the features of all slots, in order.
std::vector<std::string> SlotNames(const Scenario& scenario);

/// Writes the features of all slots.
/// @param length_scale 1 / longer side of the map [1/cells]
/// @param out [SlotNames(*view.scenario).size()]
void WriteSlots(float length_scale, const View& view, float* out);

}  // namespace aquafarm
