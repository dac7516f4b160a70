// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Parts shared by DQN and LSTM-DQN: the networks, the optimizer and the update schedule.

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

/// Parameters of the acting network, from the checkpoint of a learner or of a policy.
std::vector<float> ActingWeights(const Checkpoint& checkpoint);

/// Origin of a minibatch in the random stream, so that a faulty one can be reproduced.
struct BatchOrigin {
  std::uint64_t seed{};      ///< seed of the learner's random stream
  std::uint64_t position{};  ///< position in the stream before the first draw
};

class ValueOptimizer {
 public:
  /// All modules have the same architecture. `target` and `acting` start as copies of `online`.
  /// @param acting a separate module if options.ema_rate is set, else unused
  ValueOptimizer(const DeepOptions& options, torch::nn::Module& online, torch::nn::Module& target,
                 torch::nn::Module& acting, torch::Device device);

  /// Counts farm steps and sets the learning rate.
  void Count(std::uint64_t farm_steps, double progress);
  /// Consumes one due update. @returns false if no update is due
  bool TakeDue();

  /// Computes the weighted sum of the losses of n predictions. @param slopes receives d loss /
  /// d prediction [n]; may be `predicted` or `targets`
  /// @throws LearnerFailed if the loss is not finite
  void Differentiate(std::size_t count, const float* predicted, const float* targets,
                     const float* weights, float* slopes, const BatchOrigin& origin);
  /// Takes one step of Adam against the gradient of online(), and updates the target network.
  /// @throws LearnerFailed if the gradient is not finite; the parameters are then unchanged
  void Learn(const BatchOrigin& origin);

  /// Statistics of the learner. The loss is the mean squared TD error with the weights of the
  /// updates, in squared units of the unscaled reward, for every loss function (Fig. 12).
  LearnerStatus status(double exploration) const;
  /// Parameters by which agents act: the online parameters, or their moving average.
  const FlatParameters& acting() const { return average_ ? *average_ : online_.parameters(); }
  FlatParameters& online() { return online_.parameters(); }
  FlatParameters& target() { return target_; }
  FlatParameters* average() { return average_ ? &*average_ : nullptr; }  ///< null without
  std::uint64_t updates() const { return updates_; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError
  void Load(const Checkpoint& checkpoint);

 private:
  template <typename Self, typename Visit>
  static void VisitNumbers(Self& self, const Visit& visit);  // the saved numbers, by name
  [[noreturn]] void Fail(const std::string& what, const BatchOrigin& origin) const;
  void Measure(double mean_square);

  const DeepOptions options_;
  FlatAdam online_;
  FlatParameters target_;
  std::optional<FlatParameters> average_;
  double learning_rate_{};
  std::uint64_t steps_{};
  double due_{};
  std::uint64_t updates_{};
  double evaluated_{};  // the loss of the last Differentiate
  float loss_;
};

}  // namespace aquafarm::agents
