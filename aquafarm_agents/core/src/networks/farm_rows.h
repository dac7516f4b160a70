// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Helpers of learners with networks: masks for planes, the count of farm steps, and checks that a
/// saved network fits the farms of a run. This header does not include libtorch.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/grid/action.h"
#include "learning/action_mask.h"

namespace aquafarm::agents {

/// Returns the allowed actions of an agent whose observation is planes. Planes do not contain the
/// features that mask_blocked requires, so DeepOptions rejects mask_blocked with planes.
inline ActionMask LegalMask(ActionMask legal, const std::uint8_t*, const DeepOptions& options) {
  return LegalMask(legal, options.mask_illegal);
}

/// Returns the number of farms that took a step. The other farms began an episode.
inline std::uint64_t FarmSteps(const StepResults& results) {
  return static_cast<std::uint64_t>(
      std::count(results.is_first.begin(), results.is_first.end(), std::uint8_t{0}));
}

/// Checks that the number of agents and the observations of a policy fit farms of `spec`.
/// @throws InputError "policy: dqn of scenario paper does not fit scenario x: features: …"
void CheckFits(const Checkpoint& checkpoint, const EnvironmentSpec& spec, NetworkKind network);

/// Checks that the features of a policy fit farms of `spec`. The number of agents may differ,
/// because a network that all agents share can be used for any number of agents.
/// @throws InputError in the same cases as CheckFits
void CheckFeaturesFit(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
