// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The parameters of DQN and LSTM-DQN, their optimizer and the schedule of its updates.

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

/// Returns the parameters with which agents act, from the checkpoint of a learner or of a policy.
/// @throws InputError if the checkpoint contains no such parameters
std::vector<float> ActingWeights(const Checkpoint& checkpoint);

/// Origin of a minibatch in the random stream from which it was drawn. It makes a minibatch that
/// caused a non-finite loss reproducible.
struct BatchOrigin {
  std::uint64_t seed{};      ///< seed of the learner's random stream
  std::uint64_t position{};  ///< position in the stream before the first draw
};

/// Optimizes the online network and updates the target network and the moving average of the
/// weights.
class ValueOptimizer {
 public:
  /// All modules must have the same architecture. The parameters of `online` are copied to `target`
  /// and `acting`.
  /// @param acting module for the moving average of the weights; unused if options.ema_rate is 0
  ValueOptimizer(const DeepOptions& options, torch::nn::Module& online, torch::nn::Module& target,
                 torch::nn::Module& acting, torch::Device device);

  /// Counts farm steps, which determine the number of due updates. Sets the learning rate.
  /// @param progress of the run, [0, 1]
  void Count(std::uint64_t farm_steps, double progress);
  /// Consumes one due update. @returns false if no update is due
  bool TakeDue();

  /// Computes the loss, a weighted sum over predictions, and its derivatives.
  /// @param predicted, targets, weights [count]
  /// @param slopes receives d loss / d predicted [count]; may be `predicted` or `targets`
  /// @throws LearnerFailed if the loss is not finite
  void Differentiate(std::size_t count, const float* predicted, const float* targets,
                     const float* weights, float* slopes, const BatchOrigin& origin);
  /// Takes one step of Adam against the gradient of online(). Then updates the moving average of
  /// the weights and, if it is due, the target network.
  /// @throws LearnerFailed if the gradient is not finite; the parameters are then unchanged
  void Learn(const BatchOrigin& origin);

  /// Returns the statistics of the learner. For every loss function, the reported loss is a moving
  /// average of the weighted mean squared TD error of unscaled rewards (Fig. 12 of the paper).
  LearnerStatus status(double exploration) const;
  /// Returns the parameters with which agents act: the online parameters, or their moving average.
  const FlatParameters& acting() const { return average_ ? *average_ : online_.parameters(); }
  FlatParameters& online() { return online_.parameters(); }
  FlatParameters& target() { return target_; }
  /// Returns the moving average of the parameters; null if ema_rate is 0.
  FlatParameters* average() { return average_ ? &*average_ : nullptr; }
  std::uint64_t updates() const { return updates_; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or do not fit
  void Load(const Checkpoint& checkpoint);

 private:
  template <typename Self, typename Visit>
  static void VisitNumbers(Self& self, const Visit& visit);  // see saved_numbers.h
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
