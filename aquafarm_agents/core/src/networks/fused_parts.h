// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Fully connected layers on raw memory, with the layout of torch::nn::Linear.

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "networks/gemm.h"

namespace aquafarm::agents {

/// Computes out [rows, outputs] = in [rows, inputs] · Wᵀ + b with W [outputs, inputs].
inline void LinearForward(std::size_t rows, std::size_t inputs, std::size_t outputs,
                          const float* in, const float* weight, const float* bias, float* out) {
  for (std::size_t row = 0; row < rows; ++row) std::copy_n(bias, outputs, out + row * outputs);
  MultiplyByTransposed(rows, outputs, inputs, in, weight, 1.0F, out);
}

/// Applies the ReLU to `values`.
inline void Rectify(std::size_t size, float* values) {
  for (std::size_t i = 0; i < size; ++i) values[i] = std::max(values[i], 0.0F);
}

/// Computes the gradient of W and b of LinearForward.
/// @param slopes [rows, outputs] d loss / d out
/// @param weight receives d loss / d W, [outputs, inputs]
/// @param bias receives d loss / d b, [outputs]
inline void LinearGradient(std::size_t rows, std::size_t inputs, std::size_t outputs,
                           const float* in, const float* slopes, float* weight, float* bias) {
  MultiplyTransposed(outputs, inputs, rows, slopes, in, 0.0F, weight);
  std::fill_n(bias, outputs, 0.0F);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < outputs; ++i) bias[i] += slopes[row * outputs + i];
  }
}

/// Computes d loss / d in: in_slopes = slopes · W + beta · in_slopes.
/// @param slopes [rows, outputs] d loss / d out
/// @param in_slopes [rows, inputs]
inline void LinearInputSlopes(std::size_t rows, std::size_t inputs, std::size_t outputs,
                              const float* slopes, const float* weight, float beta,
                              float* in_slopes) {
  Multiply(rows, inputs, outputs, slopes, weight, beta, in_slopes);
}

/// Sets slopes to 0 where the output of the ReLU is 0.
inline void BackwardRelu(std::size_t size, const float* out, float* slopes) {
  for (std::size_t i = 0; i < size; ++i) slopes[i] = out[i] > 0.0F ? slopes[i] : 0.0F;
}

/// Replaces A by Q = V + A − mean A.
/// @param values [rows] V
/// @param q [rows, count] A; receives Q
inline void AddStateValue(std::size_t rows, std::size_t count, const float* values, float* q) {
  for (std::size_t row = 0; row < rows; ++row, q += count) {
    const float mean = std::accumulate(q, q + count, 0.0F) / static_cast<float>(count);
    for (std::size_t a = 0; a < count; ++a) q[a] += values[row] - mean;
  }
}

/// Computes the gradient of AddStateValue.
/// @param slopes [rows, count] d loss / d Q; receives d loss / d A
/// @param values receives d loss / d V, [rows]
inline void SplitStateValue(std::size_t rows, std::size_t count, float* slopes, float* values) {
  for (std::size_t row = 0; row < rows; ++row, slopes += count) {
    values[row] = std::accumulate(slopes, slopes + count, 0.0F);
    for (std::size_t a = 0; a < count; ++a) slopes[a] -= values[row] / static_cast<float>(count);
  }
}

}  // namespace aquafarm::agents
