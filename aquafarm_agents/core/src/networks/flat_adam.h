// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <torch/torch.h>

#include <string>

#include "aquafarm/agents/learning/checkpoint.h"
#include "networks/networks.h"

namespace aquafarm::agents {

/// Adam (Kingma and Ba 2015) on all parameters of a module as one tensor. It can be saved and
/// loaded at any time, also before its first step.
class FlatAdam {
 public:
  /// Moves the module's parameters to the device.
  FlatAdam(torch::nn::Module& module, torch::Device device);

  /// Computes the gradient of `loss` and takes one optimizer step with it. max_grad_norm and the
  /// result are as in the function below.
  [[nodiscard]] bool Step(const torch::Tensor& loss, double learning_rate, double max_grad_norm);
  /// Takes one optimizer step with the current gradient of the parameters.
  /// @param max_grad_norm a gradient with a larger norm is scaled down to it; 0: no limit
  /// @returns false if the gradient is not finite; the parameters are then unchanged
  [[nodiscard]] bool Step(double learning_rate, double max_grad_norm);

  FlatParameters& parameters() { return parameters_; }
  const FlatParameters& parameters() const { return parameters_; }

  /// Adds sections `<prefix>weights`, `<prefix>adam.mean`, `<prefix>adam.square`, `<prefix>adam`.
  void Save(Checkpoint& checkpoint, const std::string& prefix = "") const;
  /// @throws InputError if sections are missing or do not fit; the state is then unchanged
  void Load(const Checkpoint& checkpoint, const std::string& prefix = "");

 private:
  torch::optim::AdamParamState& MakeState();

  FlatParameters parameters_;
  torch::optim::Adam adam_;
  torch::optim::AdamParamState& state_;
};

}  // namespace aquafarm::agents
