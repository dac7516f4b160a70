// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The networks that curiosity.h describes, and their training.

#include <torch/torch.h>

#include <cstdint>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "networks/flat_adam.h"

namespace aquafarm::agents {

/// φ, the inverse model and the forward model, each with two layers.
class CuriosityNetwork final : public torch::nn::Module {
 public:
  /// @param features F, length of an observation
  explicit CuriosityNetwork(std::int64_t features);

  /// Errors of the two models.
  struct Output {
    torch::Tensor error;    ///< [B] e = ½ ‖φ̂(s') − φ(s')‖² of the forward model
    torch::Tensor inverse;  ///< scalar: mean cross-entropy of the inverse model, L_inverse
  };
  /// Evaluates both models on B transitions.
  /// @param from, to [B, F] observations before and after the transition
  /// @param actions [B] int64
  Output Forward(const torch::Tensor& from, const torch::Tensor& to, const torch::Tensor& actions);

 private:
  torch::nn::Sequential phi_{nullptr};
  torch::nn::Sequential inverse_{nullptr};
  torch::nn::Sequential forward_{nullptr};
};

/// Trains a CuriosityNetwork on transitions and returns its prediction errors.
class CuriosityModule {
 public:
  CuriosityModule(std::int64_t features, std::uint64_t seed);

  /// Computes the errors of B transitions, then makes an update if at least 64 transitions have
  /// been added since the last update.
  /// @param from, to [B, F] observations before and after the transition, row-major
  /// @param actions [B]
  /// @param farm_steps farm steps so far, for the message of LearnerFailed
  /// @param errors receives e of each transition [B], before the update
  /// @throws LearnerFailed if the loss or the gradient is not finite
  void Step(std::vector<float>& from, std::vector<float>& to, std::vector<std::int64_t>& actions,
            std::uint64_t farm_steps, std::vector<float>& errors);

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or do not fit
  void Load(const Checkpoint& checkpoint);

 private:
  void Learn(std::uint64_t farm_steps);

  const std::int64_t features_;
  const std::uint64_t seed_;
  std::shared_ptr<CuriosityNetwork> network_;
  FlatAdam adam_;
  std::vector<float> from_;  // transitions since the last update, [count, F]
  std::vector<float> to_;
  std::vector<std::int64_t> actions_;
};

}  // namespace aquafarm::agents
