// SPDX-License-Identifier: BSD-3-Clause
// Measures two planners on paper.yaml with one thread. Clairvoyant: the time per plan, each of
// another episode. RecedingHorizon: the decisions per second of the planner that replans in each
// step without knowing the future.
#include <benchmark/benchmark.h>

#include <memory>

#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "metric_reporter.h"

namespace aquafarm::agents {
namespace {

Farm Paper() {
  return Farm(std::make_shared<const Scenario>(LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml")));
}

void Clairvoyant(benchmark::State& state) {
  Farm farm = Paper();
  Planner planner(farm.scenario());
  std::uint64_t episode = 0;
  for (auto _ : state) {
    farm.Reset(1, episode++);
    benchmark::DoNotOptimize(planner.Solve(farm, Foresight::kOracle).expected_return);
  }
  state.SetItemsProcessed(state.iterations());
}

void RecedingHorizon(benchmark::State& state) {
  Farm farm = Paper();
  Planner planner(farm.scenario());
  std::uint64_t episode = 0;
  farm.Reset(1, episode);
  for (auto _ : state) {
    const std::uint8_t action = planner.Solve(farm, Foresight::kPersistence).actions.at(0);
    farm.Step(&action);
    if (farm.over()) farm.Reset(1, ++episode);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(Clairvoyant);
BENCHMARK(RecedingHorizon);

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  aquafarm::bench::PrintMetric("clairvoyant_plan", 1.0 / reporter.median("Clairvoyant"),
                               "s/episode");
  aquafarm::bench::PrintMetric("receding_horizon_decisions", reporter.median("RecedingHorizon"),
                               "decisions/s");
  return 0;
}
