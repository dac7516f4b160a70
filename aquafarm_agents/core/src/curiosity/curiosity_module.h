// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The networks of curiosity.h and their training.

#include <torch/torch.h>

#include <cstdint>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "networks/flat_adam.h"

namespace aquafarm::agents {

/// φ, the inverse model and the forward model, each with two layers.
class CuriosityNetwork final : public torch::nn::Module {
 public:
  explicit CuriosityNetwork(std::int64_t features);

  struct Output {
    torch::Tensor error;    ///< [B] ½ ‖φ̂(s') − φ(s')‖²
    torch::Tensor inverse;  ///< scalar, cross-entropy of the action taken
  };
  /// @param from, to [B, F] observations
  /// @param actions [B] int64
  Output Forward(const torch::Tensor& from, const torch::Tensor& to, const torch::Tensor& actions);

 private:
  torch::nn::Sequential phi_{nullptr};
  torch::nn::Sequential inverse_{nullptr};
  torch::nn::Sequential forward_{nullptr};
};

/// Learns to predict transitions and returns the prediction error of each.
class CuriosityModule {
 public:
  CuriosityModule(std::int64_t features, std::uint64_t seed);

  /// @param from, to [B, F], row-major
  /// @param actions [B]
  /// @param farm_steps so far; part of the failure message
  /// @param errors [B] error of each transition, before learning from them
  /// @throws LearnerFailed if the loss or gradient is not finite
  void Step(std::vector<float>& from, std::vector<float>& to, std::vector<std::int64_t>& actions,
            std::uint64_t farm_steps, std::vector<float>& errors);

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError
  void Load(const Checkpoint& checkpoint);

 private:
  void Learn(std::uint64_t farm_steps);

  const std::int64_t features_;
  const std::uint64_t seed_;
  std::shared_ptr<CuriosityNetwork> network_;
  FlatAdam adam_;
  std::vector<float> from_;  // transitions waiting for the next update
  std::vector<float> to_;
  std::vector<std::int64_t> actions_;
};

}  // namespace aquafarm::agents
