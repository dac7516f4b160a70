// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What learners on features or planes share without a network library: action masks, counts, and
/// the comparison of a saved network with the farms that it is to play on.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

inline std::size_t EntryCount(const EnvironmentSpec& spec) {
  return static_cast<std::size_t>(spec.farms) * static_cast<std::size_t>(spec.agents);
}

/// What learners may do now: all actions, or the legal ones.
inline ActionMask Allowed(ActionMask legal, bool mask_illegal) {
  return mask_illegal ? static_cast<ActionMask>(legal & kAllActions) : kAllActions;
}

/// The same, and where mask_blocked is set, of the moves only those into open water; all of them
/// for a ship that has none around it. @param features of the ship, a row of Results::features
/// @tparam Options DeepOptions, MaddpgOptions or PpoOptions
template <typename Options>
ActionMask Allowed(ActionMask legal, const float* features, const Options& options) {
  const ActionMask allowed = Allowed(legal, options.mask_illegal);
  if (!options.mask_blocked) return allowed;
  auto open = allowed;
  for (int move = 0; move < kMoveCount; ++move) {
    if (features[kFirstBlockedFeature + move] == 0.0F) continue;
    open = static_cast<ActionMask>(open & ~(1U << static_cast<unsigned>(move)));
  }
  return (open & kMoveMask) != 0 ? open : allowed;
}

/// Planes have no such features, and DeepOptions refuses mask_blocked with them.
inline ActionMask Allowed(ActionMask legal, const std::uint8_t*, const DeepOptions& options) {
  return Allowed(legal, options.mask_illegal);
}

/// Farms that took a step; the others began an episode.
inline std::uint64_t FarmSteps(const Results& results) {
  return static_cast<std::uint64_t>(
      std::count(results.started.begin(), results.started.end(), std::uint8_t{0}));
}

/// @throws InputError "policy: dqn of scenario paper does not fit scenario x: features: …"
void CheckFits(const Checkpoint& checkpoint, const EnvironmentSpec& spec, NetworkKind network);

}  // namespace aquafarm::agents
