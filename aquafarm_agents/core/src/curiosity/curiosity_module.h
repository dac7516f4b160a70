// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The models behind curiosity.h, and what they learn from.

#include <torch/torch.h>

#include <cstdint>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "networks/flat_adam.h"

namespace aquafarm::agents {

/// φ, inverse and forward model; two layers each.
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

/// Learns to foresee transitions and says how little it foresaw each.
class CuriosityModule {
 public:
  CuriosityModule(std::int64_t features, std::uint64_t seed);

  /// @param from, to [B, F], row-major
  /// @param actions [B]
  /// @param farm_steps until now, which a failure names
  /// @param errors [B] of each transition, before learning from them
  /// @throws LearnerFailed when its loss or gradient is not finite
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
  std::vector<float> from_;  // transitions not yet learnt from
  std::vector<float> to_;
  std::vector<std::int64_t> actions_;
};

}  // namespace aquafarm::agents
