// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Independent learners (Fig. 6; Tan 1993): each agent learns for itself with a learner of its own,
/// as if the others were part of the sea.

#include <functional>
#include <memory>
#include <string>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Makes the learner of one agent. @param spec of farms with that agent alone
using MakeAgentLearner =
    std::function<std::unique_ptr<Learner>(const EnvironmentSpec& spec, std::uint64_t seed)>;

/// One learner for each agent of a farm, each with chance of its own. @throws InputError of `make`
std::unique_ptr<Learner> MakeIndependent(const EnvironmentSpec& spec, std::uint64_t seed,
                                         const MakeAgentLearner& make);

using MakeAgentPolicy =
    std::function<std::unique_ptr<Policy>(const Checkpoint&, const EnvironmentSpec&)>;

/// Plays what each of them learnt.
/// @throws InputError when the policy does not fit farms of `spec`, with the reason
std::unique_ptr<Policy> MakeIndependentPolicy(const Checkpoint& checkpoint,
                                              const EnvironmentSpec& spec,
                                              const MakeAgentPolicy& make);

}  // namespace aquafarm::agents
