// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/ppo_policy.h"

#include <string>

#include "aquafarm/base/check.h"
#include "networks/farm_rows.h"
#include "ppo/make_actor_critic.h"

namespace aquafarm::agents {
namespace {

// A policy of MAPPO consists of the network for the logits.
PpoOptions WithoutCritic(PpoOptions options) {
  options.central = false;
  return options;
}

}  // namespace

PpoPolicy::PpoPolicy(const EnvironmentSpec& spec, const PpoOptions& options,
                     const std::vector<float>& weights)
    : options_(options),
      network_(MakeActorCritic(spec, WithoutCritic(options), 0)),
      actor_(spec, options, network_->state_size()) {
  if (weights.size() != network_->weights().size()) {
    throw InputError("weights: got " + std::to_string(weights.size()) + " numbers, expected " +
                     std::to_string(network_->weights().size()) +
                     " for this network: damaged, use another checkpoint");
  }
  network_->weights() = weights;
}

void PpoPolicy::Begin(std::uint64_t seed, std::int32_t farms) {
  actor_.Begin(static_cast<std::size_t>(farms));
  rng_ = AgentRng(seed, actor_.entries());
}

void PpoPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  actor_.Observe(*network_, results);
  if (options_.policy == PolicyMode::kSampled) {
    actor_.Sample(rng_, actions);
  } else {
    actor_.TakeBest(actions);
  }
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (results.in_play[i] == 0) actions[i] = 0;
  }
  if (options_.central) return;
  values_.resize(actions.size());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const bool is_active = results.in_play[i] != 0;
    values_[i] = is_active ? actor_.values()[i] / static_cast<float>(options_.reward_scale) : 0.0F;
  }
}

std::unique_ptr<Policy> MakePpoPolicyWithoutTorch(const Checkpoint& checkpoint,
                                                  const EnvironmentSpec& spec) {
  std::string resolved;
  const bool central = checkpoint.algorithm == kMappo;
  const PpoOptions options = PpoOptions::Parse(checkpoint.options, resolved, central);
  CheckFits(checkpoint, spec, NetworkKind::kMlp);
  std::vector<float> weights;
  checkpoint.GetArray("weights", checkpoint.Section("weights").size() / sizeof(float), weights);
  if (central) {  // a checkpoint of a training also has the weights of the value
    const auto trained = MakeActorCritic(spec, options, 0);
    if (weights.size() == trained->weights().size()) weights.resize(trained->policy_size());
  }
  return std::make_unique<PpoPolicy>(spec, options, weights);
}

}  // namespace aquafarm::agents
