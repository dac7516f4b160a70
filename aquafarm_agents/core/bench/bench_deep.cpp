// SPDX-License-Identifier: BSD-3-Clause
// Farm steps and updates a second of the deep learners on paper.yaml, 16 farms, one thread.
// References: Python on such a core for the same work, as measured once: Stable-Baselines3 2.4 with
// 600 updates a second for DQN, PyTorch with 175 for LSTM-DQN.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/algorithms.h"
#include "aquafarm/agents/local_environment.h"
#include "aquafarm/scenario_yaml.h"
#include "metric_reporter.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kFarms = 16;
constexpr double kPythonDqnUpdates = 600.0;
constexpr double kPythonLstmUpdates = 175.0;

// One learner for all repetitions; its replay is full and its updates are under way.
struct Training {
  Training(const char* algorithm, const std::string& options)
      : environment(
            std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml")),
            {kFarms, FindAlgorithm(algorithm).encodings(options), false, 1}),
        learner(FindAlgorithm(algorithm).make(environment.spec(), 1, options)),
        results(&environment.Reset(1)) {
    for (int i = 0; i < 1000; ++i) Step();
  }
  void Step() {
    learner->Step(*results, 0.3, actions);
    results = &environment.Step(actions);
  }
  LocalEnvironment environment;
  std::unique_ptr<Learner> learner;
  const Results* results;
  std::vector<std::uint8_t> actions;
};

void TrainSteps(benchmark::State& state, Training& training) {
  for (auto _ : state) training.Step();
  state.SetItemsProcessed(state.iterations() * kFarms);
}

void Dqn(benchmark::State& state) {
  static Training training("dqn", "batch=64 hidden=128 steps_per_update=4 start=5000 priority=0");
  TrainSteps(state, training);
}
void LstmDqn(benchmark::State& state) {
  static Training training(
      "lstm_dqn",
      "batch=32 hidden=64 sequence=16 burn_in=8 steps_per_update=16 start=5000 priority=0");
  TrainSteps(state, training);
}

BENCHMARK(Dqn);
BENCHMARK(LstmDqn);

void Print(const std::string& name, double steps, double steps_per_update, double python_updates) {
  if (steps == 0.0) return;  // not asked for
  bench::PrintMetric(name + "_training_steps", steps, "steps/s");
  bench::PrintMetric(name + "_updates", steps / steps_per_update, "updates/s");
  bench::PrintMetric(name + "_updates_to_python", steps / steps_per_update / python_updates,
                     "ratio");
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  using namespace aquafarm::agents;  // NOLINT: this file speaks of nothing else
  Print("dqn", reporter.median("Dqn"), 4.0, kPythonDqnUpdates);
  Print("lstm_dqn", reporter.median("LstmDqn"), 16.0, kPythonLstmUpdates);
  return 0;
}
