// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// DQN (Mnih et al. 2015; paper §3.4.3, Eq. 15, see docs/model.md) trains a network for Q(s, ·)
/// from a replay buffer, with a target network:
///
///   y = r + γ max over a' of Q_target(s', a')        y = r after termination
///   loss = (y − Q(s, a))², or the Huber loss
///
/// By default, the online network chooses a' (option double_dqn) among the legal actions (option
/// mask_illegal).
///
/// LSTM-DQN (Algorithm 2) is DQN with a recurrent network. It is trained on sequences of steps of
/// one episode. The network first reads the steps directly before a sequence; their number is the
/// option burn_in. It starts with the recurrent state that was stored at the first of these steps.
/// If they include the first step of the episode, or are not all stored, there is no burn-in, and
/// the sequence begins earlier, at the first stored step of the episode.
///
/// One forward pass computes the actions of all farms. DeepOptions lists the options.

#include <memory>
#include <string>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Returns the ObservationTypeBits that a DQN with these options requires.
/// @throws InputError if an option is wrong
std::uint8_t DqnObservationTypes(const std::string& options);
/// Returns a new DQN learner.
/// @throws InputError if an option is wrong
std::unique_ptr<Learner> MakeDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& options);
/// Returns a learner with value decomposition (VDN, Sunehag et al. 2018): one network computes the
/// values of each agent, and their sum is the value of the team. It is trained with the reward of
/// the team: the sum of the agents' rewards or, if each agent already receives the team's reward,
/// that reward once. The policy is a DQN policy.
///
///   Q_team(s, a) = Σ over agents i of Q(o_i, a_i)
///
/// @throws InputError if an option is wrong
std::unique_ptr<Learner> MakeVdn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& options);
/// Returns the greedy policy of a checkpoint of DQN or VDN.
/// @throws InputError with the reason if the policy does not fit farms of `spec`
std::unique_ptr<Policy> MakeDqnPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

/// Does the same as DqnObservationTypes, for LSTM-DQN.
std::uint8_t RecurrentDqnObservationTypes(const std::string& options);
/// Does the same as MakeDqn, for LSTM-DQN.
std::unique_ptr<Learner> MakeRecurrentDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                          const std::string& options);
/// Does the same as MakeDqnPolicy, for LSTM-DQN.
std::unique_ptr<Policy> MakeRecurrentDqnPolicy(const Checkpoint& checkpoint,
                                               const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
