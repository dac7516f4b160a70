// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Independent learners (Fig. 6; Tan 1993): each agent has its own learner, which treats the other
/// agents as part of the environment.

#include <functional>
#include <memory>
#include <string>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Makes the learner of one agent. `spec` describes farms with a single agent.
using MakeAgentLearner =
    std::function<std::unique_ptr<Learner>(const EnvironmentSpec& spec, std::uint64_t seed)>;

/// Makes a learner that consists of one learner per agent of a farm, each with its own random
/// streams.
/// @throws InputError if `make` throws it
std::unique_ptr<Learner> MakeIndependent(const EnvironmentSpec& spec, std::uint64_t seed,
                                         const MakeAgentLearner& make);

/// Makes the policy of one agent from its part of a checkpoint.
using MakeAgentPolicy =
    std::function<std::unique_ptr<Policy>(const Checkpoint&, const EnvironmentSpec&)>;

/// Makes a policy that consists of one policy per agent, from a checkpoint of independent learners.
/// @throws InputError with the reason if the policy does not fit farms of `spec`
std::unique_ptr<Policy> MakeIndependentPolicy(const Checkpoint& checkpoint,
                                              const EnvironmentSpec& spec,
                                              const MakeAgentPolicy& make);

}  // namespace aquafarm::agents
