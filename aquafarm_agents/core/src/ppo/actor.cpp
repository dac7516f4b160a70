// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/actor.h"

#include "networks/farm_rows.h"
#include "ppo/central_actor_critic.h"

namespace aquafarm::agents {
namespace {

constexpr ActionMask kDoneMask = 1;  // mask of an inactive agent, whose actions are ignored

}  // namespace

Actor::Actor(const EnvironmentSpec& spec, const PpoOptions& options, std::size_t state_size)
    : options_(options),
      agents_(static_cast<std::size_t>(spec.agents)),
      features_(static_cast<std::size_t>(spec.feature_count)),
      state_size_(state_size) {
  Begin(static_cast<std::size_t>(spec.farms));
}

void Actor::Begin(std::size_t farms) {
  const std::size_t slots = farms * agents_;
  masks_.assign(slots, kAllActions);
  values_.assign(slots, 0.0F);
  is_first_.assign(slots, 0);
  state_.assign(slots * state_size_, 0.0F);
  state_before_ = state_;
}

void Actor::Observe(ActorCritic& network, const StepResults& results) {
  const float* seen = results.features.data();
  for (std::size_t i = 0; i < slots(); ++i, seen += features_) {
    masks_[i] = results.active[i] == 0 ? kDoneMask : LegalMask(results.legal[i], seen, options_);
    is_first_[i] = results.is_first[i / agents_];
  }
  state_before_ = state_;
  SequenceRows rows;
  rows.sequences = slots();
  rows.features = results.features.data();
  rows.state = state_before_.data();
  rows.is_first = is_first_.data();
  if (network.joint_agents() > 0) Join(network.joint_agents(), results.features);
  rows.joint = joint_.data();
  const float* const outputs =
      symmetries_.empty() ? network.Forward(rows, state_size_ == 0 ? nullptr : state_.data())
                          : MeanOutputs(network, rows);
  distribution_.Compute(outputs, masks_.data(), slots());
  for (std::size_t i = 0; i < slots(); ++i) {
    values_[i] = outputs[i * kActorCriticOutputs + kActionCount];
  }
}

const float* Actor::MeanOutputs(ActorCritic& network, SequenceRows rows) {
  constexpr float kShare = 1.0F / static_cast<float>(kSymmetries);
  const float* const plain = rows.features;
  turned_.resize(slots() * features_);
  mean_outputs_.assign(slots() * kActorCriticOutputs, 0.0F);
  rows.features = turned_.data();
  for (const TokenSymmetry& symmetry : symmetries_) {
    for (std::size_t i = 0; i < slots(); ++i) {
      symmetry.Turn(plain + i * features_, turned_.data() + i * features_);
    }
    const float* outputs = network.Forward(rows, nullptr);
    for (std::size_t i = 0; i < slots(); ++i, outputs += kActorCriticOutputs) {
      float* const mean = mean_outputs_.data() + i * kActorCriticOutputs;
      for (std::uint8_t a = 0; a < kActionCount; ++a) mean[a] += kShare * outputs[symmetry.Turn(a)];
      mean[kActionCount] += kShare * outputs[kActionCount];
    }
  }
  return mean_outputs_.data();
}

void Actor::Join(std::size_t joint_agents, const std::vector<float>& features) {
  const std::size_t size = joint_agents * features_;
  joint_.resize(slots() * size);
  for (std::size_t i = 0; i < slots(); ++i) {
    const std::size_t agent = i % agents_;
    JoinObservations(features.data() + (i - agent) * features_, agents_, features_, agent,
                     joint_.data() + i * size);
  }
}

void Actor::Sample(AgentRng& rng, std::vector<std::uint8_t>& actions) const {
  actions.resize(slots());
  for (std::size_t i = 0; i < slots(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    float left = rng[i].Unit();
    for (std::uint8_t a = 0; a < kActionCount; ++a) {
      const float prob = distribution_.probs(row, a);
      if (prob <= 0.0F) continue;
      // If rounding makes the sum of all probabilities less than the draw, the last action remains.
      actions[i] = a;
      left -= prob;
      if (left < 0.0F) break;
    }
  }
}

void Actor::TakeBest(std::vector<std::uint8_t>& actions) const {
  actions.resize(slots());
  for (std::size_t i = 0; i < slots(); ++i) {
    Eigen::Index best = 0;
    distribution_.probs.row(static_cast<Eigen::Index>(i)).maxCoeff(&best);
    actions[i] = static_cast<std::uint8_t>(best);
  }
}

}  // namespace aquafarm::agents
