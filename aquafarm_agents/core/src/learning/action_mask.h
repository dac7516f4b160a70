// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Which actions a learner or policy chooses among.

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

/// Mask of the allowed actions: all actions, or the legal ones.
inline ActionMask LegalMask(ActionMask legal, bool mask_illegal) {
  return mask_illegal ? static_cast<ActionMask>(legal & kAllActions) : kAllActions;
}

/// Mask of the allowed actions. With mask_blocked it also excludes moves that do not lead into open
/// water, unless no move does.
/// @param features of the ship, a row of Results::features
/// @tparam Options DeepOptions, MaddpgOptions or another type with both switches
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
