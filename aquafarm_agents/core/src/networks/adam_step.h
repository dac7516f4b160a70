// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace aquafarm::agents {

/// Returns the Euclidean norm of a gradient; infinite or NaN if an element is.
inline double GradientNorm(const float* gradient, std::size_t size) {
  const Eigen::Map<const Eigen::ArrayXf> raw(gradient, static_cast<Eigen::Index>(size));
  return std::sqrt(static_cast<double>(raw.square().sum()));
}

/// One step of Adam (Kingma and Ba 2015) against scale · gradient.
/// @param step number of this step, from 1
/// @param epsilon added to the root of the mean square
/// @param mean, square [size] moving averages of the gradient and of its square
inline void AdamStep(std::size_t size, const float* gradient, double scale, double learning_rate,
                     std::uint64_t step, float epsilon, float* mean, float* square,
                     float* weights) {
  using Array = Eigen::Map<Eigen::ArrayXf>;
  constexpr double kMeanDecay = 0.9;
  constexpr double kSquareDecay = 0.999;
  constexpr auto kKeptMean = static_cast<float>(kMeanDecay);
  constexpr auto kKeptSquare = static_cast<float>(kSquareDecay);
  const auto count = static_cast<Eigen::Index>(size);
  const auto factor = static_cast<float>(scale);
  const double mean_correction = 1.0 - std::pow(kMeanDecay, static_cast<double>(step));
  const double square_correction = 1.0 - std::pow(kSquareDecay, static_cast<double>(step));
  const auto rate = static_cast<float>(learning_rate / mean_correction);
  const auto root = static_cast<float>(1.0 / std::sqrt(square_correction));
  const Eigen::Map<const Eigen::ArrayXf> raw(gradient, count);
  Array means(mean, count);
  Array squares(square, count);
  means = kKeptMean * means + ((1.0F - kKeptMean) * factor) * raw;
  squares = kKeptSquare * squares + ((1.0F - kKeptSquare) * factor * factor) * raw.square();
  Array(weights, count) -= rate * means / (squares.sqrt() * root + epsilon);
}

}  // namespace aquafarm::agents
