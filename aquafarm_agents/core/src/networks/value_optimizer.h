// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What DQN and LSTM-DQN share: their networks, the optimiser, and when to update.

#include <torch/torch.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/learner.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "networks/flat_adam.h"
#include "networks/networks.h"

namespace aquafarm::agents {

/// Parameters to act by in a learner's own checkpoint, or in that of its policy alone.
std::vector<float> ActingWeights(const Checkpoint& checkpoint);

/// Where a minibatch came from, so that a bad one can be drawn again.
struct BatchOrigin {
  std::uint64_t seed{};      ///< of the learner's stream of chance
  std::uint64_t position{};  ///< in it before the first draw
};

class ValueOptimizer {
 public:
  /// All modules have the same parameters; the others begin as copies of `online`.
  /// @param acting a module of its own when options.average_rate is set, else unused
  ValueOptimizer(const DeepOptions& options, torch::nn::Module& online, torch::nn::Module& target,
                 torch::nn::Module& acting, torch::Device device);

  /// Farm steps were taken; sets the learning rate.
  void Count(std::uint64_t farm_steps, double progress);
  /// Takes one update from what is due. @returns false when none is
  bool TakeDue();

  /// Mean loss of predictions [n] against targets [n], weighted [n] (summing to what `weights`
  /// sums to), then one step of Adam, then the target follows.
  /// @throws LearnerFailed when the loss or its gradient is not finite; the weights are then as
  /// they were
  void Update(const torch::Tensor& predicted, const torch::Tensor& targets,
              const torch::Tensor& weights, const BatchOrigin& origin);

  /// Its loss is the mean square error, weighted as the updates are, in squared units of reward,
  /// whatever loss is minimised and however rewards are scaled (Fig. 12).
  LearnerStatus status(double exploration) const;
  /// What agents act by: the parameters learnt, or their running average.
  const FlatParameters& acting() const { return average_ ? *average_ : online(); }
  std::uint64_t updates() const { return updates_; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError
  void Load(const Checkpoint& checkpoint);

 private:
  const FlatParameters& online() const { return online_.parameters(); }
  [[noreturn]] void Fail(const std::string& what, const BatchOrigin& origin) const;
  void Measure(const torch::Tensor& predicted, const torch::Tensor& targets,
               const torch::Tensor& weights);

  const DeepOptions options_;
  FlatAdam online_;
  FlatParameters target_;
  std::optional<FlatParameters> average_;
  double learning_rate_{};
  std::uint64_t steps_{};
  double due_{};
  std::uint64_t updates_{};
  float loss_;
};

}  // namespace aquafarm::agents
