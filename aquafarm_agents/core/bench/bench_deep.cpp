// SPDX-License-Identifier: BSD-3-Clause
// Measures farm steps and updates per second of DQN and LSTM-DQN on paper.yaml with 16 farms and
// one thread. The observations are the plain feature vector (43 values), as in the references of
// tools/bench_reference.py. In the benchmarks whose names end in AllFeatures, they also contain
// route distances and lookahead risks (81 values).
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "aquafarm/scenario/scenario_yaml.h"
#include "metric_reporter.h"
#include "training_loop.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kFarms = 16;

constexpr const char* kDqnOptions =
    "batch_size=64 hidden_size=128 train_interval=4 learning_starts=5000 priority_exponent=0";
constexpr const char* kLstmOptions =
    "batch_size=32 hidden_size=64 sequence_length=16 burn_in=8 train_interval=16 "
    "learning_starts=5000 priority_exponent=0";

std::shared_ptr<const Scenario> Paper(bool all_features) {
  Scenario scenario = LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml");
  scenario.view.routes = scenario.view.lookahead_risk = all_features;
  return std::make_shared<const Scenario>(std::move(scenario));
}

// Steps after which the updates have started.
constexpr int kFirstSteps = 1000;

void TrainSteps(benchmark::State& state, TrainingLoop& training) {
  for (auto _ : state) training.Run(1);
  state.SetItemsProcessed(state.iterations() * kFarms);
}

// All repetitions of a benchmark share one learner.
void Dqn(benchmark::State& state) {
  static TrainingLoop training("dqn", kDqnOptions, Paper(false), kFarms, kFirstSteps);
  TrainSteps(state, training);
}
void DqnAllFeatures(benchmark::State& state) {
  static TrainingLoop training("dqn", kDqnOptions, Paper(true), kFarms, kFirstSteps);
  TrainSteps(state, training);
}
void LstmDqn(benchmark::State& state) {
  static TrainingLoop training("lstm_dqn", kLstmOptions, Paper(false), kFarms, kFirstSteps);
  TrainSteps(state, training);
}
void LstmDqnAllFeatures(benchmark::State& state) {
  static TrainingLoop training("lstm_dqn", kLstmOptions, Paper(true), kFarms, kFirstSteps);
  TrainSteps(state, training);
}

BENCHMARK(Dqn);
BENCHMARK(DqnAllFeatures);
BENCHMARK(LstmDqn);
BENCHMARK(LstmDqnAllFeatures);

void Print(const std::string& name, double steps, double steps_per_update) {
  if (steps == 0.0) return;  // not selected
  bench::PrintMetric(name + "_training_steps", steps, "steps/s");
  bench::PrintMetric(name + "_updates", steps / steps_per_update, "updates/s");
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  using namespace aquafarm::agents;  // NOLINT: for Print
  Print("dqn", reporter.median("Dqn"), 4.0);
  Print("dqn_all_features", reporter.median("DqnAllFeatures"), 4.0);
  Print("lstm_dqn", reporter.median("LstmDqn"), 16.0);
  Print("lstm_dqn_all_features", reporter.median("LstmDqnAllFeatures"), 16.0);
  return 0;
}
