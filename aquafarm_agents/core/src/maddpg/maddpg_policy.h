// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The actors of MADDPG at play, without their critic.

#include <torch/torch.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"
#include "maddpg/maddpg_networks.h"
#include "maddpg/maddpg_options.h"

namespace aquafarm::agents {

/// Empties the memory of farms whose episodes begin. @param carry what each agent carries between
/// steps, on the host: [farms, size_of_farm], empty without memory
void ClearStarted(const Results& results, std::size_t size_of_farm, std::vector<float>& carry);

/// One step of all actors. @param carry as above; moved on
/// @returns logits [entries, kActionCount], on the CPU
torch::Tensor StepActors(ActorTeam& actors, const Results& results, const EnvironmentSpec& spec,
                         std::vector<float>& carry, torch::Device device);

/// Plays every actor's likeliest action. @throws InputError when the weights are another network's
std::unique_ptr<Policy> MakeActorsPolicy(const EnvironmentSpec& spec, const MaddpgOptions& options,
                                         const std::vector<float>& weights);

}  // namespace aquafarm::agents
