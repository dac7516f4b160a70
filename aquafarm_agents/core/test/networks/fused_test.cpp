// SPDX-License-Identifier: BSD-3-Clause
// The fused layers against libtorch's own layers and differentiation in double precision.
#include "networks/fused.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "aquafarm/base/check.h"
#include "networks/networks.h"
#include "networks/noise_tensor.h"

namespace aquafarm::agents {
namespace {

constexpr std::int64_t kFeatures = 5;
constexpr std::int64_t kHidden = 7;  // not a multiple of the SIMD width
constexpr std::int64_t kRows = 4;

torch::Tensor Leaf(const torch::Tensor& values, torch::Dtype type) {
  return values.detach().to(type).clone().set_requires_grad(true);
}

void ExpectClose(const torch::Tensor& got, const torch::Tensor& expected, const std::string& what) {
  ASSERT_TRUE(got.defined()) << what;
  ASSERT_EQ(got.scalar_type(), torch::kFloat) << what << " was not computed by the fused layer";
  ASSERT_EQ(got.sizes(), expected.sizes()) << what;
  const double error = (got.to(torch::kDouble) - expected).abs().max().item<double>();
  EXPECT_LT(error, 1e-5 * (1.0 + expected.abs().max().item<double>())) << what;
}

void ExpectSameGradients(torch::nn::Module& fused, torch::nn::Module& expected) {
  const auto wanted = expected.named_parameters();
  for (const auto& item : fused.named_parameters()) {
    ExpectClose(item.value().grad(), wanted[item.key()].grad(), item.key());
  }
}

class FusedMlpTest : public ::testing::TestWithParam<bool> {};

TEST_P(FusedMlpTest, HasTheValuesAndGradientsOfLibtorch) {
  EnvironmentSpec spec;
  spec.feature_count = kFeatures;
  DeepOptions options;
  options.hidden_size = kHidden;
  options.dueling = GetParam();
  const auto fused = MakeNetwork(spec, options, 3);
  const auto expected = MakeNetwork(spec, options, 3);
  expected->to(torch::kDouble);
  const torch::Tensor seen = NoiseTensor({2, kRows, kFeatures}, 1);  // with a leading dimension
  const torch::Tensor slopes = NoiseTensor({2, kRows, kActionCount}, 2);
  const torch::Tensor input = Leaf(seen, torch::kFloat);
  const torch::Tensor input_twin = Leaf(seen, torch::kDouble);
  const torch::Tensor values = fused->Forward(input);
  const torch::Tensor twins = expected->Forward(input_twin);
  ExpectClose(values, twins, "values");
  (values.square() * slopes).sum().backward();
  (twins.square() * slopes.to(torch::kDouble)).sum().backward();
  ExpectSameGradients(*fused, *expected);
  ExpectClose(input.grad(), input_twin.grad(), "input");
  const torch::NoGradGuard no_grad;
  EXPECT_TRUE(torch::equal(fused->Forward(input), values));
}

INSTANTIATE_TEST_SUITE_P(Networks, FusedMlpTest, ::testing::Bool());

// All values and gradients of an LSTM, whose loss reads each step and the state after the last.
std::vector<torch::Tensor> EvaluateLstm(RecurrentNetwork& network, std::int64_t steps,
                                        torch::Dtype type) {
  const torch::Tensor input = Leaf(NoiseTensor({steps, kRows, kFeatures}, 1), type);
  const torch::Tensor hidden = Leaf(NoiseTensor({1, kRows, kHidden}, 2), type);
  const torch::Tensor cell = Leaf(NoiseTensor({1, kRows, kHidden}, 3), type);
  RecurrentNetwork::State state{hidden, cell};
  const torch::Tensor values = network.Forward(input, state);
  const torch::Tensor slopes = NoiseTensor({steps, kRows, kActionCount}, 4).to(type);
  const torch::Tensor loss = (values.square() * slopes).sum() + state.first.square().sum() +
                             0.3 * state.second.pow(3).sum();
  loss.backward();
  return {values.detach(), state.first.detach(), state.second.detach(),
          input.grad(),    hidden.grad(),        cell.grad()};
}

TEST(FusedLstm, HasTheValuesAndGradientsOfLibtorch) {
  for (const std::int64_t steps : {1, 6}) {
    for (const bool skip : {false, true}) {
      RecurrentNetwork fused(kFeatures, kHidden, true, skip);
      RecurrentNetwork expected(kFeatures, kHidden, true, skip);
      DrawWeights(fused, 4, 0);
      DrawWeights(expected, 4, 0);
      expected.to(torch::kDouble);
      const auto got = EvaluateLstm(fused, steps, torch::kFloat);
      const auto wanted = EvaluateLstm(expected, steps, torch::kDouble);
      const char* const names[] = {"values",         "h after",  "c after",
                                   "input gradient", "h before", "c before"};
      for (std::size_t i = 0; i < got.size(); ++i) ExpectClose(got[i], wanted[i], names[i]);
      ExpectSameGradients(fused, expected);
    }
  }
}

TEST(FusedLstm, WithoutAGradientItHasTheSameValues) {
  RecurrentNetwork network(kFeatures, kHidden, true);
  DrawWeights(network, 4, 0);
  const torch::Tensor input = NoiseTensor({6, kRows, kFeatures}, 1);
  RecurrentNetwork::State state{NoiseTensor({1, kRows, kHidden}, 2),
                                NoiseTensor({1, kRows, kHidden}, 3)};
  RecurrentNetwork::State twin = state;
  const torch::Tensor values = network.Forward(input, state);
  const torch::NoGradGuard no_grad;
  EXPECT_TRUE(torch::equal(network.Forward(input, twin), values));
  EXPECT_TRUE(torch::equal(twin.first, state.first));
  EXPECT_TRUE(torch::equal(twin.second, state.second));
}

TEST(FusedLstm, AStateOfOtherRowsIsRefused) {
  RecurrentNetwork network(kFeatures, kHidden, true);
  DrawWeights(network, 4, 0);
  RecurrentNetwork::State state{torch::zeros({1, kRows - 1, kHidden}),
                                torch::zeros({1, kRows, kHidden})};
  EXPECT_THROW(network.Forward(NoiseTensor({6, kRows, kFeatures}, 1), state), LogicError);
}

// The loss reads the state only, so the outputs have no gradient.
TEST(FusedLstm, ALossOfTheStateAloneHasAGradient) {
  RecurrentNetwork fused(kFeatures, kHidden, true);
  RecurrentNetwork expected(kFeatures, kHidden, true);
  DrawWeights(fused, 4, 0);
  DrawWeights(expected, 4, 0);
  expected.to(torch::kDouble);
  const auto slope_of = [](RecurrentNetwork& network, torch::Dtype type) {
    RecurrentNetwork::State state{torch::zeros({1, kRows, kHidden}, type),
                                  torch::zeros({1, kRows, kHidden}, type)};
    const torch::Tensor input = Leaf(NoiseTensor({3, kRows, kFeatures}, 1), type);
    network.WarmUp(input, state);
    state.second.square().sum().backward();
    return input.grad();
  };
  ExpectClose(slope_of(fused, torch::kFloat), slope_of(expected, torch::kDouble), "input");
}

}  // namespace
}  // namespace aquafarm::agents
