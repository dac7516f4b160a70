// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Base class of DQN and LSTM-DQN: networks of action values, their optimizer, and the choice of
/// exploratory actions.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/networks/torch_runtime.h"
#include "networks/repetition_penalty.h"
#include "networks/replay_learner.h"
#include "networks/value_optimizer.h"

namespace aquafarm::agents {

/// @tparam Scalar type of an observation's values: float features, or bytes of planes
/// @tparam Network the network module, QNetwork or RecurrentNetwork
template <typename Scalar, typename Network>
class QLearner : public ReplayLearner<Scalar> {
 public:
  LearnerStatus status() const final { return optimizer_.status(this->explorer_.level()); }
  void SavePolicy(Checkpoint& checkpoint) const final {
    checkpoint.SetArray("weights", optimizer_.acting().ToVector());
  }

 protected:
  /// Sizes of observations and samples in the replay.
  struct Sample {
    std::size_t observation_size{};
    std::size_t recurrent_size{};  ///< of the recurrent state
    std::size_t steps{};           ///< number of later time steps that a sample needs
    std::size_t group{};           ///< number of agents of a sample; see ReplaySampler
  };

  /// @param make makes a network; its initial weights are drawn from `seed`
  QLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
           std::string resolved, const std::function<std::shared_ptr<Network>()>& make,
           const Sample& sample)
      : ReplayLearner<Scalar>(spec, seed, std::move(resolved), FindDevice(options.device),
                              {options.exploration,
                               options.reward_scale,
                               {static_cast<std::size_t>(options.buffer_size), SlotCount(spec),
                                spec.agents, sample.observation_size, sample.recurrent_size},
                               options,
                               sample.steps,
                               sample.group}),
        options_(options),
        observation_size_(sample.observation_size),
        online_(make()),
        target_(make()),
        average_(options.ema_rate > 0.0 ? make() : online_),
        optimizer_(options, *online_, *target_, *average_, this->device_),
        repetitions_(spec, options.repetition_penalty * options.reward_scale) {}

  /// Returns the action values from which the agents choose their actions, [slots, kActionCount].
  virtual const float* ActingValues(const StepResults& results) = 0;

  void CountSteps(std::uint64_t farm_steps) final { optimizer_.Count(farm_steps, this->progress_); }
  bool TakeDue() final { return optimizer_.TakeDue(); }
  void Choose(const StepResults& results, std::vector<std::uint8_t>& actions) final {
    repetitions_.Begin(results);
    const torch::NoGradGuard no_grad;
    const float* row = ActingValues(results);
    const Scalar* seen = ObservationTraits<Scalar>::Of(results);
    for (std::size_t i = 0; i < actions.size();
         ++i, row += kActionCount, seen += observation_size_) {
      const ActionMask allowed = LegalMask(results.legal[i], seen, options_);
      const float* const penalized = repetitions_.Penalize(row, seen, i);
      actions[i] = this->explorer_.Choose(penalized, allowed, BestOf(penalized, allowed), i);
      repetitions_.Add(actions[i], i);
    }
  }
  void SaveOwn(Checkpoint& checkpoint) const override {
    optimizer_.Save(checkpoint);
    repetitions_.Save(checkpoint);
    checkpoint.SetArray("chance", std::vector<std::uint64_t>{this->rng_.position()});
  }
  /// Sets value_slopes_ [count, kActionCount] to `slopes` [count] at the actions taken, and to 0 at
  /// all others.
  void SpreadSlopes(const std::vector<float>& slopes, const std::vector<std::uint8_t>& actions) {
    value_slopes_.assign(slopes.size() * kActionCount, 0.0F);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      value_slopes_[i * kActionCount + actions[i]] = slopes[i];
    }
  }
  void LoadOwn(const Checkpoint& checkpoint) override {
    std::vector<std::uint64_t> position;
    checkpoint.GetArray("chance", 1, position);
    optimizer_.Load(checkpoint);
    repetitions_.Load(checkpoint);
    this->rng_.Seek(position[0]);
  }

  const DeepOptions options_;
  const std::size_t observation_size_;
  std::shared_ptr<Network> online_;
  std::shared_ptr<Network> target_;
  std::shared_ptr<Network> average_;  // moving average of online_; online_ itself if ema_rate is 0
  ValueOptimizer optimizer_;
  std::vector<float> value_slopes_;  // d loss / d Q
  RepetitionPenalty repetitions_;
};

}  // namespace aquafarm::agents
