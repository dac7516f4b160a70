// SPDX-License-Identifier: BSD-3-Clause
// Measures farm steps per second with one thread and random actions. When an episode ends, the farm
// starts the next one. The costs of larger maps are relative to a map of 25 × 25 cells.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/grid/action.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "metric_reporter.h"

namespace aquafarm {
namespace {

constexpr std::int32_t kFarms = 64;

enum class Wanted { kNothing, kIndex, kFeatures, kPlanes };

Scenario Paper() { return LoadScenario(AQUAFARM_SCENARIO_DIR "/paper.yaml"); }

// Returns the scenario without optional features: 43 features instead of 81.
Scenario PaperWithPlainFeatures() {
  Scenario scenario = Paper();
  scenario.view.routes = scenario.view.lookahead_risk = false;
  return scenario;
}

// Steps `farms` farms; one item is one farm step.
void StepFarms(benchmark::State& state, Scenario scenario, Wanted wanted,
               std::int32_t farms = kFarms) {
  FarmBatch batch(std::make_shared<const Scenario>(std::move(scenario)), farms);
  const auto agents = static_cast<std::size_t>(batch.farms() * batch.agents());
  std::vector<float> rewards(agents);
  std::vector<std::uint8_t> end_reasons(static_cast<std::size_t>(farms));
  std::vector<std::uint32_t> index(agents);
  std::vector<float> features(agents * static_cast<std::size_t>(batch.encoder().feature_count()));
  std::vector<std::uint8_t> planes(
      wanted == Wanted::kPlanes ? agents * batch.encoder().planes_size() : 0);
  BatchOutput output;
  output.rewards = rewards.data();
  output.end_reasons = end_reasons.data();
  if (wanted == Wanted::kIndex) output.index = index.data();
  if (wanted == Wanted::kFeatures) output.features = features.data();
  if (wanted == Wanted::kPlanes) output.planes = planes.data();
  // Random actions, drawn in advance. A prime number of joint actions (257) keeps the farms from
  // synchronizing.
  constexpr std::size_t kDrawn = 257;
  std::vector<std::uint8_t> actions(kDrawn * agents);
  RandomStream rng({1, 0, RngStream::kExploration, 0});
  for (std::uint8_t& action : actions) {
    action = static_cast<std::uint8_t>(rng.Below(kActionCount));
  }
  batch.Reset(1, 0, output);
  std::size_t step = 0;
  for (auto _ : state) {
    batch.Step(actions.data() + (step++ % kDrawn) * agents, output);
    benchmark::DoNotOptimize(rewards.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * farms);
}

void Index(benchmark::State& state) { StepFarms(state, Paper(), Wanted::kIndex); }
void Features(benchmark::State& state) {
  StepFarms(state, PaperWithPlainFeatures(), Wanted::kFeatures);
}
void AllFeatures(benchmark::State& state) { StepFarms(state, Paper(), Wanted::kFeatures); }
void Planes(benchmark::State& state) { StepFarms(state, Paper(), Wanted::kPlanes); }
void OneFarm(benchmark::State& state) { StepFarms(state, Paper(), Wanted::kIndex, 1); }

void Side(benchmark::State& state) {
  Scenario scenario = Paper();
  scenario.islands.clear();
  scenario.ports.cells.clear();
  scenario.ports.count = 4;
  scenario.width = scenario.height = static_cast<std::int32_t>(state.range(0));
  StepFarms(state, scenario, Wanted::kIndex);
}

void Ships(benchmark::State& state) {
  Scenario scenario = Paper();
  scenario.ships.count = static_cast<std::int32_t>(state.range(0));
  StepFarms(state, scenario, Wanted::kNothing);
}

void Disasters(benchmark::State& state) {
  Scenario scenario = Paper();
  scenario.disasters.assign(static_cast<std::size_t>(state.range(0)), scenario.disasters[0]);
  StepFarms(state, scenario, Wanted::kNothing);
}

BENCHMARK(Index);
BENCHMARK(Features);
BENCHMARK(AllFeatures);
BENCHMARK(Planes);
BENCHMARK(OneFarm);
BENCHMARK(Side)->Arg(25)->Arg(100)->Arg(1000);
BENCHMARK(Ships)->Arg(1)->Arg(4)->Arg(16)->Arg(64);
BENCHMARK(Disasters)->Arg(1)->Arg(4)->Arg(16);

void PrintMetrics(const bench::MetricReporter& reporter) {
  using bench::PrintMetric;
  const auto rate = [&](const std::string& name) { return reporter.median(name); };
  PrintMetric("farm_steps_tabular", rate("Index"), "steps/s");
  PrintMetric("farm_steps_features", rate("Features"), "steps/s");
  PrintMetric("farm_steps_features_waterways_courses", rate("AllFeatures"), "steps/s");
  PrintMetric("farm_steps_planes", rate("Planes"), "steps/s");
  PrintMetric("farm_steps_tabular_one_farm", rate("OneFarm"), "steps/s");
  PrintMetric("cost_1000x1000_to_25x25", rate("Side/25") / rate("Side/1000"), "ratio");
  PrintMetric("cost_100x100_to_25x25", rate("Side/25") / rate("Side/100"), "ratio");
  // Returns the mean cost of each ship or disaster after the first, with `many` of them, divided by
  // the same mean with `few` of them. If the result is below 1.5, the cost counts as constant.
  const auto per_one_more = [&](const std::string& what, double few, double many) {
    const double cost_one = 1.0 / rate(what + "/1");
    const double cost_few = 1.0 / rate(what + "/" + std::to_string(static_cast<int>(few)));
    const double cost_many = 1.0 / rate(what + "/" + std::to_string(static_cast<int>(many)));
    return ((cost_many - cost_one) / (many - 1)) / ((cost_few - cost_one) / (few - 1));
  };
  PrintMetric("cost_per_ship_64_to_4", per_one_more("Ships", 4, 64), "ratio");
  PrintMetric("cost_per_ship_64_to_1", rate("Ships/1") / (64 * rate("Ships/64")), "ratio");
  PrintMetric("cost_per_disaster_16_to_4", per_one_more("Disasters", 4, 16), "ratio");
  PrintMetric("farm_state",
              static_cast<double>(sizeof(Farm) + sizeof(Ship) + 3 * sizeof(Device) +
                                  sizeof(Disaster) + sizeof(Track)),
              "bytes");
}

}  // namespace
}  // namespace aquafarm

int main(int argc, char** argv) {
  aquafarm::bench::MetricReporter reporter;
  if (!aquafarm::bench::RunMedians(argc, argv, reporter)) return 2;
  aquafarm::PrintMetrics(reporter);
  return 0;
}
