// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The value networks for features on the CPU, which compute their gradients without libtorch. The
/// parameters are in the order of the modules of networks.h; each weight is [outputs, inputs]. The
/// buffers are kept, so a call allocates memory only if it has more rows (for the LSTM: steps ×
/// rows) than all earlier calls of the same function.

#include <cstddef>
#include <vector>

#include "networks/lstm_sequence.h"
#include "networks/value_network.h"

namespace aquafarm::agents {

/// Memory of a network's parameters and of their gradient.
struct ParameterMemory {
  const float* values{};
  float* gradient{};
};

/// Linear - ReLU - head: the last layers of FusedMlpValues and FusedLstmValues.
class HiddenAndHead {
 public:
  HiddenAndHead(std::size_t inputs, std::size_t hidden, bool dueling)
      : inputs_(inputs), hidden_(hidden), dueling_(dueling) {}

  /// @param in [rows, inputs]
  /// @param parameters parameters of these layers
  /// @returns Q [rows, kActionCount], valid until the next call
  const float* Forward(std::size_t rows, const float* in, const float* parameters);
  /// Replaces the gradient of the parameters of these layers.
  /// @param slopes [rows, kActionCount] d loss / d Q
  /// @param in the input of the last Forward
  /// @returns d loss / d in, [rows, inputs], valid until the next call
  float* Backward(std::size_t rows, const float* slopes, const float* in,
                  const ParameterMemory& parameters);

 private:
  // Returns the index of the head's first parameter.
  std::size_t head() const { return (inputs_ + 1) * hidden_; }

  const std::size_t inputs_;
  const std::size_t hidden_;
  const bool dueling_;
  std::vector<float> out_;
  std::vector<float> values_;
  std::vector<float> state_values_;
  std::vector<float> value_slopes_;
  std::vector<float> state_value_slopes_;
  std::vector<float> out_slopes_;
  std::vector<float> in_slopes_;
};

/// A value network with the layers of the MLP that MakeNetwork makes.
class FusedMlpValues final : public ValueNetwork<float> {
 public:
  FusedMlpValues(std::size_t features, std::size_t hidden, bool dueling,
                 const ParameterMemory& parameters)
      : features_(features),
        hidden_(hidden),
        parameters_(parameters),
        rest_(hidden, hidden, dueling) {}

  const float* Forward(std::size_t rows, const float* observations) override;
  void Backward(std::size_t rows, const float* slopes) override;

 private:
  std::size_t rest() const { return (features_ + 1) * hidden_; }

  const std::size_t features_;
  const std::size_t hidden_;
  const ParameterMemory parameters_;
  HiddenAndHead rest_;
  const float* seen_{};
  std::vector<float> first_;
};

/// A value network with the layers of RecurrentNetwork.
class FusedLstmValues final : public RecurrentValueNetwork {
 public:
  FusedLstmValues(std::size_t features, std::size_t hidden, bool skip_connection, bool dueling,
                  const ParameterMemory& parameters);

  const float* Forward(std::size_t steps, std::size_t rows, const float* features,
                       float* state) override;
  void WarmUp(std::size_t steps, std::size_t rows, const float* features, float* state) override;
  void Backward(std::size_t count, const float* slopes) override;

 private:
  std::size_t lstm() const { return (features_ + 1) * hidden_; }
  std::size_t rest() const { return lstm() + 8 * hidden_ * (hidden_ + 1); }
  std::size_t width() const { return skip_connection_ ? 2 * hidden_ : hidden_; }
  LstmWeights<const float> weights() const;
  LstmTrace trace() { return {gates_.data(), cells_.data(), cell_tanh_.data(), output_.data()}; }
  void Reserve(const LstmShape& shape);

  const std::size_t features_;
  const std::size_t hidden_;
  const bool skip_connection_;
  const ParameterMemory parameters_;
  HiddenAndHead rest_;
  LstmShape shape_;  // of the last Forward or WarmUp
  const float* seen_{};
  std::vector<float> bias_;           // sum of the two biases of the LSTM
  std::vector<float> transposed_;     // scratch memory
  std::vector<float> hidden_before_;  // h, the hidden state, before the first step
  std::vector<float> input_;          // x, the input of the LSTM
  std::vector<float> gates_;
  std::vector<float> cells_;
  std::vector<float> cell_tanh_;
  std::vector<float> output_;  // h after each step
  std::vector<float> joined_;  // [h, x] with the skip connection
  std::vector<float> hidden_slopes_;
  std::vector<float> cell_slopes_;
  std::vector<float> gate_slopes_;
  std::vector<float> output_slopes_;
  std::vector<float> input_slopes_;
};

}  // namespace aquafarm::agents
