// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "ppo/actor_critic.h"

namespace aquafarm::agents {

/// @param seed of the initial weights: uniform in ±1/√fan_in, and ±0.01/√fan_in for the logits
std::unique_ptr<ActorCritic> MakeActorCritic(std::size_t features, std::size_t hidden,
                                             bool recurrent, std::uint64_t seed);

}  // namespace aquafarm::agents
