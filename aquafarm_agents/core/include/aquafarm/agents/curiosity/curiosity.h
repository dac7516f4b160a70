// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Exploration by curiosity (Fig. 7 of the paper): the Intrinsic Curiosity Module of Pathak et al.
/// 2017. It adds an intrinsic reward to the rewards of any learner. The intrinsic reward is high
/// for steps whose outcome is poorly predicted. The network φ encodes the features of a state. It
/// is trained so that it encodes only what actions influence:
///
///   s  ── φ ──┬──────────────┬── inverse model ──> the action that led from s to s'; trains φ
///   s' ── φ ──┼──────────────┘
///             └── forward model (with a) ──> φ̂(s'); the error e = ½ ‖φ̂(s') − φ(s')‖² is rewarded
///
/// The loss is (1 − β) L_inverse + β e with β = 0.2. Only L_inverse trains φ. In Pathak et al., e
/// also trains φ, which shrinks features that are hard to predict.
///
/// The learner receives r + w · min(e / ē, 5), where ē is a moving average of e. The weight w is
/// therefore approximately the mean intrinsic reward of a step, on any farm. (η of Pathak et al.
/// corresponds to w / ē. The division by ē follows Burda et al. 2019.)

#include <cstdint>
#include <memory>

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Returns a learner that passes the results to `learner` with the intrinsic reward added. The
/// returned learner requires features in addition to the observation types of `learner`.
/// @param exploration options with is_curious() true; `curiosity` is the schedule of w
std::unique_ptr<Learner> WithCuriosity(std::unique_ptr<Learner> learner,
                                       const EnvironmentSpec& spec, std::uint64_t seed,
                                       const ExplorationOptions& exploration);

}  // namespace aquafarm::agents
