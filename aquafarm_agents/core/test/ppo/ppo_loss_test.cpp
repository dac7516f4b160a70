// SPDX-License-Identifier: BSD-3-Clause
// Compares the loss and its gradient with the definition in double precision and central
// differences.
#include "ppo/ppo_loss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "aquafarm/base/rng.h"

namespace aquafarm::agents::test {
namespace {

struct Case {
  std::vector<double> outputs;  // [kActorCriticOutputs]
  ActionMask mask{(1U << kActionCount) - 1};
  std::uint8_t action{};
  double log_prob{};
  double value{};
  double advantage{};
  double target{};
  std::uint8_t label{kNoLabel};
};

// The denominator of the softmax over the allowed actions.
double SumOfExponentials(const Case& c) {
  double sum = 0.0;
  for (std::size_t a = 0; a < kActionCount; ++a) {
    if (((c.mask >> a) & 1U) != 0) sum += std::exp(c.outputs[a]);
  }
  return sum;
}

// The cross-entropy with the teacher, with its weight; the loss of PPO does not contain it.
double DefinedImitation(const Case& c, const PpoCoefficients& k) {
  if (c.label == kNoLabel) return 0.0;
  const double sum = SumOfExponentials(c);
  return -static_cast<double>(k.imitation) * (c.outputs[c.label] - std::log(sum));
}

// Schulman et al. 2017, Eq. 7 and 9, with the ratio continued along its tangent beyond the bound.
double DefinedLoss(const Case& c, const PpoCoefficients& k) {
  const double sum = SumOfExponentials(c);
  double entropy = 0.0;
  for (std::size_t a = 0; a < kActionCount; ++a) {
    if (((c.mask >> a) & 1U) == 0) continue;
    const double p = std::exp(c.outputs[a]) / sum;
    entropy -= p * std::log(p);
  }
  const double x = c.outputs[c.action] - std::log(sum) - c.log_prob;
  const double bound = static_cast<double>(kMaxLogRatio);
  const double ratio = x <= bound ? std::exp(x) : std::exp(bound) * (1.0 + x - bound);
  const double clip = static_cast<double>(k.clip);
  const double policy =
      -std::min(ratio * c.advantage, std::clamp(ratio, 1.0 - clip, 1.0 + clip) * c.advantage);
  const double value = c.outputs[kActionCount];
  double error = std::pow(value - c.target, 2);
  if (k.value_clip > 0.0F) {
    const double range = static_cast<double>(k.value_clip);
    const double held = c.value + std::clamp(value - c.value, -range, range);
    error = std::max(error, std::pow(held - c.target, 2));
  }
  return policy + static_cast<double>(k.value) * 0.5 * error -
         static_cast<double>(k.entropy) * entropy;
}

struct Computed {
  double loss{};
  std::vector<float> slopes;
};

Computed Compute(const Case& c, const PpoCoefficients& k, float weight = 1.0F) {
  const std::vector<float> outputs(c.outputs.begin(), c.outputs.end());
  const auto log_prob = static_cast<float>(c.log_prob);
  const auto value = static_cast<float>(c.value);
  const auto advantage = static_cast<float>(c.advantage);
  const auto target = static_cast<float>(c.target);
  ActionDistribution distribution;
  Computed computed;
  computed.slopes.resize(kActorCriticOutputs);
  const PpoRows rows{&c.mask, &c.action, &log_prob, &value, &advantage, &target, &weight, &c.label};
  computed.loss =
      ComputeLoss(outputs.data(), 1, rows, k, distribution, computed.slopes.data()).Total(k);
  return computed;
}

Case RandomCase(RandomStream& rng) {
  Case c;
  for (std::size_t i = 0; i < kActorCriticOutputs; ++i) {
    c.outputs.push_back(static_cast<double>(rng.Uniform(-2.0F, 2.0F)));
  }
  c.action = static_cast<std::uint8_t>(rng.Below(kActionCount));
  c.mask = static_cast<ActionMask>(rng.Below(1U << kActionCount) | (1U << c.action));
  c.log_prob = static_cast<double>(rng.Uniform(-4.0F, -0.5F));
  c.value = static_cast<double>(rng.Uniform(-2.0F, 2.0F));
  c.advantage = static_cast<double>(rng.Uniform(-2.0F, 2.0F));
  c.target = static_cast<double>(rng.Uniform(-2.0F, 2.0F));
  const auto label = static_cast<std::uint8_t>(rng.Below(kActionCount));
  if ((c.mask >> label & 1U) != 0) c.label = label;
  return c;
}

TEST(PpoLoss, AndItsGradientEqualTheDefinition) {
  RandomStream rng({3, 0, RngStream::kLearner, 0});
  constexpr double kStep = 1e-5;
  for (const float value_clip : {0.0F, 0.3F}) {
    const PpoCoefficients k{0.2F, value_clip, 0.5F, 0.1F, 0.7F};
    for (int trial = 0; trial < 300; ++trial) {
      const Case c = RandomCase(rng);
      const Computed computed = Compute(c, k);
      ASSERT_NEAR(computed.loss, DefinedLoss(c, k), 1e-4) << trial;
      for (std::size_t i = 0; i < kActorCriticOutputs; ++i) {
        Case up = c;
        Case down = c;
        up.outputs[i] += kStep;
        down.outputs[i] -= kStep;
        const double change = DefinedLoss(up, k) + DefinedImitation(up, k) - DefinedLoss(down, k) -
                              DefinedImitation(down, k);
        const double slope = change / (2.0 * kStep);
        ASSERT_NEAR(static_cast<double>(computed.slopes[i]), slope, 1e-3 * (1.0 + std::abs(slope)))
            << "trial " << trial << ", output " << i;
      }
    }
  }
}

TEST(PpoLoss, MaskedActionsHaveNoProbabilityAndNoGradient) {
  Case c;
  c.outputs.assign(kActorCriticOutputs, 0.0);
  c.outputs[4] = 80.0;  // masked, and far larger than the others
  c.mask = 0b0000000011;
  c.advantage = 1.0;
  c.log_prob = std::log(0.5);
  const PpoCoefficients k{0.2F, 0.0F, 0.5F, 0.1F};
  const Computed computed = Compute(c, k);
  EXPECT_NEAR(computed.loss, -1.0 - 0.1 * std::log(2.0), 1e-5);
  for (std::size_t a = 2; a < kActionCount; ++a) EXPECT_EQ(computed.slopes[a], 0.0F) << a;
  const std::vector<float> outputs(c.outputs.begin(), c.outputs.end());
  ActionDistribution distribution;
  distribution.Compute(outputs.data(), &c.mask, 1);
  EXPECT_EQ(distribution.probs(0, 4), 0.0F);
  EXPECT_FLOAT_EQ(distribution.probs(0, 0), 0.5F);
}

TEST(PpoLoss, StaysFiniteWhereANegativeAdvantageDoesNotClipTheRatio) {
  Case c;
  c.outputs.assign(kActorCriticOutputs, 0.0);
  c.advantage = -1.0;
  c.log_prob = -200.0;  // e^198 exceeds the range of a float
  const PpoCoefficients k{0.2F, 0.0F, 0.0F, 0.0F};
  const Computed computed = Compute(c, k);
  EXPECT_NEAR(computed.loss, DefinedLoss(c, k), 1.0) << "some 3,900";
  EXPECT_NEAR(computed.slopes[0], std::exp(kMaxLogRatio) * 0.9F, 1e-3F);
  c.advantage = 1.0;
  EXPECT_FLOAT_EQ(static_cast<float>(Compute(c, k).loss), -1.2F) << "clipped";
  EXPECT_EQ(Compute(c, k).slopes[0], 0.0F);
}

TEST(PpoLoss, IgnoresRowsOfNoWeight) {
  RandomStream rng({4, 0, RngStream::kLearner, 0});
  const Computed computed = Compute(RandomCase(rng), {0.2F, 0.0F, 0.5F, 0.1F}, 0.0F);
  EXPECT_EQ(computed.loss, 0.0);
  EXPECT_EQ(computed.slopes, std::vector<float>(kActorCriticOutputs, 0.0F));
}

}  // namespace
}  // namespace aquafarm::agents::test
