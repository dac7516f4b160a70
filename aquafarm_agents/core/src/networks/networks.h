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

/// Returns the device for an option value: cpu, cuda, or auto (CUDA if available, else the CPU).
/// @throws InputError if the value is cuda and there is no CUDA device
torch::Device FindDevice(const std::string& name);

/// Last layer of a network. Q is the output A of a linear layer. If dueling, Q = V + A − mean A
/// (Wang et al. 2016).
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

/// A network for Q(s, ·): hidden - ReLU - hidden - ReLU - head for features, or two convolutions
/// with ReLU and hidden - ReLU - head for planes.
class QNetwork : public torch::nn::Module {
 public:
  /// @param input [B, F] or [B, P, H, W], floats
  /// @returns Q [B, kActionCount]
  virtual torch::Tensor Forward(const torch::Tensor& input) = 0;
};

/// Makes a network for farms of `spec`. DrawWeights draws the initial weights from `seed`.
std::shared_ptr<QNetwork> MakeNetwork(const EnvironmentSpec& spec, const DeepOptions& options,
                                      std::uint64_t seed);

/// A network for Q with an LSTM between two hidden layers. The skip connection makes it learn
/// several times as fast. The paper (docs/model.md) does not have this connection.
///
///   Linear - ReLU --+-- LSTM --+-- Linear - ReLU - head
///                   +----------+   skip connection
class RecurrentNetwork : public torch::nn::Module {
 public:
  RecurrentNetwork(std::int64_t features, std::int64_t hidden, bool dueling,
                   bool skip_connection = true);

  using State = std::pair<torch::Tensor, torch::Tensor>;  ///< h, c, each [1, B, hidden]
  /// @param input [T, B, F]
  /// @param state recurrent state before the first step; receives the one after the last step
  /// @returns Q [T, B, kActionCount]
  torch::Tensor Forward(const torch::Tensor& input, State& state);
  /// Does the same as Forward, but computes only the state.
  void WarmUp(const torch::Tensor& input, State& state);
  /// Returns the number of units of the LSTM.
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

/// All parameters of a module as one tensor, with their gradients. An optimizer step, a copy or a
/// file access is then a single operation.
class FlatParameters {
 public:
  /// Moves the module's parameters to the device and into one tensor. The module continues to use
  /// them.
  FlatParameters(torch::nn::Module& module, torch::Device device);

  /// Returns the tensor of all parameters, [size], a leaf with a gradient.
  torch::Tensor& values() { return values_; }
  const torch::Tensor& values() const { return values_; }
  std::int64_t size() const { return values_.numel(); }

  std::vector<float> ToVector() const;
  /// @throws InputError unless `values` has size() values
  void FromVector(const std::vector<float>& values);
  /// Moves each parameter towards that of `other` by `rate` times their difference. A rate of 1
  /// copies the parameters.
  /// @param other parameters of a module of the same architecture
  void MoveTowards(const FlatParameters& other, double rate);

 private:
  torch::Tensor values_;
};

/// Draws initial weights uniformly in ±1/√fan_in, which is the distribution of PyTorch. `stream` is
/// the index of the random stream of (seed, RngStream::kLearner). The weights do not depend on the
/// version of libtorch. The parameters must be on the CPU.
void DrawWeights(torch::nn::Module& module, std::uint64_t seed, std::uint32_t stream);

}  // namespace aquafarm::agents
