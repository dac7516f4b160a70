// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Action-value networks on libtorch (1.13 to 2.x). Include this header sparingly: torch.h is slow
/// to compile.

#include <torch/torch.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/networks/deep_options.h"

namespace aquafarm::agents {

/// Device of a name. @throws InputError if the name is cuda and there is no CUDA device
torch::Device FindDevice(const std::string& name);

/// Q(s, ·) from features: hidden - ReLU - hidden - ReLU - head.
/// The head is one layer, or V + A − mean A when dueling.
class HeadImpl : public torch::nn::Module {
 public:
  HeadImpl(std::int64_t inputs, bool dueling);
  torch::Tensor forward(const torch::Tensor& input);  ///< [..., inputs] → [..., kActionCount]
  const torch::nn::Linear& advantage() const { return advantage_; }
  const torch::nn::Linear& value() const { return value_; }  ///< empty unless dueling

 private:
  torch::nn::Linear advantage_{nullptr};
  torch::nn::Linear value_{nullptr};
};
TORCH_MODULE(Head);

class QNetwork : public torch::nn::Module {
 public:
  /// [B, F] or [B, P, H, W], floats → [B, kActionCount]
  virtual torch::Tensor Forward(const torch::Tensor& input) = 0;
};

/// Makes a network for farms of `spec`. Initial weights follow PyTorch's distribution, drawn from
/// (seed, kLearner).
std::shared_ptr<QNetwork> MakeNetwork(const EnvironmentSpec& spec, const DeepOptions& options,
                                      std::uint64_t seed);

/// An LSTM between two hidden layers. With the skip connection, which the paper does not have, it
/// learns several times as fast:
///
///   Linear - ReLU --+-- LSTM --+-- Linear - ReLU - head
///                   +----------+   skip connection
class RecurrentNetwork : public torch::nn::Module {
 public:
  RecurrentNetwork(std::int64_t features, std::int64_t hidden, bool dueling,
                   bool skip_connection = true);

  using State = std::pair<torch::Tensor, torch::Tensor>;  ///< h, c, each [1, B, hidden]
  /// @param input [T, B, F]
  /// @param state before the first step; receives the state after the last
  /// @returns [T, B, kActionCount]
  torch::Tensor Forward(const torch::Tensor& input, State& state);
  /// Advances only the state.
  void WarmUp(const torch::Tensor& input, State& state);
  std::int64_t hidden() const { return lstm_weights_[1].size(1); }

 private:
  torch::Tensor Step(const torch::Tensor& seen, State& state);

  bool skip_connection_;
  torch::nn::Linear input_{nullptr};
  torch::nn::LSTM lstm_{nullptr};
  std::vector<torch::Tensor> lstm_weights_;
  torch::nn::Linear second_{nullptr};
  Head head_{nullptr};
};

/// All parameters of a module, and their gradients, as one tensor. Optimizer steps, copies and file
/// access are then one operation each.
class FlatParameters {
 public:
  /// Moves the module's parameters to the device and into one tensor. The module continues to use
  /// them.
  FlatParameters(torch::nn::Module& module, torch::Device device);

  /// Leaf tensor with a gradient, [size].
  torch::Tensor& values() { return values_; }
  const torch::Tensor& values() const { return values_; }
  std::int64_t size() const { return values_.numel(); }

  std::vector<float> ToVector() const;
  /// @throws InputError unless `values` has size() values
  void FromVector(const std::vector<float>& values);
  /// Moves each parameter by `rate` of its distance towards those of a module of the same
  /// architecture; 1 copies them.
  void MoveTowards(const FlatParameters& other, double rate);

 private:
  torch::Tensor values_;
};

/// Draws initial weights as PyTorch does, uniform in ±1/√fan_in, but from (seed, kLearner). They
/// are the same with every version of the library.
void DrawWeights(torch::nn::Module& module, std::uint64_t seed, std::uint32_t stream);

}  // namespace aquafarm::agents
