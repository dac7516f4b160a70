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
/// Danger of a disaster for a ship: |worst risk| / (1 + gap / longer side of the map). The gap is
/// the smallest distance from the ship to the edge of the disaster, now or at one of the lead
/// times; 0 inside. At equal danger the lower id comes first. [decided]

#include <string>
#include <vector>

#include "aquafarm/observation/features.h"
#include "aquafarm/observation/view.h"

namespace aquafarm {

/// Returns the number of slots; 0 without view.disaster_slots.
std::int32_t SlotCount(const Scenario& scenario);

/// Returns lead time `lead` of view.forecast_leads_h in steps, at least 1.
std::int32_t LeadSteps(const Scenario& scenario, std::size_t lead);

/// Sets the forecast positions of a disaster to those of its present motion.
void ExtrapolateMotion(const Scenario& scenario, KnownDisaster& known);

/// Fills View::by_danger from the disasters and their forecast positions.
void RankByDanger(View& view);

/// Returns the names of the features of all slots, in order.
std::vector<std::string> SlotNames(const Scenario& scenario);

/// Writes the features of all slots. @param out [SlotNames().size()]
void WriteSlots(const FeatureScales& scales, const View& view, float* out);

}  // namespace aquafarm
