// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Masks of the actions that a learner or policy may choose.

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

/// Returns the allowed actions: the legal ones if mask_illegal is true, else all.
inline ActionMask LegalMask(ActionMask legal, bool mask_illegal) {
  return mask_illegal ? static_cast<ActionMask>(legal & kAllActions) : kAllActions;
}

/// Returns the allowed actions. With options.mask_blocked, moves onto a charted rock, onto an
/// island or off the map are excluded, too, unless this excludes every move.
/// @param features of the ship, a row of StepResults::features
/// @tparam Options a type with the members mask_illegal and mask_blocked, such as DeepOptions
template <typename Options>
ActionMask LegalMask(ActionMask legal, const float* features, const Options& options) {
  const ActionMask allowed = LegalMask(legal, options.mask_illegal);
  if (!options.mask_blocked) return allowed;
  auto open = allowed;
  for (int move = 0; move < kMoveCount; ++move) {
    if (features[kFirstBlockedFeature + move] == 0.0F) continue;
    open = static_cast<ActionMask>(open & ~(1U << static_cast<unsigned>(move)));
  }
  return (open & kMoveMask) != 0 ? open : allowed;
}

}  // namespace aquafarm::agents
