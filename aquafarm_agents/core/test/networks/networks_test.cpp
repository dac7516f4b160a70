// SPDX-License-Identifier: BSD-3-Clause
#include "networks/networks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "networks/deep_policy.h"
#include "networks/flat_adam.h"
#include "networks/noise_tensor.h"

namespace aquafarm::agents {
namespace {

EnvironmentSpec SmallSpec() {
  EnvironmentSpec spec;
  spec.feature_count = 5;
  spec.plane_count = 2;
  spec.height = 6;
  spec.width = 7;
  return spec;
}

/// Compares a network's gradient with central differences, in double.
template <typename Loss>
void ExpectGradientsAreDifferences(torch::nn::Module& network, Loss loss) {
  network.to(torch::kDouble);
  loss().backward();
  constexpr double kStep = 1e-6;
  for (auto& item : network.named_parameters()) {
    const torch::NoGradGuard no_grad;
    double* const weights = item.value().data_ptr<double>();
    const double* const gradient = item.value().grad().data_ptr<double>();
    for (std::int64_t i = 0; i < item.value().numel(); i += 7) {
      const double weight = weights[i];
      weights[i] = weight + kStep;
      const double above = loss().template item<double>();
      weights[i] = weight - kStep;
      const double below = loss().template item<double>();
      weights[i] = weight;
      EXPECT_NEAR(gradient[i], (above - below) / (2.0 * kStep), 1e-6) << item.key() << ' ' << i;
    }
  }
}

TEST(Networks, GradientsOfEveryKindAreDifferences) {
  for (const NetworkKind kind : {NetworkKind::kMlp, NetworkKind::kCnn}) {
    for (const bool dueling : {false, true}) {
      DeepOptions options;
      options.network = kind;
      options.hidden_size = 8;
      options.dueling = dueling;
      const auto network = MakeNetwork(SmallSpec(), options, 3);
      const torch::Tensor input =
          (kind == NetworkKind::kMlp ? NoiseTensor({3, 5}, 1) : NoiseTensor({3, 2, 6, 7}, 1))
              .to(torch::kDouble);
      ExpectGradientsAreDifferences(*network,
                                    [&] { return network->Forward(input).square().sum(); });
    }
  }
}

// Scalar implementation of the LSTM equations (Hochreiter and Schmidhuber 1997, with forget gates;
// gates in PyTorch's order i, f, g, o), with the layers before and after the LSTM.
std::vector<double> RecurrentByHand(const std::vector<float>& weights,
                                    const std::vector<std::vector<float>>& input,
                                    std::size_t hidden) {
  const std::size_t features = input[0].size();
  const float* w = weights.data();
  const auto take = [&w](std::size_t size) {
    const float* begin = w;
    w += size;
    return begin;
  };
  const float* in_w = take(hidden * features);
  const float* in_b = take(hidden);
  const float* ih = take(4 * hidden * hidden);
  const float* hh = take(4 * hidden * hidden);
  const float* ih_b = take(4 * hidden);
  const float* hh_b = take(4 * hidden);
  const float* second_w = take(4 * hidden * hidden);
  const float* second_b = take(2 * hidden);
  const float* head_w = take(kActionCount * 2 * hidden);
  const float* head_b = take(kActionCount);
  const auto layer = [](const float* matrix, const float* bias, const std::vector<double>& x,
                        std::size_t rows) {
    std::vector<double> y(rows);
    for (std::size_t r = 0; r < rows; ++r) {
      y[r] = static_cast<double>(bias[r]);
      for (std::size_t c = 0; c < x.size(); ++c) {
        y[r] += static_cast<double>(matrix[r * x.size() + c]) * x[c];
      }
    }
    return y;
  };
  const auto sigmoid = [](double x) { return 1.0 / (1.0 + std::exp(-x)); };
  std::vector<double> h(hidden);
  std::vector<double> c(hidden);
  std::vector<double> values;
  for (const std::vector<float>& step : input) {
    std::vector<double> x = layer(in_w, in_b, {step.begin(), step.end()}, hidden);
    for (double& one : x) one = std::max(0.0, one);
    const std::vector<double> from_input = layer(ih, ih_b, x, 4 * hidden);
    const std::vector<double> from_state = layer(hh, hh_b, h, 4 * hidden);
    for (std::size_t k = 0; k < hidden; ++k) {
      const auto gate = [&](std::size_t g) {
        return from_input[g * hidden + k] + from_state[g * hidden + k];
      };
      c[k] = sigmoid(gate(1)) * c[k] + sigmoid(gate(0)) * std::tanh(gate(2));
      h[k] = sigmoid(gate(3)) * std::tanh(c[k]);
    }
    std::vector<double> both = h;
    both.insert(both.end(), x.begin(), x.end());
    std::vector<double> second = layer(second_w, second_b, both, 2 * hidden);
    for (double& one : second) one = std::max(0.0, one);
    values = layer(head_w, head_b, second, kActionCount);
  }
  return values;
}

TEST(RecurrentNetwork, IsTheLstmOfItsEquations) {
  constexpr std::int64_t kSteps = 7;
  RecurrentNetwork network(5, 6, false);
  DrawWeights(network, 4, 0);
  FlatParameters parameters(network, torch::kCPU);
  const torch::Tensor input = NoiseTensor({kSteps, 1, 5}, 2);
  std::vector<std::vector<float>> rows;
  for (std::int64_t t = 0; t < kSteps; ++t) {
    const float* row = input.data_ptr<float>() + t * 5;
    rows.emplace_back(row, row + 5);
  }
  RecurrentNetwork::State state{torch::zeros({1, 1, 6}), torch::zeros({1, 1, 6})};
  const torch::Tensor values = network.Forward(input, state)[kSteps - 1][0];
  const std::vector<double> expected = RecurrentByHand(parameters.ToVector(), rows, 6);
  for (std::size_t a = 0; a < kActionCount; ++a) {
    EXPECT_NEAR(values[static_cast<std::int64_t>(a)].item<double>(), expected[a], 1e-5);
  }
}

TEST(RecurrentNetwork, StepByStepIsTheSameAsAtOnce) {
  RecurrentNetwork network(5, 6, true);
  DrawWeights(network, 4, 0);
  const torch::NoGradGuard no_grad;
  const torch::Tensor input = NoiseTensor({6, 3, 5}, 3);
  RecurrentNetwork::State at_once{torch::zeros({1, 3, 6}), torch::zeros({1, 3, 6})};
  RecurrentNetwork::State step_by_step = at_once;
  const torch::Tensor expected = network.Forward(input, at_once);
  network.WarmUp(input.narrow(0, 0, 2), step_by_step);
  for (std::int64_t t = 2; t < 6; ++t) {
    const torch::Tensor got = network.Forward(input.narrow(0, t, 1), step_by_step);
    EXPECT_TRUE(torch::allclose(got[0], expected[t], 1e-5, 1e-6)) << "step " << t;
  }
  EXPECT_TRUE(torch::allclose(step_by_step.first, at_once.first, 1e-5, 1e-6));
}

TEST(RecurrentNetwork, GradientsAreDifferences) {
  RecurrentNetwork network(5, 6, true);
  DrawWeights(network, 4, 0);
  const torch::Tensor input = NoiseTensor({4, 2, 5}, 3).to(torch::kDouble);
  const torch::Tensor empty = torch::zeros({1, 2, 6}, torch::kDouble);
  ExpectGradientsAreDifferences(network, [&] {
    RecurrentNetwork::State state{empty, empty};
    return network.Forward(input, state).square().sum();
  });
}

// Same values as `wave` of references/networks.py.
torch::Tensor Wave(std::vector<std::int64_t> shape, double step) {
  torch::Tensor tensor = torch::empty(shape, torch::kDouble);
  for (std::int64_t i = 0; i < tensor.numel(); ++i) {
    tensor.data_ptr<double>()[i] = 0.4 * std::sin(1.0 + step * static_cast<double>(i));
  }
  return tensor;
}

// Sets the weights to a wave and returns the gradients as one vector.
template <typename Loss>
torch::Tensor GradientAtAWave(torch::nn::Module& network, Loss loss) {
  network.to(torch::kDouble);
  FlatParameters parameters(network, torch::kCPU);
  {
    const torch::NoGradGuard no_grad;
    parameters.values().copy_(Wave({parameters.size()}, 0.7));
  }
  loss().backward();
  return parameters.values().grad();
}

TEST(Networks, HaveTheValuesAndGradientsOfTheStoredReference) {
  std::ifstream file(std::string(AQUAFARM_CORE_DIR) + "/test/references/networks.json");
  const nlohmann::json stored = nlohmann::json::parse(file);
  const auto features = stored.at("features").get<std::int64_t>();
  const auto hidden = stored.at("hidden").get<std::int64_t>();
  const auto steps = stored.at("steps").get<std::int64_t>();
  const auto batch = stored.at("batch").get<std::int64_t>();
  const auto stride = stored.at("stride").get<std::int64_t>();
  for (const nlohmann::json& reference : stored.at("references")) {
    const auto name = reference.at("network").get<std::string>();
    const bool dueling = reference.at("dueling").get<bool>();
    SCOPED_TRACE(name + (dueling ? ", dueling" : ""));
    torch::Tensor values;
    torch::Tensor gradient;
    if (name == "mlp") {
      EnvironmentSpec spec;
      spec.feature_count = static_cast<std::int32_t>(features);
      DeepOptions options;
      options.hidden_size = static_cast<std::int32_t>(hidden);
      options.dueling = dueling;
      const auto network = MakeNetwork(spec, options, 3);
      gradient = GradientAtAWave(*network, [&] {
        values = network->Forward(Wave({batch, features}, 0.9));
        return values.square().sum();
      });
    } else {
      ASSERT_EQ(name, "lstm");
      RecurrentNetwork network(features, hidden, dueling);
      gradient = GradientAtAWave(network, [&] {
        const torch::Tensor empty = torch::zeros({1, batch, hidden}, torch::kDouble);
        RecurrentNetwork::State state{empty, empty};
        values = network.Forward(Wave({steps, batch, features}, 0.9), state);
        return values.square().sum();
      });
    }
    ASSERT_EQ(gradient.numel(), reference.at("weights").get<std::int64_t>());
    EXPECT_NEAR(values.square().sum().item<double>(), reference.at("loss").get<double>(), 1e-10);
    const torch::Tensor last = values.detach().reshape({-1, kActionCount})[-1];
    for (std::int64_t a = 0; a < kActionCount; ++a) {
      EXPECT_NEAR(last[a].item<double>(),
                  reference.at("last_values").at(static_cast<std::size_t>(a)).get<double>(), 1e-12);
    }
    std::int64_t at = 0;
    for (const nlohmann::json& slope : reference.at("gradient")) {
      EXPECT_NEAR(gradient[at].item<double>(), slope.get<double>(), 1e-10) << "weight " << at;
      at += stride;
    }
    EXPECT_GE(at, gradient.numel()) << "the reference ends early";
  }
}

TEST(FlatParameters, GatherTheGradients) {
  const auto network = MakeNetwork(SmallSpec(), {}, 3);
  const auto apart = MakeNetwork(SmallSpec(), {}, 3);
  FlatParameters parameters(*network, torch::kCPU);
  const torch::Tensor input = NoiseTensor({4, 5}, 1);
  for (int twice = 0; twice < 2; ++twice) {
    parameters.values().grad().zero_();
    network->Forward(input).square().sum().backward();
  }
  apart->Forward(input).square().sum().backward();
  std::vector<torch::Tensor> gradients;
  for (const torch::Tensor& one : apart->parameters()) gradients.push_back(one.grad().flatten());
  EXPECT_TRUE(torch::allclose(parameters.values().grad(), torch::cat(gradients)));
}

TEST(FlatParameters, AreTheNetworksOwn) {
  const auto network = MakeNetwork(SmallSpec(), {}, 3);
  const auto same = MakeNetwork(SmallSpec(), {}, 3);
  const auto other = MakeNetwork(SmallSpec(), {}, 4);
  const FlatParameters parameters(*network, torch::kCPU);
  FlatParameters of_same(*same, torch::kCPU);
  FlatParameters of_other(*other, torch::kCPU);
  EXPECT_EQ(parameters.ToVector(), of_same.ToVector()) << "the seed gives the weights";
  EXPECT_NE(parameters.ToVector(), of_other.ToVector());
  of_other.FromVector(parameters.ToVector());
  const torch::Tensor input = NoiseTensor({2, 5}, 1);
  EXPECT_TRUE(torch::equal(network->Forward(input), other->Forward(input)));
}

TEST(FlatAdam, SkipsNonFiniteGradients) {
  const auto network = MakeNetwork(SmallSpec(), {}, 3);
  FlatAdam adam(*network, torch::kCPU);
  const std::vector<float> before = adam.parameters().ToVector();
  for (const double limit : {0.0, 10.0}) {
    const torch::Tensor zero = adam.parameters().values().sum() * 0.0;
    EXPECT_FALSE(adam.Step(zero.sqrt(), 0.01, limit)) << "a loss of 0, which has no slope";
    EXPECT_EQ(adam.parameters().ToVector(), before);
  }
  EXPECT_TRUE(adam.Step(adam.parameters().values().square().sum(), 0.01, 0.0));
  EXPECT_NE(adam.parameters().ToVector(), before);
}

TEST(DrawWeights, KeepsToPyTorchsLimits) {
  DeepOptions options;
  options.hidden_size = 128;
  const auto network = MakeNetwork(SmallSpec(), options, 3);
  for (const auto& item : network->named_parameters()) {
    const std::int64_t fan_in = item.key().rfind("first", 0) == 0 ? 5 : 128;
    const double limit = 1.0 / std::sqrt(static_cast<double>(fan_in));
    EXPECT_LE(item.value().abs().max().item<double>(), limit) << item.key();
    if (item.value().numel() > 100) {
      EXPECT_GT(item.value().abs().max().item<double>(), 0.9 * limit) << item.key();
    }
  }
}

TEST(Allowed, LeavesMovesIntoOpenWaterOrAllWhereThereIsNone) {
  DeepOptions options;
  options.mask_blocked = true;
  std::vector<float> features(kFirstBlockedFeature + kMoveCount, 0.0F);
  float* const blocked = features.data() + kFirstBlockedFeature;
  const ActionMask legal = kMoveMask | MaskOf(Action::kDropOff);
  EXPECT_EQ(LegalMask(legal, features.data(), options), legal);
  blocked[static_cast<int>(Action::kWest)] = 1.0F;
  EXPECT_EQ(LegalMask(legal, features.data(), options), legal & ~MaskOf(Action::kWest));
  options.mask_illegal = false;
  EXPECT_EQ(LegalMask(legal, features.data(), options), kAllActions & ~MaskOf(Action::kWest));
  std::fill_n(blocked, kMoveCount, 1.0F);
  EXPECT_EQ(LegalMask(legal, features.data(), options), kAllActions);
  options.mask_illegal = true;
  EXPECT_EQ(LegalMask(legal, features.data(), options), legal);
}

TEST(AdvantageGap, IsOfTheBestActionThatIsAllowed) {
  const std::vector<float> first{1, 2, 9, 3, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(AdvantageGap(first.data(), kAllActions & ~(1U << 2U), 1), 3.0F - 2.0F);
  const std::vector<float> second{5, 4, -7, 0, 0, 0, 0, 0, 0, 6};
  EXPECT_EQ(AdvantageGap(second.data(), kAllActions, 2), 6.0F + 7.0F);
}

TEST(FindDevice, RefusesCudaWhereThereIsNone) {
  EXPECT_TRUE(FindDevice("cpu").is_cpu());
  if (torch::cuda::is_available()) {
    EXPECT_TRUE(FindDevice("cuda").is_cuda());
    EXPECT_TRUE(FindDevice("auto").is_cuda());
  } else {
    EXPECT_THROW(FindDevice("cuda"), InputError);
    EXPECT_TRUE(FindDevice("auto").is_cpu());
  }
}

}  // namespace
}  // namespace aquafarm::agents
