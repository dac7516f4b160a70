// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// DQN (Mnih et al. 2015; §3.4.3, Eq. 15): a network for Q(s, ·), learnt from a replay against a
/// target network that follows it,
///
///   y = r + γ max over a' of Q_target(s', a')        y = r after termination
///   loss = (y − Q(s, a))², or Huber's
///
/// and LSTM-DQN (Algorithm 2): the same with a memory, learnt from sequences that lie inside one
/// episode and begin with the state that was carried then, warmed up for burn_in steps. All farms
/// act in one forward pass. See DeepOptions for what can be switched on.

#include <memory>
#include <string>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// EncodingBits that a DQN of these options reads. @throws InputError when an option is wrong
std::uint8_t DqnEncodings(const std::string& options);
/// @throws InputError
std::unique_ptr<Learner> MakeDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& options);
/// Value decomposition (VDN, Sunehag et al. 2018): one network plays all agents and their values
/// add up to the team's, learnt from the sum of their rewards; a policy like any DQN's.
///
///   Q_team(s, a) = Σ over agents i of Q(o_i, a_i)
/// @throws InputError
std::unique_ptr<Learner> MakeVdn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& options);
/// @throws InputError when the policy does not fit farms of `spec`, with the reason
std::unique_ptr<Policy> MakeDqnPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

// The same of LSTM-DQN.
std::uint8_t RecurrentDqnEncodings(const std::string& options);
std::unique_ptr<Learner> MakeRecurrentDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                          const std::string& options);
std::unique_ptr<Policy> MakeRecurrentDqnPolicy(const Checkpoint& checkpoint,
                                               const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
