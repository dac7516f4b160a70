// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/adam.h"

#include <cmath>

#include "aquafarm/base/check.h"
#include "networks/adam_step.h"

namespace aquafarm::agents {
namespace {

constexpr float kEpsilon = 1e-5F;  // as in PPO's reference code; Kingma and Ba use 1e-8

}  // namespace

bool Adam::Step(const std::vector<float>& gradient, double learning_rate, double max_norm,
                std::vector<float>& weights) {
  AQUAFARM_CHECK_EQ(gradient.size(), mean_.size());
  AQUAFARM_CHECK_EQ(weights.size(), mean_.size());
  const double norm = GradientNorm(gradient.data(), gradient.size());
  if (!std::isfinite(norm)) return false;
  const double scale = max_norm > 0.0 && norm > max_norm ? max_norm / norm : 1.0;
  ++steps_;
  AdamStep(mean_.size(), gradient.data(), scale, learning_rate, steps_, kEpsilon, mean_.data(),
           square_.data(), weights.data());
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
