// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Helpers of learners on features or planes that need no network library: counts, masks for
/// planes, and the check of a saved network against the farms of a run.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/grid/action.h"
#include "learning/action_mask.h"

namespace aquafarm::agents {

/// Mask of the allowed actions for planes. DeepOptions rejects mask_blocked with planes, which lack
/// the required features.
inline ActionMask LegalMask(ActionMask legal, const std::uint8_t*, const DeepOptions& options) {
  return LegalMask(legal, options.mask_illegal);
}

/// Number of farms that took a step; the others began an episode.
inline std::uint64_t FarmSteps(const StepResults& results) {
  return static_cast<std::uint64_t>(
      std::count(results.is_first.begin(), results.is_first.end(), std::uint8_t{0}));
}

/// Checks that a policy fits farms of `spec`.
/// @throws InputError "policy: dqn of scenario paper does not fit scenario x: features: …"
void CheckFits(const Checkpoint& checkpoint, const EnvironmentSpec& spec, NetworkKind network);

/// Checks that a network that plays each agent by its own features fits farms of `spec`, which may
/// have another number of agents.
/// @throws InputError as CheckFits
void CheckFeaturesFit(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
