// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Features of the disasters that a ship knows, in slots, the most dangerous disaster first
/// (view.disaster_slots). The slots replace the features by id, so a learner observes a disaster
/// that arrives during play exactly as it observes one of the scenario.
///
///   slot0  the most dangerous known disaster     number of slots: the scenario's own disasters
///   slot1  the next one                          plus view.disaster_slots; the least dangerous
///   ...    0 if there is none                    disasters are left out if there are more
///
/// RankByDanger (view.h) defines the order.

#include <string>
#include <vector>

#include "aquafarm/observation/view.h"

namespace aquafarm {

/// Returns the number of slots; 0 without view.disaster_slots.
std::int32_t SlotCount(const Scenario& scenario);

/// Returns the names of the features of all slots, in order.
std::vector<std::string> SlotNames(const Scenario& scenario);

/// Writes the features of all slots.
/// @param length_scale 1 / longer side [1/cells] @param out [SlotNames().size()]
void WriteSlots(float length_scale, const View& view, float* out);

}  // namespace aquafarm
