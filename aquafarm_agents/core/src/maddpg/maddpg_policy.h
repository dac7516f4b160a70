// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The policy of MADDPG, which uses only the actors.

#include <torch/torch.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"
#include "maddpg/maddpg_networks.h"
#include "maddpg/maddpg_options.h"

namespace aquafarm::agents {

/// Zeroes the recurrent state of each farm that begins an episode.
/// @param size_of_farm number of values per farm
/// @param recurrent_state [farms, size_of_farm]; empty if the actors are not recurrent
void ClearStarted(const StepResults& results, std::size_t size_of_farm,
                  std::vector<float>& recurrent_state);

/// Evaluates all actors for one step.
/// @param recurrent_state [slots, recurrent_size] before the step; receives the state after the
///   step; empty if the actors are not recurrent
/// @returns logits [slots, kActionCount], on the CPU
torch::Tensor StepActors(ActorTeam& actors, const StepResults& results, const EnvironmentSpec& spec,
                         std::vector<float>& recurrent_state, torch::Device device);

/// Makes a policy that chooses the most likely allowed action of each agent.
/// @throws InputError if the weights belong to another network
std::unique_ptr<Policy> MakeActorsPolicy(const EnvironmentSpec& spec, const MaddpgOptions& options,
                                         const std::vector<float>& weights);

}  // namespace aquafarm::agents
