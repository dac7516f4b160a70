// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "networks/fused_parts.h"  // BackwardRelu
#include "networks/gemm.h"

namespace aquafarm::agents {

/// One fully connected layer inside a flat parameter vector: weights [inputs, outputs], row-major,
/// then the bias [outputs].
struct Linear {
  std::size_t begin{};  ///< index of its first weight in the flat vector
  std::size_t inputs{};
  std::size_t outputs{};

  std::size_t bias() const { return begin + inputs * outputs; }
  std::size_t end() const { return bias() + outputs; }

  /// out [rows, outputs] = in [rows, inputs] · W + b
  void Forward(const std::vector<float>& weights, std::size_t rows, const float* in,
               float* out) const {
    Multiply(rows, outputs, inputs, in, weights.data() + begin, 0.0F, out);
    const float* const b = weights.data() + bias();
    for (std::size_t row = 0; row < rows; ++row) {
      float* const values = out + row * outputs;
      for (std::size_t i = 0; i < outputs; ++i) values[i] += b[i];
    }
  }

  /// out = ReLU(in · W + b)
  void ForwardRelu(const std::vector<float>& weights, std::size_t rows, const float* in,
                   float* out) const {
    Multiply(rows, outputs, inputs, in, weights.data() + begin, 0.0F, out);
    const float* const b = weights.data() + bias();
    for (std::size_t row = 0; row < rows; ++row) {
      float* const values = out + row * outputs;
      for (std::size_t i = 0; i < outputs; ++i) values[i] = std::max(values[i] + b[i], 0.0F);
    }
  }

  /// Adds d loss / d (W, b) to `gradient`. @param slopes [rows, outputs]: d loss / d out
  void AddGradient(std::size_t rows, const float* in, const float* slopes,
                   std::vector<float>& gradient) const {
    MultiplyTransposed(inputs, outputs, rows, in, slopes, 1.0F, gradient.data() + begin);
    float* const b = gradient.data() + bias();
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = 0; i < outputs; ++i) b[i] += slopes[row * outputs + i];
    }
  }

  /// in_slopes [rows, inputs] = slopes · Wᵀ
  void BackwardInput(const std::vector<float>& weights, std::size_t rows, const float* slopes,
                     float* in_slopes) const {
    MultiplyByTransposed(rows, inputs, outputs, slopes, weights.data() + begin, 0.0F, in_slopes);
  }
};

}  // namespace aquafarm::agents
