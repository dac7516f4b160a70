// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Proximal policy optimization (PPO, Schulman et al. 2017): an actor-critic network learns from
/// the steps of its own current policy.
///
///   collect T steps in all farms with π_old
///   δ_t = r_t + γ V(s_{t+1}) − V(s_t),   A_t = Σ_l (γλ)^l δ_{t+l}        (GAE, Schulman 2016)
///   ρ_t = π(a_t | s_t) / π_old(a_t | s_t)
///   minimize  −min(ρ_t A_t, clip(ρ_t, 1 − ε, 1 + ε) A_t) + c_v (V(s_t) − V_target)² / 2 − c_e H(π)
///   V_target = A_t + V(s_t) at the time of collection
///
/// Only termination stops bootstrapping. A truncated episode is bootstrapped with the value of its
/// last observation. Masked actions have probability 0 in π and π_old.
///
/// MAPPO (Yu et al. 2022, arXiv:2103.01955) is PPO for several agents. One policy chooses the
/// actions of every agent from the agent's own observation. V depends on the observations of all
/// agents of the farm. V is needed only for learning, so a trained ship needs only its own
/// observation.
///
/// With the option `teacher`, the policy also imitates a teacher (kickstarting).

#include <memory>
#include <string>

#include "aquafarm/agents/learning/sharded_learner.h"
#include "aquafarm/agents/ranks/process_group.h"

namespace aquafarm::agents {

/// Returns the observation types (ObservationTypeBits) that the learner reads.
/// @throws InputError if an option is wrong
std::uint8_t PpoObservationTypes(const std::string& options);
std::uint8_t MappoObservationTypes(const std::string& options);
/// Function that makes the policy that the learner imitates with teacher_policy=planner.
using PlannerMaker = std::unique_ptr<Policy> (*)(const EnvironmentSpec&);
/// Makes an untrained learner.
/// @param make_planner may be null unless the options set teacher_policy=planner and a weight
///   `teacher` above 0
/// @throws InputError if an option is wrong, if the options do not fit the features of `spec`, if
///   the number of farms is not a multiple of the number of shards, or if the planner does not
///   support the farms
std::unique_ptr<Learner> MakePpo(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& options, PlannerMaker make_planner = nullptr);
std::unique_ptr<Learner> MakeMappo(const EnvironmentSpec& spec, std::uint64_t seed,
                                   const std::string& options, PlannerMaker make_planner = nullptr);
/// Makes the learner of one rank of a process group.
/// @param spec spec of the farms of this rank
/// @param group must outlive the learner
/// @throws InputError in the cases listed for MakePpo, if the number of shards is not a multiple of
///   the number of ranks, or if the exploration contains icm
std::unique_ptr<ShardedLearner> MakePpoOfRanks(const EnvironmentSpec& spec, std::uint64_t seed,
                                               const std::string& options, ProcessGroup& group,
                                               PlannerMaker make_planner = nullptr);
std::unique_ptr<ShardedLearner> MakeMappoOfRanks(const EnvironmentSpec& spec, std::uint64_t seed,
                                                 const std::string& options, ProcessGroup& group,
                                                 PlannerMaker make_planner = nullptr);
/// Makes the policy of a checkpoint of PPO or MAPPO.
/// @throws InputError if the policy does not fit farms of `spec`, or if the checkpoint is damaged
std::unique_ptr<Policy> MakePpoPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
