// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// An LSTM of one layer along sequences, with the weights of torch::nn::LSTM, and its gradient, in
/// memory of the caller.

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
  Float* bias{};    ///< [4H] the sum of both biases
};

/// What the gradient needs.
struct LstmTrace {
  float* gates{};      ///< [T, B, 4H] after the nonlinearity
  float* cells{};      ///< [T + 1, B, H]; the first is c before the first step, set by the caller
  float* cell_tanh{};  ///< [T, B, H]
  float* output{};     ///< [T, B, H] h
};

/// @param in [T, B, F] @param hidden [B, H] h before the first step
/// @param transposed [H, 4H] scratch
void LstmForward(const LstmShape& shape, const float* in, const float* hidden,
                 const LstmWeights<const float>& weights, float* transposed,
                 const LstmTrace& trace);

/// Slopes are d loss / d value.
/// @param output_slopes [T, B, H] of h of each step; null if nothing reads them
/// @param hidden_slopes, cell_slopes [B, H] of h and c after the last step; receive those of h and
/// c
///        before the first
/// @param gate_slopes [T, B, 4H] scratch
/// @param gradient receives the gradient @param in_slopes [T, B, F] receives the slopes of `in`
void LstmBackward(const LstmShape& shape, const float* in, const float* hidden,
                  const LstmWeights<const float>& weights, const LstmTrace& trace,
                  const float* output_slopes, float* hidden_slopes, float* cell_slopes,
                  float* gate_slopes, const LstmWeights<float>& gradient, float* in_slopes);

}  // namespace aquafarm::agents
