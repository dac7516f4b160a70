// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Policies that use the actors of MADDPG, without the critic.

#include <torch/torch.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"
#include "maddpg/maddpg_networks.h"
#include "maddpg/maddpg_options.h"

namespace aquafarm::agents {

/// Resets the recurrent state of farms whose episodes begin.
/// @param recurrent_state recurrent state of each agent between steps, on the host: [farms,
/// size_of_farm];
///        empty if the actors are not recurrent
void ClearStarted(const StepResults& results, std::size_t size_of_farm,
                  std::vector<float>& recurrent_state);

/// Runs all actors for one step. @param recurrent_state as above; advanced by one step
/// @returns logits [slots, kActionCount], on the CPU
torch::Tensor StepActors(ActorTeam& actors, const StepResults& results, const EnvironmentSpec& spec,
                         std::vector<float>& recurrent_state, torch::Device device);

/// Makes a policy that plays the most likely action of every actor.
/// @throws InputError if the weights belong to another network
std::unique_ptr<Policy> MakeActorsPolicy(const EnvironmentSpec& spec, const MaddpgOptions& options,
                                         const std::vector<float>& weights);

}  // namespace aquafarm::agents
