// SPDX-License-Identifier: BSD-3-Clause
// Measures farm steps per second of PPO in training on paper.yaml (81 features) with 256 farms, one
// thread, rollouts of 16,384 steps, minibatches of 2,048 and two epochs. The network is
// feed-forward with 2 x 128 units, or recurrent with an LSTM of 128 units. tools/bench_ppo.py
// measures other implementations of PPO for comparison.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "aquafarm/scenario/scenario_yaml.h"
#include "metric_reporter.h"
#include "training_loop.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kFarms = 256;
constexpr int kStepsPerRollout = 64;

void Train(benchmark::State& state, TrainingLoop& training) {
  for (auto _ : state) training.Run(kStepsPerRollout);
  state.SetItemsProcessed(state.iterations() * kFarms * kStepsPerRollout);
}

std::shared_ptr<const Scenario> Paper() {
  return std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml"));
}

// All repetitions of a benchmark share one learner. Its first rollout is full at the start, so that
// each iteration begins with an update.
void Ppo(benchmark::State& state) {
  static TrainingLoop training("ppo", "batch_size=2048", Paper(), kFarms, kStepsPerRollout);
  Train(state, training);
}
void RecurrentPpo(benchmark::State& state) {
  static TrainingLoop training("ppo", "batch_size=2048 recurrent=true", Paper(), kFarms,
                               kStepsPerRollout);
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
