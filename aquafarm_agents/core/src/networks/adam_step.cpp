// SPDX-License-Identifier: BSD-3-Clause
#include "networks/adam_step.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "aquafarm/base/widest.h"

namespace aquafarm::agents {
namespace {

constexpr double kMeanDecay = 0.9;
constexpr double kSquareDecay = 0.999;

/// Factors of one step. `rate` and `root` are computed in double precision and rounded to float
/// once.
struct Factors {
  float mean;    // weight of the gradient in its moving average
  float square;  // weight of the squared gradient in its moving average
  float rate;    // learning rate with the bias correction of the mean
  float root;    // bias correction of the root of the mean square
  float epsilon;
};

AQUAFARM_WIDEST
float SumOfSquares(const float* values, std::size_t size) {
  constexpr std::size_t kLanes = 64;  // independent sums
  std::array<float, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sums[lane] += values[i + lane] * values[i + lane];
    }
  }
  for (; i < size; ++i) sums[i % kLanes] += values[i] * values[i];
  float sum = 0.0F;
  for (const float one : sums) sum += one;
  return sum;
}

AQUAFARM_WIDEST
void Step(std::size_t size, const float* __restrict gradient, const Factors factors,
          float* __restrict mean, float* __restrict square, float* __restrict weights) {
  constexpr auto kKeptMean = static_cast<float>(kMeanDecay);
  constexpr auto kKeptSquare = static_cast<float>(kSquareDecay);
  for (std::size_t i = 0; i < size; ++i) {
    mean[i] = kKeptMean * mean[i] + factors.mean * gradient[i];
    square[i] = kKeptSquare * square[i] + factors.square * (gradient[i] * gradient[i]);
    weights[i] -= factors.rate * mean[i] / (std::sqrt(square[i]) * factors.root + factors.epsilon);
  }
}

}  // namespace

double GradientNorm(const float* gradient, std::size_t size) {
  return std::sqrt(static_cast<double>(SumOfSquares(gradient, size)));
}

void AdamStep(std::size_t size, const float* gradient, double scale, double learning_rate,
              std::uint64_t step, float epsilon, float* mean, float* square, float* weights) {
  constexpr auto kNewMean = 1.0F - static_cast<float>(kMeanDecay);
  constexpr auto kNewSquare = 1.0F - static_cast<float>(kSquareDecay);
  const auto factor = static_cast<float>(scale);
  const double mean_correction = 1.0 - std::pow(kMeanDecay, static_cast<double>(step));
  const double square_correction = 1.0 - std::pow(kSquareDecay, static_cast<double>(step));
  Step(size, gradient,
       {kNewMean * factor, kNewSquare * factor * factor,
        static_cast<float>(learning_rate / mean_correction),
        static_cast<float>(1.0 / std::sqrt(square_correction)), epsilon},
       mean, square, weights);
}

AQUAFARM_WIDEST
void AdvanceTowards(std::size_t size, const float* towards, float rate, float* values) {
  if (rate == 1.0F) {
    std::copy_n(towards, size, values);
    return;
  }
  for (std::size_t i = 0; i < size; ++i) values[i] += rate * (towards[i] - values[i]);
}

}  // namespace aquafarm::agents
