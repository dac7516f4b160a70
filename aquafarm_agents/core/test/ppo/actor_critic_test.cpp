// SPDX-License-Identifier: BSD-3-Clause
// Compares outputs and gradients of both networks with plain loops and complex-step derivatives
// (Squire and Trapp 1998), which use no back-propagation.
#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/base/rng.h"
#include "ppo/central_actor_critic.h"
#include "ppo/complex_step.h"
#include "ppo/make_actor_critic.h"
#include "ppo/ppo_loss.h"

namespace aquafarm::agents::test {
namespace {

constexpr std::size_t kFeatures = 5;
constexpr std::size_t kHidden = 6;

Complex Sigmoid(Complex x) { return 1.0 / (1.0 + std::exp(-x)); }

/// Reads layers from a flat parameter vector in order.
class Layers {
 public:
  explicit Layers(const Vector& weights) : next_(weights.data()) {}
  /// out = in · W (+ b)
  Vector Apply(const Vector& in, std::size_t outputs, bool has_bias = true) {
    Vector out(outputs);
    for (std::size_t i = 0; i < in.size(); ++i) {
      for (std::size_t o = 0; o < outputs; ++o) out[o] += in[i] * next_[i * outputs + o];
    }
    next_ += in.size() * outputs;
    if (!has_bias) return out;
    for (std::size_t o = 0; o < outputs; ++o) out[o] += next_[o];
    next_ += outputs;
    return out;
  }

 private:
  const Complex* next_;
};

Vector ReluOf(Vector values) {
  for (Complex& value : values) value = Relu(value);
  return values;
}

Vector FeedForwardOutputs(const Vector& weights, const Vector& features) {
  Layers layers(weights);
  const Vector first = ReluOf(layers.Apply(features, kHidden));
  const Vector second = ReluOf(layers.Apply(first, kHidden));
  return layers.Apply(second, kActorCriticOutputs);
}

/// Updates h and c.
Vector LstmOutputs(const Vector& weights, const Vector& features, Vector& h, Vector& c) {
  Layers layers(weights);
  const Vector seen = ReluOf(layers.Apply(features, kHidden));
  Vector gates = layers.Apply(seen, 4 * kHidden);
  const Vector recurrent = layers.Apply(h, 4 * kHidden, /*has_bias=*/false);
  Vector joined;
  for (std::size_t i = 0; i < gates.size(); ++i) gates[i] += recurrent[i];
  for (std::size_t i = 0; i < kHidden; ++i) {
    c[i] =
        Sigmoid(gates[kHidden + i]) * c[i] + Sigmoid(gates[i]) * std::tanh(gates[2 * kHidden + i]);
    h[i] = Sigmoid(gates[3 * kHidden + i]) * std::tanh(c[i]);
  }
  joined = h;
  joined.insert(joined.end(), seen.begin(), seen.end());
  return layers.Apply(joined, kActorCriticOutputs);
}

struct Batch {
  std::size_t steps{};
  std::size_t sequences{};
  std::vector<float> features;
  std::vector<float> state;
  std::vector<std::uint8_t> is_first;
  std::vector<float> slopes;  // the loss is Σ slopes · outputs
  SequenceRows rows() const {
    return {steps, sequences, features.data(), state.data(), is_first.data()};
  }
};

Batch MakeBatch(std::size_t steps, std::size_t sequences, std::size_t state_size) {
  RandomStream rng({5, 0, RngStream::kLearner, 0});
  Batch batch{steps, sequences, {}, {}, {}, {}};
  const auto fill = [&](std::vector<float>& values, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) values.push_back(rng.Uniform(-1.0F, 1.0F));
  };
  fill(batch.features, steps * sequences * kFeatures);
  fill(batch.state, sequences * state_size);
  fill(batch.slopes, steps * sequences * kActorCriticOutputs);
  batch.is_first.resize(steps * sequences);
  if (steps > 3) batch.is_first[2 * sequences] = 1;  // an episode starts in sequence 0
  return batch;
}

Complex DefinedLoss(const Vector& weights, const Batch& batch, bool recurrent,
                    std::vector<double>* outputs = nullptr) {
  Complex loss = 0.0;
  if (outputs != nullptr) outputs->resize(batch.slopes.size());
  for (std::size_t s = 0; s < batch.sequences; ++s) {
    Vector h(kHidden);
    Vector c(kHidden);
    for (std::size_t i = 0; recurrent && i < kHidden; ++i) {
      h[i] = static_cast<double>(batch.state[s * 2 * kHidden + i]);
      c[i] = static_cast<double>(batch.state[s * 2 * kHidden + kHidden + i]);
    }
    for (std::size_t t = 0; t < batch.steps; ++t) {
      const std::size_t row = t * batch.sequences + s;
      if (batch.is_first[row] != 0) {
        h.assign(kHidden, 0.0);
        c.assign(kHidden, 0.0);
      }
      const auto* const seen = batch.features.data() + row * kFeatures;
      const Vector features(seen, seen + kFeatures);
      const Vector out =
          recurrent ? LstmOutputs(weights, features, h, c) : FeedForwardOutputs(weights, features);
      for (std::size_t i = 0; i < kActorCriticOutputs; ++i) {
        loss += out[i] * static_cast<double>(batch.slopes[row * kActorCriticOutputs + i]);
        if (outputs != nullptr) (*outputs)[row * kActorCriticOutputs + i] = out[i].real();
      }
    }
  }
  return loss;
}

void ExpectAgrees(bool recurrent, std::size_t steps, std::size_t sequences) {
  const auto network = MakeActorCritic(kFeatures, kHidden, recurrent, {9});
  for (float& weight : network->weights()) weight *= 3.0F;  // so that the gates saturate
  const Batch batch = MakeBatch(steps, sequences, network->state_size());
  Vector weights(network->weights().begin(), network->weights().end());
  const float* const outputs = network->Forward(batch.rows(), nullptr);
  std::vector<double> expected;
  DefinedLoss(weights, batch, recurrent, &expected);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(outputs[i]), expected[i], 1e-4) << "output " << i;
  }
  network->Backward(batch.rows(), batch.slopes.data());
  constexpr double kTiny = 1e-30;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Complex kept = weights[k];
    weights[k] += Complex(0.0, kTiny);
    const double slope = DefinedLoss(weights, batch, recurrent).imag() / kTiny;
    weights[k] = kept;
    ASSERT_NEAR(static_cast<double>(network->gradient()[k]), slope, 2e-4 * (1.0 + std::abs(slope)))
        << "weight " << k << " of " << weights.size();
  }
}

TEST(FeedForward, OutputsAndGradientEqualTheDefinition) { ExpectAgrees(false, 1, 7); }

TEST(Lstm, OutputsAndGradientThroughTimeEqualTheDefinition) { ExpectAgrees(true, 5, 3); }

TEST(ActorCritic, GradientsAddUpOverChunks) {
  for (const bool recurrent : {false, true}) {
    const auto network = MakeActorCritic(kFeatures, kHidden, recurrent, {9});
    const Batch batch = MakeBatch(1, 4, network->state_size());
    network->Forward(batch.rows(), nullptr);
    network->Backward(batch.rows(), batch.slopes.data());
    const std::vector<float> once = network->gradient();
    network->Forward(batch.rows(), nullptr);
    network->Backward(batch.rows(), batch.slopes.data());
    for (std::size_t i = 0; i < once.size(); ++i) {
      EXPECT_NEAR(network->gradient()[i], 2.0F * once[i], 1e-5F) << i;
    }
  }
}

// The observations of three agents as `joint`.
Batch WithJoint(const Batch& batch, std::size_t agents) {
  RandomStream rng({6, 0, RngStream::kLearner, 0});
  Batch joint = batch;
  joint.features.clear();
  for (std::size_t i = 0; i < batch.features.size() * agents; ++i) {
    joint.features.push_back(rng.Uniform(-1.0F, 1.0F));
  }
  return joint;
}

/// State of the policy (first half) or of the critic (second half) of each sequence.
std::vector<float> HalfOf(const std::vector<float>& state, std::size_t sequences, bool second) {
  const std::size_t size = state.size() / sequences / 2;
  std::vector<float> half;
  for (std::size_t s = 0; s < sequences; ++s) {
    const auto begin = state.begin() + static_cast<std::ptrdiff_t>((2 * s + second) * size);
    half.insert(half.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
  }
  return half;
}

/// Network `part` of a central network on its own: 0 is the policy, 1 the critic.
void ExpectPartAgrees(ActorCritic& central, const Batch& batch, const Batch& joint, bool recurrent,
                      bool is_critic) {
  constexpr std::size_t kAgents = 3;
  const auto own =
      MakeActorCritic(is_critic ? kFeatures * kAgents : kFeatures, kHidden, recurrent, {1});
  const std::size_t begin = is_critic ? central.policy_size() : 0;
  ASSERT_LE(begin + own->weights().size(), central.weights().size());
  std::copy_n(central.weights().begin() + static_cast<std::ptrdiff_t>(begin), own->weights().size(),
              own->weights().begin());
  Batch part = is_critic ? joint : batch;
  part.state = HalfOf(batch.state, batch.sequences, is_critic);
  std::vector<float> state(part.state.size());
  const float* const expected = own->Forward(part.rows(), recurrent ? state.data() : nullptr);

  SequenceRows rows = batch.rows();
  rows.joint = joint.features.data();
  std::vector<float> both(batch.state.size());
  const float* const outputs = central.Forward(rows, recurrent ? both.data() : nullptr);
  const auto belongs = [&](std::size_t i) {
    return (i % kActorCriticOutputs == kActionCount) == is_critic;
  };
  for (std::size_t i = 0; i < batch.slopes.size(); ++i) {
    if (!belongs(i)) {
      part.slopes[i] = 0.0F;
      continue;
    }
    ASSERT_EQ(outputs[i], expected[i]) << i;
  }
  EXPECT_EQ(HalfOf(both, batch.sequences, is_critic), state);

  own->Backward(part.rows(), part.slopes.data());
  std::fill(central.gradient().begin(), central.gradient().end(), 0.0F);
  central.Backward(rows, batch.slopes.data());
  for (std::size_t i = 0; i < own->gradient().size(); ++i) {
    ASSERT_EQ(central.gradient()[begin + i], own->gradient()[i]) << i;
  }
}

// The parts alone are compared with the definition above.
TEST(Central, LogitsAreThoseOfThePolicyAndTheValueThatOfTheCritic) {
  for (const bool recurrent : {false, true}) {
    const auto made = MakeCentralActorCritic(kFeatures, 3, kHidden, recurrent, 9);
    ActorCritic& central = *made;
    EXPECT_EQ(central.joint_agents(), 3U);
    EXPECT_NE(central.weights()[0], central.weights()[central.policy_size()]);
    const Batch batch = MakeBatch(recurrent ? 5 : 1, 4, central.state_size());
    const Batch joint = WithJoint(batch, 3);
    ExpectPartAgrees(central, batch, joint, recurrent, /*is_critic=*/false);
    ExpectPartAgrees(central, batch, joint, recurrent, /*is_critic=*/true);
  }
}

TEST(Central, AnAgentsOwnObservationComesFirst) {
  const std::vector<float> farm{1, 2, 3, 4, 5, 6};
  std::vector<float> joint(6);
  JoinObservations(farm.data(), 3, 2, 0, joint.data());
  EXPECT_EQ(joint, farm);
  JoinObservations(farm.data(), 3, 2, 1, joint.data());
  EXPECT_EQ(joint, (std::vector<float>{3, 4, 1, 2, 5, 6}));
  JoinObservations(farm.data(), 3, 2, 2, joint.data());
  EXPECT_EQ(joint, (std::vector<float>{5, 6, 1, 2, 3, 4}));
}

TEST(Lstm, StepByStepEqualsTheWholeSequence) {
  const auto network = MakeActorCritic(kFeatures, kHidden, true, {9});
  const Batch batch = MakeBatch(5, 3, network->state_size());
  const float* whole = network->Forward(batch.rows(), nullptr);
  const std::vector<float> expected(whole, whole + batch.slopes.size());
  std::vector<float> state = batch.state;
  for (std::size_t t = 0; t < batch.steps; ++t) {
    const std::size_t row = t * batch.sequences;
    const std::vector<float> before = state;
    const SequenceRows rows{1, batch.sequences, batch.features.data() + row * kFeatures,
                            before.data(), batch.is_first.data() + row};
    const float* const outputs = network->Forward(rows, state.data());
    for (std::size_t i = 0; i < batch.sequences * kActorCriticOutputs; ++i) {
      ASSERT_NEAR(outputs[i], expected[row * kActorCriticOutputs + i], 1e-5F) << "step " << t;
    }
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
