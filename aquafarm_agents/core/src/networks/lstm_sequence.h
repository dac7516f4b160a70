// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// An LSTM of one layer, evaluated along sequences, and its gradient. The weights have the layout
/// of torch::nn::LSTM. The caller provides all memory.

#include <cstddef>

namespace aquafarm::agents {

/// Sizes: T steps of B rows, F inputs, H units.
struct LstmShape {
  std::size_t steps{};
  std::size_t rows{};
  std::size_t inputs{};
  std::size_t hidden{};

  std::size_t gates() const { return 4 * hidden; }
  std::size_t step_size() const { return rows * hidden; }  ///< values of h in one step
};

/// Weights of an LSTM, or their gradients.
template <typename Float>
struct LstmWeights {
  Float* input{};   ///< [4H, F]
  Float* hidden{};  ///< [4H, H]
  Float* bias{};    ///< [4H] the sum of the two biases of torch::nn::LSTM
};

/// Results of LstmForward, which LstmBackward needs.
struct LstmTrace {
  float* gates{};      ///< [T, B, 4H] gates, after their nonlinear functions
  float* cells{};      ///< [T + 1, B, H] c; the caller sets element 0, c before the first step
  float* cell_tanh{};  ///< [T, B, H] tanh(c) after each step
  float* output{};     ///< [T, B, H] h after each step
};

/// Evaluates the LSTM along T steps.
/// @param in [T, B, F]
/// @param hidden [B, H] h before the first step
/// @param transposed [H, 4H] scratch memory
/// @param trace receives the results
void LstmForward(const LstmShape& shape, const float* in, const float* hidden,
                 const LstmWeights<const float>& weights, float* transposed,
                 const LstmTrace& trace);

/// Computes the gradient of LstmForward.
/// @param in, hidden, weights, trace as in LstmForward; weights.bias is not read
/// @param output_slopes [T, B, H] d loss / d h after each step; null if all are 0
/// @param hidden_slopes, cell_slopes [B, H] d loss / d (h, c) after the last step, in addition to
///   output_slopes; receive d loss / d (h, c) before the first step
/// @param gate_slopes [T, B, 4H] scratch memory
/// @param gradient receives d loss / d weights
/// @param in_slopes receives d loss / d in, [T, B, F]
void LstmBackward(const LstmShape& shape, const float* in, const float* hidden,
                  const LstmWeights<const float>& weights, const LstmTrace& trace,
                  const float* output_slopes, float* hidden_slopes, float* cell_slopes,
                  float* gate_slopes, const LstmWeights<float>& gradient, float* in_slopes);

}  // namespace aquafarm::agents
