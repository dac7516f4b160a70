// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// MADDPG (Lowe et al. 2017; §3.3) for discrete actions: each agent's actor sees what it sees, a
/// critic that is used in training alone sees all observations and actions.
///
///   o_i ─ actor i ─ logits ─ Gumbel-softmax ─ a_i       critic i (o_1 … o_S, a_others) → Q_i(a_i)
///
///   critic   y_i = r_i + γ Q_i'(o', a'), a' the others' target actors' likeliest and the best own
///            answer to them (best_response=false: the own target actor's); Huber loss
///   actor i  ascends Q_i(o, a) with its own a_i relaxed and the others' as they were taken, less
///            logit_penalty · mean logits²
///
/// A critic gives the value of each action of its agent at once, as in COMA (Foerster et al. 2018),
/// so it is linear in a_i and its slope at a relaxed action is exact. One network serves all
/// agents. Gumbel-softmax (Jang et al. 2017, Maddison et al. 2017) is straight-through: one-hot
/// forwards, its softmax at `temperature` backwards. It is an actor-critic method, though the paper
/// lists it among the value-based ones.

#include <memory>
#include <string>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// @throws InputError when an option is wrong
std::uint8_t MaddpgEncodings(const std::string& options);
/// @throws InputError
std::unique_ptr<Learner> MakeMaddpg(const EnvironmentSpec& spec, std::uint64_t seed,
                                    const std::string& options);
/// Every actor's likeliest action.
/// @throws InputError when the policy does not fit farms of `spec`, with the reason
std::unique_ptr<Policy> MakeMaddpgPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
