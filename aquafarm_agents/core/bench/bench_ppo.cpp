// SPDX-License-Identifier: BSD-3-Clause
// Farm steps a second of PPO in training on paper.yaml (81 features), 256 farms, one thread,
// rollouts of 16,384 steps, minibatches of 2,048, two epochs: feed-forward with 2 x 128 units and
// recurrent with an LSTM of 128. tools/bench_ppo.py measures the references.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "metric_reporter.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kFarms = 256;
constexpr int kStepsPerRollout = 64;

// One learner for all repetitions, past its first update.
struct Training {
  explicit Training(const std::string& options)
      : environment(
            std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml")),
            {kFarms, PpoEncodings(options), false, 1}),
        learner(MakePpo(environment.spec(), 1, options)),
        results(&environment.Reset(1)) {
    Rollout();
  }
  void Rollout() {
    for (int i = 0; i < kStepsPerRollout; ++i) {
      learner->Step(*results, 0.3, actions);
      results = &environment.Step(actions);
    }
  }
  LocalEnvironment environment;
  std::unique_ptr<Learner> learner;
  const StepResults* results;
  std::vector<std::uint8_t> actions;
};

void Train(benchmark::State& state, Training& training) {
  for (auto _ : state) training.Rollout();
  state.SetItemsProcessed(state.iterations() * kFarms * kStepsPerRollout);
}

void Ppo(benchmark::State& state) {
  static Training training("batch_size=2048");
  Train(state, training);
}
void RecurrentPpo(benchmark::State& state) {
  static Training training("batch_size=2048 recurrent=true");
  Train(state, training);
}

BENCHMARK(Ppo)->Unit(benchmark::kMillisecond);
BENCHMARK(RecurrentPpo)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  aquafarm::bench::PrintMetric("ppo_training_steps", reporter.median("Ppo"), "steps/s");
  aquafarm::bench::PrintMetric("recurrent_ppo_training_steps", reporter.median("RecurrentPpo"),
                               "steps/s");
  return 0;
}
