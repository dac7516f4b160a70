// SPDX-License-Identifier: BSD-3-Clause
// Values and gradients of the networks that learners update, against libtorch's layers and
// differentiation in double precision.
#include "networks/value_network.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include "agents_fixture.h"
#include "aquafarm/agents/training/algorithms.h"
#include "networks/deep_policy.h"
#include "networks/noise.h"

namespace {
std::atomic<bool> counts{false};
std::atomic<int> allocations{0};
}  // namespace

// Not inlined: GCC would warn of mismatched functions.
__attribute__((noinline)) void* operator new(std::size_t size) {
  if (counts) ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace aquafarm::agents::test {
namespace {

constexpr std::int32_t kFeatures = 5;

EnvironmentSpec SmallSpec() {
  EnvironmentSpec spec;
  spec.feature_count = kFeatures;
  spec.plane_count = 2;
  spec.height = 6;
  spec.width = 7;
  return spec;
}

torch::Tensor ToDouble(std::vector<float> values, const std::vector<std::int64_t>& shape) {
  return torch::from_blob(values.data(), shape).to(torch::kDouble).clone();
}

void ExpectClose(const float* got, const torch::Tensor& expected, const std::string& what) {
  const torch::Tensor wanted = expected.detach().flatten().contiguous();
  const double limit = 1e-5 * (1.0 + wanted.abs().max().item<double>());
  for (std::int64_t i = 0; i < wanted.numel(); ++i) {
    ASSERT_NEAR(static_cast<double>(got[i]), wanted.data_ptr<double>()[i], limit)
        << what << ' ' << i;
  }
}

torch::Tensor GradientOf(const torch::nn::Module& module) {
  std::vector<torch::Tensor> all;
  for (const torch::Tensor& one : module.parameters()) all.push_back(one.grad().flatten());
  return torch::cat(all);
}

// The first `learnt` of `rows` rows are differentiated.
template <typename Make>
void ExpectMlp(const DeepOptions& options, std::size_t rows, std::size_t learnt, const Make& make) {
  const auto module = MakeNetwork(SmallSpec(), options, 3);
  const auto oracle = MakeNetwork(SmallSpec(), options, 3);
  oracle->to(torch::kDouble);
  FlatParameters parameters(*module, torch::kCPU);
  const std::unique_ptr<ValueNetwork<float>> network = make(module, parameters);
  const std::vector<float> seen = Noise(rows * kFeatures, 1);
  const std::vector<float> slopes = Noise(learnt * kActionCount, 2);
  const auto count = static_cast<std::int64_t>(rows);
  const auto learnt_count = static_cast<std::int64_t>(learnt);
  const torch::Tensor expected = oracle->Forward(ToDouble(seen, {count, kFeatures}));
  parameters.values().mutable_grad().fill_(7.0F);  // which must be replaced
  ExpectClose(network->Forward(rows, seen.data()), expected, "value");
  network->Backward(learnt, slopes.data());
  (expected.narrow(0, 0, learnt_count) * ToDouble(slopes, {learnt_count, kActionCount}))
      .sum()
      .backward();
  ExpectClose(parameters.values().grad().data_ptr<float>(), GradientOf(*oracle), "gradient");
}

TEST(ValueNetwork, HasTheValuesAndGradientsOfLibtorch) {
  DeepOptions options;
  for (const bool dueling : {false, true}) {
    for (const std::int32_t hidden : {7, 32}) {
      options.hidden_size = hidden;
      options.dueling = dueling;
      for (const std::size_t rows : {1, 6, 70}) {
        for (const std::size_t learnt : {rows, (rows + 1) / 2}) {
          SCOPED_TRACE(std::to_string(learnt) + " of " + std::to_string(rows) + " rows");
          ExpectMlp(options, rows, learnt, [&](auto module, FlatParameters& parameters) {
            return MakeValueNetwork<float>(SmallSpec(), options, module, parameters, Learns::kYes);
          });
          ExpectMlp(options, rows, learnt, [&](auto module, FlatParameters& parameters) {
            return MakeModuleValues<float>(SmallSpec(), module, parameters, Learns::kYes);
          });
        }
      }
    }
  }
}

struct Sizes {
  std::size_t steps;
  std::size_t rows;
  std::size_t learnt;  // values that are differentiated
};

template <typename Make>
void ExpectLstm(const DeepOptions& options, const Sizes& sizes, const Make& make) {
  SCOPED_TRACE(std::to_string(sizes.learnt) + " of " + std::to_string(sizes.steps) + " × " +
               std::to_string(sizes.rows));
  const std::int64_t hidden = options.hidden_size;
  const auto made = [&] {
    auto module = std::make_shared<RecurrentNetwork>(kFeatures, hidden, options.dueling,
                                                     options.skip_connection);
    DrawWeights(*module, 4, 0);
    return module;
  };
  const auto module = made();
  const auto oracle = made();
  oracle->to(torch::kDouble);
  FlatParameters parameters(*module, torch::kCPU);
  const std::unique_ptr<RecurrentValueNetwork> network = make(module, parameters);
  const auto steps = static_cast<std::int64_t>(sizes.steps);
  const auto rows = static_cast<std::int64_t>(sizes.rows);
  const auto learnt = static_cast<std::int64_t>(sizes.learnt);
  const std::vector<float> seen = Noise(sizes.steps * sizes.rows * kFeatures, 1);
  const std::vector<float> slopes = Noise(sizes.learnt * kActionCount, 2);
  std::vector<float> state = Noise(static_cast<std::size_t>(rows * 2 * hidden), 3);
  const torch::Tensor both = ToDouble(state, {rows, 2, hidden});
  RecurrentNetwork::State expected_state{both.select(1, 0).unsqueeze(0).contiguous(),
                                         both.select(1, 1).unsqueeze(0).contiguous()};
  const torch::Tensor input = ToDouble(seen, {steps, rows, kFeatures});
  {
    const torch::NoGradGuard no_grad;  // a burn-in
    oracle->WarmUp(input, expected_state);
  }
  network->WarmUp(sizes.steps, sizes.rows, seen.data(), state.data());
  const torch::Tensor expected = oracle->Forward(input, expected_state);
  parameters.values().mutable_grad().fill_(7.0F);
  ExpectClose(network->Forward(sizes.steps, sizes.rows, seen.data(), state.data()), expected,
              "value");
  ExpectClose(state.data(), torch::stack({expected_state.first[0], expected_state.second[0]}, 1),
              "state");
  network->Backward(sizes.learnt, slopes.data());
  (expected.view({-1, kActionCount}).narrow(0, 0, learnt) *
   ToDouble(slopes, {learnt, kActionCount}))
      .sum()
      .backward();
  ExpectClose(parameters.values().grad().data_ptr<float>(), GradientOf(*oracle), "gradient");
}

TEST(RecurrentValueNetwork, HasTheValuesAndGradientsOfLibtorch) {
  DeepOptions options;
  for (const bool dueling : {false, true}) {
    for (const bool skip : {false, true}) {
      for (const std::int32_t hidden : {7, 16}) {
        options.dueling = dueling;
        options.skip_connection = skip;
        options.hidden_size = hidden;
        for (const Sizes& sizes : {Sizes{1, 1, 1}, Sizes{1, 6, 3}, Sizes{1, 34, 34},
                                   Sizes{5, 3, 12}, Sizes{5, 3, 15}, Sizes{4, 20, 60}}) {
          ExpectLstm(options, sizes, [&](auto module, FlatParameters& parameters) {
            return MakeRecurrentValueNetwork(SmallSpec(), options, module, parameters,
                                             Learns::kYes);
          });
          ExpectLstm(options, sizes, [&](auto module, FlatParameters& parameters) {
            return MakeModuleValues(SmallSpec(), module, parameters, Learns::kYes);
          });
        }
      }
    }
  }
}

// Allocations of a learner in steps with updates, after its first ones.
int AllocationsOf(const std::string& algorithm, const std::string& more) {
  const std::string text =
      "learning_starts=100 buffer_size=2000 train_interval=1 hidden_size=24 " + more;
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(Share(aquafarm::test::TinyScenario()),
                               {4, entry.observation_types(text), false, 1});
  const auto learner = entry.make(environment.spec(), 3, text);
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  allocations = 0;
  for (int step = 0; step < 120; ++step) {
    counts = step >= 100;
    learner->Step(*results, 0.5, actions);
    counts = false;
    results = &environment.Step(actions);
  }
  return allocations;
}

TEST(ValueNetwork, AnUpdateAllocatesNothing) {
  EXPECT_GT(AllocationsOf("dqn", "network=cnn"), 0) << "by libtorch, so that they are counted";
  EXPECT_EQ(AllocationsOf("dqn", "ema_rate=0.01 action_gap=0.3 dueling=true"), 0);
  EXPECT_EQ(AllocationsOf("vdn", "tau=0.01"), 0);
  EXPECT_EQ(AllocationsOf("lstm_dqn", "ema_rate=0.01 action_gap=0.3"), 0);
  EXPECT_EQ(AllocationsOf("lstm_dqn", "preset=paper"), 0);
}

}  // namespace
}  // namespace aquafarm::agents::test
