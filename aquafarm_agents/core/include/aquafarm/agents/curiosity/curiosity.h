// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Exploration by curiosity (Fig. 7): the Intrinsic Curiosity Module of Pathak et al. 2017, added
/// to any value-based learner. The intrinsic reward is high for steps with a poorly predicted
/// outcome, as far as actions can influence that outcome:
///
///   s  ── φ ──┬──────────────┬── inverse model ──> the action that led from s to s'; trains φ
///   s' ── φ ──┼──────────────┘
///             └── forward model (with a) ──> φ̂(s'); its error e = ½ ‖φ̂(s') − φ(s')‖² is rewarded
///
/// The loss is (1 − β) L_inverse + β e, β = 0.2. Only L_inverse trains φ. In Pathak et al. e trains
/// φ too, which shrinks the features that are hard to predict.
///
/// The learner receives r + w · min(e / ē, 5), where ē is a moving average of e. The weight w is
/// therefore the mean intrinsic reward of a step, in units of reward, on any farm. (η of Pathak et
/// al. combines w and 1 / ē; the division by ē follows Burda et al. 2019.)

#include <cstdint>
#include <memory>

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Wraps a learner with a curiosity module. The result reads features in addition to the
/// observation types of the learner.
/// @param exploration of the learner; is_curious() must be true
std::unique_ptr<Learner> WithCuriosity(std::unique_ptr<Learner> learner,
                                       const EnvironmentSpec& spec, std::uint64_t seed,
                                       const ExplorationOptions& exploration);

}  // namespace aquafarm::agents
