// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/ppo_policy.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "aquafarm/base/check.h"
#include "networks/farm_rows.h"
#include "ppo/make_actor_critic.h"

namespace aquafarm::agents {
namespace {

constexpr float kForbidden = -std::numeric_limits<float>::infinity();

// A saved policy of MAPPO contains only the network for the logits.
PpoOptions WithoutCritic(PpoOptions options) {
  options.central = false;
  return options;
}

}  // namespace

PpoPolicy::PpoPolicy(const EnvironmentSpec& spec, const PpoOptions& options,
                     const std::vector<float>& weights)
    : spec_(spec),
      options_(options),
      network_(MakeActorCritic(spec, WithoutCritic(options), 0)),
      actor_(spec, options, network_->state_size()),
      repetitions_(spec, options.repetition_penalty) {
  if (weights.size() != network_->weights().size()) {
    throw InputError("weights: got " + std::to_string(weights.size()) + " numbers, expected " +
                     std::to_string(network_->weights().size()) +
                     " for this network: damaged, use another checkpoint");
  }
  network_->weights() = weights;
  if (options.max_visits > 0) loops_.emplace(spec, actor_.slots(), options.max_visits);
  if (options.symmetric) actor_.AverageSymmetries(LayoutOfTokens(spec.feature_names));
}

void PpoPolicy::Begin(std::uint64_t seed, std::int32_t farms) {
  actor_.Begin(static_cast<std::size_t>(farms));
  rng_ = AgentRng(seed, actor_.slots());
  EnvironmentSpec played = spec_;
  played.farms = farms;
  repetitions_ = RepetitionPenalty(played, options_.repetition_penalty);
  if (options_.max_visits > 0) loops_.emplace(spec_, actor_.slots(), options_.max_visits);
}

void PpoPolicy::LeaveLoops(const StepResults& results, std::vector<std::uint8_t>& actions) {
  const auto features = static_cast<std::size_t>(spec_.feature_count);
  const auto agents = static_cast<std::size_t>(spec_.agents);
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const auto action = loops_->ActionOf(i, results.features.data() + i * features,
                                         results.is_first[i / agents] != 0, actor_.masks()[i]);
    if (action) actions[i] = *action;
  }
}

void PpoPolicy::TakeBest(const StepResults& results, std::vector<std::uint8_t>& actions) {
  if (options_.repetition_penalty == 0.0) return actor_.TakeBest(actions);
  const ActionDistribution& distribution = actor_.distribution();
  const auto features = static_cast<std::size_t>(spec_.feature_count);
  repetitions_.Begin(results);
  actions.resize(actor_.slots());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    std::array<float, kActionCount> logits{};
    for (std::uint8_t a = 0; a < kActionCount; ++a) {
      const bool is_allowed = (actor_.masks()[i] & MaskOf(static_cast<Action>(a))) != 0;
      logits[a] = is_allowed ? distribution.log_probs(static_cast<Eigen::Index>(i), a) : kForbidden;
    }
    const float* const seen = results.features.data() + i * features;
    const float* const penalized = repetitions_.Penalize(logits.data(), seen, i);
    actions[i] = static_cast<std::uint8_t>(std::max_element(penalized, penalized + kActionCount) -
                                           penalized);
    repetitions_.Add(actions[i], i);
  }
}

void PpoPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  actor_.Observe(*network_, results);
  if (options_.policy == PolicyMode::kSampled) {
    actor_.Sample(rng_, actions);
  } else {
    TakeBest(results, actions);
    if (loops_) LeaveLoops(results, actions);
  }
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (results.active[i] == 0) actions[i] = 0;
  }
  if (options_.central) return;
  values_.resize(actions.size());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const bool is_active = results.active[i] != 0;
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
  if (central) {  // a checkpoint of a training also contains the weights of the critic
    const auto trained = MakeActorCritic(spec, options, 0);
    if (weights.size() == trained->weights().size()) weights.resize(trained->policy_size());
  }
  return std::make_unique<PpoPolicy>(spec, options, weights);
}

}  // namespace aquafarm::agents
