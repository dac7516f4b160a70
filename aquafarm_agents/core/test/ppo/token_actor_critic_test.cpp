// SPDX-License-Identifier: BSD-3-Clause
// Compares outputs and gradients of the network of tokens with plain loops and complex-step
// derivatives (Squire and Trapp 1998), which use no back-propagation.
#include "ppo/token_actor_critic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/observation/tokens.h"
#include "ppo/complex_step.h"
#include "ppo/make_actor_critic.h"
#include "ppo/ppo_loss.h"
#include "ppo/route_rule.h"
#include "tiny_farms.h"

namespace aquafarm::agents::test {
namespace {

constexpr std::size_t kTokenHidden = 5;
constexpr std::size_t kRows = 4;
constexpr std::size_t kE = TokenActorCritic::kEmbedding;
constexpr std::size_t kHeads = TokenActorCritic::kHeads;

/// Token names with few features: the network reads everything from them.
const TokenLayout& Layout() {
  static const TokenLayout layout = [] {
    std::vector<std::string> names{"ship.time_left", "ship.x", "ship.y"};
    const auto add = [&names](const std::string& kind, int slots, int features) {
      for (int slot = 0; slot < slots; ++slot) {
        const std::string here = kind + std::to_string(slot) + '.';
        names.push_back(here + "valid");
        for (int i = 1; i < features; ++i) names.push_back(here + 'f' + std::to_string(i));
      }
    };
    add("device", 3, 5);
    add("port", 2, 4);
    add("disaster", 2, 6);
    add("other", 2, 3);
    return LayoutOfTokens(names);
  }();
  return layout;
}

std::size_t Features() { return Layout().groups.back().end(); }

/// out = in · W + b, and ReLU; reads the layer at `next` and moves it to the following one.
Vector Apply(const Complex*& next, const Vector& in, std::size_t outputs, bool relu = true) {
  Vector out(outputs);
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in[i] == 0.0) continue;
    for (std::size_t o = 0; o < outputs; ++o) out[o] += in[i] * next[i * outputs + o];
  }
  next += in.size() * outputs;
  for (std::size_t o = 0; o < outputs; ++o) out[o] += next[o];
  next += outputs;
  for (Complex& value : out) value = relu ? Relu(value) : value;
  return out;
}

Vector Outputs(const Vector& weights, const float* row) {
  const Complex* next = weights.data();
  const auto& groups = Layout().groups;
  const Vector ship = Apply(next, Vector(row, row + groups[0].size), kTokenHidden);
  Vector joined = ship;
  std::vector<Vector> targets;
  for (std::size_t kind = 1; kind < groups.size(); ++kind) {
    const TokenGroup& group = groups[kind];
    const Complex* const encoder = next;
    Vector max(kE);
    for (std::size_t slot = 0; slot < group.slots; ++slot) {
      const float* const token = row + group.begin + slot * group.size;
      const Complex* layer = encoder;
      const Vector middle = Apply(layer, Vector(token, token + group.size), kE);
      const Vector embedding = Apply(layer, middle, kE);
      next = layer;
      if (token[0] == 0.0F) continue;
      for (std::size_t i = 0; i < kE; ++i) {
        if (embedding[i].real() > max[i].real()) max[i] = embedding[i];
      }
      if (kind <= 2) targets.push_back(embedding);
    }
    joined.insert(joined.end(), max.begin(), max.end());
  }
  const Vector queries = Apply(next, ship, kHeads * kE, false);
  for (std::size_t head = 0; head < kHeads; ++head) {
    Complex total = 0.0;
    Vector sum(kE);
    for (const Vector& target : targets) {
      Complex score = 0.0;
      for (std::size_t i = 0; i < kE; ++i) score += queries[head * kE + i] * target[i];
      const Complex weight = std::exp(score / std::sqrt(static_cast<double>(kE)));
      total += weight;
      for (std::size_t i = 0; i < kE; ++i) sum[i] += weight * target[i];
    }
    for (Complex& value : sum) value = targets.empty() ? Complex(0.0) : value / total;
    joined.insert(joined.end(), sum.begin(), sum.end());
  }
  const Vector first = Apply(next, joined, kTokenHidden);
  const Vector second = Apply(next, first, kTokenHidden);
  return Apply(next, second, kActorCriticOutputs, false);
}

struct TokenBatch {
  std::vector<float> features;
  std::vector<float> slopes;  // the loss is Σ slopes · outputs
  SequenceRows rows() const {
    SequenceRows rows;
    rows.sequences = kRows;
    rows.features = features.data();
    return rows;
  }
};

/// Row 0 has no valid token, row 1 one of each kind, the others some.
TokenBatch MakeBatch() {
  RandomStream rng({5, 0, RngStream::kLearner, 0});
  TokenBatch batch;
  for (std::size_t i = 0; i < kRows * Features(); ++i) {
    batch.features.push_back(rng.Uniform(-1.0F, 1.0F));
  }
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t kind = 1; kind < Layout().groups.size(); ++kind) {
      const TokenGroup& group = Layout().groups[kind];
      for (std::size_t slot = 0; slot < group.slots; ++slot) {
        float* const token =
            batch.features.data() + row * Features() + group.begin + slot * group.size;
        const bool is_valid = row == 0 ? false : row == 1 ? slot == 1 : rng.Below(2) == 0;
        token[0] = is_valid ? 1.0F : 0.0F;
      }
    }
  }
  for (std::size_t i = 0; i < kRows * kActorCriticOutputs; ++i) {
    batch.slopes.push_back(rng.Uniform(-1.0F, 1.0F));
  }
  return batch;
}

Complex LossOf(const Vector& weights, const TokenBatch& batch) {
  Complex loss = 0.0;
  for (std::size_t row = 0; row < kRows; ++row) {
    const Vector out = Outputs(weights, batch.features.data() + row * Features());
    for (std::size_t i = 0; i < kActorCriticOutputs; ++i) {
      loss += out[i] * static_cast<double>(batch.slopes[row * kActorCriticOutputs + i]);
    }
  }
  return loss;
}

TEST(TokenActorCritic, OutputsAndGradientEqualTheDefinition) {
  TokenActorCritic network(Layout(), kTokenHidden, 9);
  for (float& weight : network.weights()) weight *= 3.0F;  // so that the attention is sharp
  const TokenBatch batch = MakeBatch();
  Vector weights(network.weights().begin(), network.weights().end());
  const float* const outputs = network.Forward(batch.rows(), nullptr);
  for (std::size_t row = 0; row < kRows; ++row) {
    const Vector expected = Outputs(weights, batch.features.data() + row * Features());
    for (std::size_t i = 0; i < kActorCriticOutputs; ++i) {
      ASSERT_NEAR(static_cast<double>(outputs[row * kActorCriticOutputs + i]), expected[i].real(),
                  1e-3 * (1.0 + std::abs(expected[i].real())))
          << row << ' ' << i;
    }
  }
  network.Backward(batch.rows(), batch.slopes.data());
  constexpr double kTiny = 1e-30;
  constexpr std::size_t kStride = 7;  // coprime to the layers' widths, so that all units are met
  for (std::size_t k = 0; k < weights.size(); k += kStride) {
    const Complex kept = weights[k];
    weights[k] += Complex(0.0, kTiny);
    const double slope = LossOf(weights, batch).imag() / kTiny;
    weights[k] = kept;
    ASSERT_NEAR(static_cast<double>(network.gradient()[k]), slope, 2e-3 * (1.0 + std::abs(slope)))
        << "weight " << k << " of " << weights.size();
  }
}

TEST(TokenActorCritic, PermutedTokensGiveTheSameOutputs) {
  TokenActorCritic network(Layout(), kTokenHidden, 9);
  TokenBatch batch = MakeBatch();
  const float* outputs = network.Forward(batch.rows(), nullptr);
  const std::vector<float> before(outputs, outputs + kRows * kActorCriticOutputs);
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t kind = 1; kind < Layout().groups.size(); ++kind) {
      const TokenGroup& group = Layout().groups[kind];
      float* const first = batch.features.data() + row * Features() + group.begin;
      std::rotate(first, first + group.size, first + group.slots * group.size);
    }
  }
  outputs = network.Forward(batch.rows(), nullptr);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(outputs[i], before[i], 1e-5F) << i;
}

TEST(TokenLayout, IsReadFromTheNamesOfTheEncoder) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.view.tokens = true;
  const Encoder encoder(scenario);
  const TokenLayout layout = LayoutOfTokens(encoder.feature_names());
  const auto& groups = aquafarm::TokenGroups();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    EXPECT_EQ(layout.groups[i].begin, static_cast<std::size_t>(groups[i].begin));
    EXPECT_EQ(layout.groups[i].slots, static_cast<std::size_t>(groups[i].slots));
    EXPECT_EQ(layout.groups[i].size, static_cast<std::size_t>(groups[i].size));
  }
  EXPECT_EQ(layout.PlaceOf(TokenKind::kDevice, "device0.here"), 3U);
  EXPECT_THROW(LayoutOfTokens({"ship.time_left", "device0.valid"}), InputError);
}

/// Tokens of a ship next to the device of the tiny farm, and then on it.
TEST(RouteRule, FetchesTheDeviceAndBringsItToAPort) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.view.tokens = true;
  LocalEnvironment environment(std::make_shared<const Scenario>(scenario), {1, kFeaturesBit});
  const RouteRule rule(LayoutOfTokens(environment.spec().feature_names));
  const StepResults* results = &environment.Reset(1);
  std::vector<std::uint8_t> actions(1);
  int steps = 0;
  while (results->end_reasons[0] == 0 && steps < 20) {
    actions[0] = rule.ActionOf(results->features.data(), results->legal[0]);
    results = &environment.Step(actions);
    ++steps;
  }
  EXPECT_EQ(static_cast<EndReason>(results->end_reasons[0]), EndReason::kAllRetrieved);
  EXPECT_EQ(steps, 6);  // two moves, pickup, two moves, drop-off
}

TEST(TokenActorCritic, IsChosenByTheFeatures) {
  EnvironmentSpec spec;
  spec.feature_names = Layout().names;
  spec.feature_count = static_cast<std::int32_t>(Layout().names.size());
  PpoOptions options;
  options.hidden_size = 4;
  EXPECT_NE(dynamic_cast<TokenActorCritic*>(MakeActorCritic(spec, options, 1).get()), nullptr);
  options.recurrent = true;
  EXPECT_THROW(MakeActorCritic(spec, options, 1), InputError);
  options.recurrent = false;
  spec.feature_names.front() = "self.x";
  EXPECT_EQ(dynamic_cast<TokenActorCritic*>(MakeActorCritic(spec, options, 1).get()), nullptr);
}

}  // namespace
}  // namespace aquafarm::agents::test
