// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/ppo_loss.h"

#include <algorithm>
#include <cmath>

namespace aquafarm::agents {
namespace {

using Index = Eigen::Index;

constexpr float kFarBelow = -1e30F;  // below any logit

/// A value in the loss and its derivative.
struct Sloped {
  float value{};
  float slope{};
};

Sloped Ratio(float log_ratio) {
  if (log_ratio <= kMaxLogRatio) {
    const float ratio = std::exp(log_ratio);
    return {ratio, ratio};
  }
  const float bound = std::exp(kMaxLogRatio);
  return {bound * (1.0F + log_ratio - kMaxLogRatio), bound};
}

/// Returns −min(ρ A, clip(ρ) A) and its derivative with respect to log π(a | s).
Sloped PolicyTerm(float log_ratio, float advantage, float clip) {
  const Sloped ratio = Ratio(log_ratio);
  const float clipped = std::min(std::max(ratio.value, 1.0F - clip), 1.0F + clip);
  if (ratio.value * advantage <= clipped * advantage) {
    return {-ratio.value * advantage, -ratio.slope * advantage};
  }
  return {-clipped * advantage, 0.0F};
}

/// Adds the derivatives of −scale · log π(label) with respect to the logits.
void AddImitation(const ActionDistribution& policy, Index row, std::uint8_t label, float scale,
                  float* slope) {
  for (int a = 0; a < kActionCount; ++a) slope[a] += scale * policy.probs(row, a);
  slope[label] -= scale;
}

/// Returns ½ (V − target)² and its derivative with respect to V. With a clip range, returns the
/// larger one of this loss and the loss of V clipped to the range around V_old (as in the code of
/// Schulman et al. 2017).
Sloped ValueTerm(float value, float old_value, float target, float clip) {
  const float error = value - target;
  if (clip <= 0.0F) return {0.5F * error * error, error};
  const float change = value - old_value;
  const float held = old_value + std::min(std::max(change, -clip), clip) - target;
  if (error * error >= held * held) return {0.5F * error * error, error};
  return {0.5F * held * held, 0.0F};
}

}  // namespace

PpoLoss& PpoLoss::operator+=(const PpoLoss& other) {
  policy += other.policy;
  value += other.value;
  entropy += other.entropy;
  square_error += other.square_error;
  clipped += other.clipped;
  return *this;
}

void ActionDistribution::Compute(const float* outputs, const ActionMask* masks,
                                 std::size_t row_count) {
  const auto rows = static_cast<Index>(row_count);
  log_probs.resize(rows, kActionCount);
  probs.resize(rows, kActionCount);
  for (Index row = 0; row < rows; ++row) {
    const float* const logits = outputs + static_cast<std::size_t>(row) * kActorCriticOutputs;
    const ActionMask mask = masks[row];
    for (int a = 0; a < kActionCount; ++a) {
      log_probs(row, a) = ((mask >> a) & 1U) != 0 ? logits[a] : kFarBelow;
    }
  }
  log_probs.colwise() -= log_probs.rowwise().maxCoeff().eval();
  probs = log_probs.exp();
  // Sets masked actions to exactly 0, which the vectorized exp() never returns.
  for (int a = 0; a < kActionCount; ++a) {
    for (Index row = 0; row < rows; ++row) {
      probs(row, a) = ((masks[row] >> a) & 1U) != 0 ? probs(row, a) : 0.0F;
    }
  }
  const Eigen::ArrayXf sums = probs.rowwise().sum();
  log_probs.colwise() -= sums.log().eval();
  probs.colwise() *= sums.inverse().eval();
  entropies = -(probs * log_probs).rowwise().sum();
}

PpoLoss ComputeLoss(const float* outputs, std::size_t rows, const PpoRows& recorded,
                    const PpoCoefficients& coefficients, ActionDistribution& distribution,
                    float* slopes) {
  distribution.Compute(outputs, recorded.masks, rows);
  PpoLoss loss;
  for (std::size_t i = 0; i < rows; ++i) {
    const auto row = static_cast<Index>(i);
    float* const slope = slopes + i * kActorCriticOutputs;
    const float weight = recorded.weights[i];
    if (weight == 0.0F) {
      std::fill_n(slope, kActorCriticOutputs, 0.0F);
      continue;
    }
    const int action = recorded.actions[i];
    const Sloped policy = PolicyTerm(distribution.log_probs(row, action) - recorded.log_probs[i],
                                     recorded.advantages[i], coefficients.clip);
    const float value_now = outputs[i * kActorCriticOutputs + kActionCount];
    const Sloped value =
        ValueTerm(value_now, recorded.values[i], recorded.targets[i], coefficients.value_clip);
    // d log π(a)/d logit_b = [a = b] − π(b);  d H/d logit_b = −π(b) (log π(b) + H)
    const float entropy = distribution.entropies[row];
    for (int b = 0; b < kActionCount; ++b) {
      const float prob = distribution.probs(row, b);
      const float spread = coefficients.entropy * (distribution.log_probs(row, b) + entropy);
      slope[b] = weight * prob * (spread - policy.slope);
    }
    slope[action] += weight * policy.slope;
    slope[kActionCount] = weight * coefficients.value * value.slope;
    if (recorded.labels != nullptr && recorded.labels[i] != kNoLabel) {
      AddImitation(distribution, row, recorded.labels[i], coefficients.imitation * weight, slope);
    }
    const auto share = static_cast<double>(weight);
    const auto error = static_cast<double>(value_now - recorded.targets[i]);
    loss.policy += share * static_cast<double>(policy.value);
    loss.value += share * static_cast<double>(value.value);
    loss.entropy += share * static_cast<double>(entropy);
    loss.square_error += share * error * error;
    loss.clipped += policy.slope == 0.0F ? share : 0.0;
  }
  return loss;
}

}  // namespace aquafarm::agents
