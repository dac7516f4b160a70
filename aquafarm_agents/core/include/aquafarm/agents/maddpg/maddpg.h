// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// MADDPG (Lowe et al. 2017; paper §3.3, see docs/model.md) for discrete actions. The actor of an
/// agent reads the agent's observation. The critic is used only in training. It reads the
/// observations of all agents and the actions of the other agents.
///
///   o_i ─ actor i ─ logits ─ Gumbel-softmax ─ a_i       critic i (o_1 … o_S, a_others) → Q_i(a_i)
///
///   critic   minimizes the Huber loss of Q_i(o, a) against y_i = r_i + γ Q_i'(o', a'). The next
///            actions of the other agents are the most likely ones of their target actors. The next
///            action of agent i is the best response to these actions; with best_response=false,
///            it is the most likely one of its target actor
///   actor i  maximizes Q_i(o, a) − logit_penalty · mean logits², where a_i is relaxed and the
///            actions of the other agents are the replayed ones
///
/// The critic returns the values of all actions of its agent at once, as in COMA (Foerster et al.
/// 2018). Q_i is therefore linear in a_i, and its gradient at a relaxed action is exact. One
/// network is the critic of all agents. Gumbel-softmax (Jang et al. 2017, Maddison et al. 2017) is
/// straight-through: one-hot in the forward pass, softmax at `temperature` in the backward pass.
/// MADDPG is an actor-critic method, although the paper lists it among the value-based ones.

#include <memory>
#include <string>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Returns the ObservationTypeBits that MADDPG requires with these options.
/// @throws InputError on a wrong option
std::uint8_t MaddpgObservationTypes(const std::string& options);
/// Makes a MADDPG learner. @throws InputError on a wrong option
std::unique_ptr<Learner> MakeMaddpg(const EnvironmentSpec& spec, std::uint64_t seed,
                                    const std::string& options);
/// Makes a policy that takes the most likely allowed action of every actor.
/// @throws InputError with the reason if the policy does not fit farms of `spec`
std::unique_ptr<Policy> MakeMaddpgPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
