// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Exploration by curiosity (Fig. 7): the Intrinsic Curiosity Module of Pathak et al. 2017, beside
/// any learner of values. It pays for steps whose outcome it could not foresee, in what an action
/// can change at all:
///
///   s  ── φ ──┬──────────────┬── inverse model ──> which action led from s to s'?  teaches φ
///   s' ── φ ──┼──────────────┘
///             └── forward model (with a) ──> φ(s')?   its error e = ½ ‖φ̂(s') − φ(s')‖² pays
///
/// They learn by (1 − β) L_inverse + β e, β = 0.2, but φ by the inverse model alone: in Pathak et
/// al. e reaches φ too, which flattens what is hard to foresee.
///
/// The learner is given r + w · min(e / ē, 5), where ē is the mean error of late: w is so the mean
/// pay of a step in units of reward, on any farm (Pathak's η stands for both; the division is that
/// of Burda et al. 2019).

#include <cstdint>
#include <memory>

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// The learner with curiosity beside it. It reads features besides what the learner reads.
/// @param exploration of the learner, which is_curious()
std::unique_ptr<Learner> WithCuriosity(std::unique_ptr<Learner> learner,
                                       const EnvironmentSpec& spec, std::uint64_t seed,
                                       const ExplorationOptions& exploration);

}  // namespace aquafarm::agents
