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

/// Makes the network for the features of `spec`: TokenActorCritic for tokens, CentralActorCritic
/// for PpoOptions::central, else LstmActorCritic or FeedForward.
/// @param seed of the initial weights: uniform in ±1/√fan_in, and ±0.01/√fan_in for the logits
/// @throws InputError for a recurrent or central network of tokens
std::unique_ptr<ActorCritic> MakeActorCritic(const EnvironmentSpec& spec, const PpoOptions& options,
                                             std::uint64_t seed);
/// Makes LstmActorCritic or FeedForward.
std::unique_ptr<ActorCritic> MakeActorCritic(std::size_t features, std::size_t hidden,
                                             bool recurrent, const WeightOrigin& origin);
/// Makes CentralActorCritic. @param features of one agent @param agents of one farm
std::unique_ptr<ActorCritic> MakeCentralActorCritic(std::size_t features, std::size_t agents,
                                                    std::size_t hidden, bool recurrent,
                                                    std::uint64_t seed);

}  // namespace aquafarm::agents
