// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/ppo/ppo_options.h"
#include "ppo/actor_critic.h"
#include "ppo/weight_drawer.h"

namespace aquafarm::agents {

/// Makes the network for the features of `spec`: TokenActorCritic for entity tokens,
/// CentralActorCritic for PpoOptions::central, else LstmActorCritic or FeedForward.
/// @param seed of the initial weights (weight_drawer.h)
/// @throws InputError if the features are entity tokens and the network is recurrent or central, or
///   if the features are not entity tokens and an option needs them: the teacher's rule, augment,
///   symmetric or max_visits
std::unique_ptr<ActorCritic> MakeActorCritic(const EnvironmentSpec& spec, const PpoOptions& options,
                                             std::uint64_t seed);
/// Makes LstmActorCritic or FeedForward.
std::unique_ptr<ActorCritic> MakeActorCritic(std::size_t features, std::size_t hidden,
                                             bool recurrent, const WeightOrigin& origin);
/// Makes CentralActorCritic.
/// @param features number of features of one agent
/// @param agents number of agents of one farm
std::unique_ptr<ActorCritic> MakeCentralActorCritic(std::size_t features, std::size_t agents,
                                                    std::size_t hidden, bool recurrent,
                                                    std::uint64_t seed);

}  // namespace aquafarm::agents
