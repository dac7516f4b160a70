// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/adam.h"

#include <Eigen/Core>
#include <cmath>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

constexpr double kMeanDecay = 0.9;
constexpr double kSquareDecay = 0.999;
constexpr float kEpsilon = 1e-5F;  // as in PPO's reference code; Kingma and Ba use 1e-8

using Array = Eigen::Map<Eigen::ArrayXf>;
using ConstArray = Eigen::Map<const Eigen::ArrayXf>;

Array Map(std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

bool Adam::Step(const std::vector<float>& gradient, double learning_rate, double max_norm,
                std::vector<float>& weights) {
  AQUAFARM_CHECK_EQ(gradient.size(), mean_.size());
  AQUAFARM_CHECK_EQ(weights.size(), mean_.size());
  const ConstArray raw(gradient.data(), static_cast<Eigen::Index>(gradient.size()));
  const double norm = std::sqrt(static_cast<double>(raw.square().sum()));
  if (!std::isfinite(norm)) return false;
  const auto scale = static_cast<float>(max_norm > 0.0 && norm > max_norm ? max_norm / norm : 1.0);
  ++steps_;
  const auto step = static_cast<double>(steps_);
  const double mean_correction = 1.0 - std::pow(kMeanDecay, step);
  const double square_correction = 1.0 - std::pow(kSquareDecay, step);
  const auto rate = static_cast<float>(learning_rate / mean_correction);
  const auto root = static_cast<float>(1.0 / std::sqrt(square_correction));
  auto mean = Map(mean_);
  auto square = Map(square_);
  constexpr auto kKeptMean = static_cast<float>(kMeanDecay);
  constexpr auto kKeptSquare = static_cast<float>(kSquareDecay);
  mean = kKeptMean * mean + ((1.0F - kKeptMean) * scale) * raw;
  square = kKeptSquare * square + ((1.0F - kKeptSquare) * scale * scale) * raw.square();
  Map(weights) -= rate * mean / (square.sqrt() * root + kEpsilon);
  return true;
}

void Adam::Save(Checkpoint& checkpoint) const {
  checkpoint.SetArray("adam.mean", mean_);
  checkpoint.SetArray("adam.square", square_);
  checkpoint.SetArray("adam", std::vector<std::uint64_t>{steps_});
}

void Adam::Load(const Checkpoint& checkpoint) {
  std::vector<float> mean;
  std::vector<float> square;
  std::vector<std::uint64_t> steps;
  checkpoint.GetArray("adam.mean", mean_.size(), mean);
  checkpoint.GetArray("adam.square", square_.size(), square);
  checkpoint.GetArray("adam", 1, steps);
  mean_ = std::move(mean);
  square_ = std::move(square);
  steps_ = steps[0];
}

}  // namespace aquafarm::agents
