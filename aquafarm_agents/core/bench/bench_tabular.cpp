// SPDX-License-Identifier: BSD-3-Clause
// Measures training steps per second of the tabular learners on paper.yaml with one thread, the
// ratio of this rate to that of RANDOM, and the time and success of a complete training.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/trainer.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "metric_reporter.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kFarms = 64;
constexpr std::int32_t kEvaluationEpisodes = 1000;
constexpr std::uint64_t kSeeds = 5;

LocalEnvironment Paper() {
  return {std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml")),
          {kFarms, kIndexBit, false, 1}};
}

// Trains from the start of the schedules. Google Benchmark counts farm steps as items.
void TrainSteps(benchmark::State& state, const char* algorithm, const char* options) {
  LocalEnvironment environment = Paper();
  const Algorithm& entry = FindAlgorithm(algorithm);
  const auto learner = entry.make(environment.spec(), 1, options);
  const StepResults* results = &environment.Reset(1);
  std::vector<std::uint8_t> actions;
  std::uint64_t steps = 0;
  for (auto _ : state) {
    const std::uint64_t done = steps % entry.default_steps;
    learner->Step(*results, static_cast<double>(done) / static_cast<double>(entry.default_steps),
                  actions);
    results = &environment.Step(actions);
    steps += kFarms;
  }
  state.SetItemsProcessed(state.iterations() * kFarms);
}

void Random(benchmark::State& state) { TrainSteps(state, "random", ""); }
void QLearning(benchmark::State& state) { TrainSteps(state, "q_learning", ""); }
void Sarsa(benchmark::State& state) { TrainSteps(state, "sarsa", ""); }
void Boltzmann(benchmark::State& state) {
  TrainSteps(state, "q_learning", "exploration=boltzmann:1");
}

BENCHMARK(Random);
BENCHMARK(QLearning);
BENCHMARK(Sarsa);
BENCHMARK(Boltzmann);

struct Solution {
  double seconds{};  ///< training time with the default options
  double success{};  ///< success rate of the greedy policy in kEvaluationEpisodes unseen episodes
};

Solution Solve(const char* algorithm, std::uint64_t seed) {
  LocalEnvironment environment = Paper();
  const Algorithm& entry = FindAlgorithm(algorithm);
  const auto learner = entry.make(environment.spec(), seed, "");
  TrainerOptions options;
  options.algorithm = algorithm;
  options.seed = seed;
  options.steps = entry.default_steps;
  const auto start = std::chrono::steady_clock::now();
  Trainer(environment, *learner, options).Run();
  Solution solution;
  solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto policy = learner->GreedyPolicy();
  solution.success = Evaluate(environment, *policy, seed, kEvaluationEpisodes).success_rate;
  return solution;
}

void PrintSolved(const std::string& algorithm) {
  std::vector<double> seconds;
  double least_success = 1.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Solution solution = Solve(algorithm.c_str(), seed);
    seconds.push_back(solution.seconds);
    least_success = std::min(least_success, solution.success);
  }
  std::sort(seconds.begin(), seconds.end());
  bench::PrintMetric(algorithm + "_training", seconds[seconds.size() / 2], "s");
  bench::PrintMetric(algorithm + "_greedy_success_of_worst_seed", least_success, "share");
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) {
  using aquafarm::bench::PrintMetric;
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  const double random = reporter.median("Random");
  PrintMetric("random_steps", random, "steps/s");
  for (const auto& [name, metric] :
       {std::pair{"QLearning", "q_learning"}, std::pair{"Sarsa", "sarsa"},
        std::pair{"Boltzmann", "q_learning_boltzmann"}}) {
    const double rate = reporter.median(name);
    PrintMetric(std::string(metric) + "_training_steps", rate, "steps/s");
    PrintMetric(std::string(metric) + "_to_random", rate / random, "ratio");
  }
  aquafarm::agents::PrintSolved("q_learning");
  aquafarm::agents::PrintSolved("sarsa");
  return 0;
}
