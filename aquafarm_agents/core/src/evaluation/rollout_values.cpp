// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/rollout_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/base/check.h"
#include "evaluation/free_cells.h"
#include "evaluation/stop.h"

namespace aquafarm::agents {
namespace {

using nlohmann::json;

// Returns the sum of the rewards of all agents of a farm in the last step. With a team reward, each
// agent receives this sum.
double RewardOf(const StepResults& results, const EnvironmentSpec& spec, std::size_t farm) {
  const auto agents = static_cast<std::size_t>(spec.agents);
  double sum = 0.0;
  for (std::size_t i = 0; i < agents; ++i) {
    sum += static_cast<double>(results.rewards[farm * agents + i]);
  }
  return spec.team_reward ? sum / static_cast<double>(agents) : sum;
}

// Plays all farms to the end of their current episodes. @param results current results of the farms
// @returns the return of each farm: if `discount` is below 1, the discounted sum of the rewards
//   from now on, else the return of the whole episode
std::vector<double> PlayOut(LocalEnvironment& environment, const StepResults* results,
                            Policy& policy, std::uint64_t seed, double discount,
                            const std::atomic<bool>* stop) {
  const std::int32_t count = environment.spec().farms;
  std::vector<double> returns(static_cast<std::size_t>(count));
  std::vector<bool> over(returns.size());
  std::int32_t left = count;
  double weight = 1.0;  // discount of the reward of the next step
  policy.Begin(seed, count);
  std::vector<std::uint8_t> actions;
  while (left > 0 && !IsStopped(stop)) {
    policy.Act(*results, actions);
    results = &environment.Step(actions);
    for (std::size_t farm = 0; discount < 1.0 && farm < returns.size(); ++farm) {
      if (!over[farm]) returns[farm] += weight * RewardOf(*results, environment.spec(), farm);
    }
    weight *= discount;
    for (const EpisodeSummary& ended : results->finished) {
      const auto farm = static_cast<std::size_t>(ended.farm);
      if (over[farm]) continue;  // this is a later episode of the same farm
      over[farm] = true;
      if (discount >= 1.0) returns[farm] = static_cast<double>(ended.episode_return);
      --left;
    }
  }
  return returns;
}

json Rows(const std::vector<json>& values, std::int32_t width) {
  json rows = json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % static_cast<std::size_t>(width) == 0) rows.push_back(json::array());
    rows.back().push_back(values[i]);
  }
  return rows;
}

template <typename T>
json ToRows(const std::vector<T>& values, std::int32_t width) {
  std::vector<json> entries;
  entries.reserve(values.size());
  for (const T value : values) {
    entries.push_back(std::isnan(value) ? json(nullptr) : json(value));
  }
  return Rows(entries, width);
}

void NotePlaces(const Farm& farm, RolloutValues& values) {
  values.ports = farm.layout().ports;
  for (const PlacedDevice& device : farm.layout().devices) values.devices.push_back(device.cell);
}

json ToPairs(const std::vector<Cell>& cells) {
  json pairs = json::array();
  for (const Cell cell : cells) pairs.push_back({cell.x, cell.y});
  return pairs;
}

}  // namespace

RolloutValues PlayValues(const std::shared_ptr<const Scenario>& scenario,
                         std::uint8_t observation_types, const MakePolicyFor& make_policy,
                         std::uint64_t seed, std::uint64_t episode, std::int32_t episodes,
                         const std::atomic<bool>* stop, double discount) {
  if (scenario->CellCount() > kMaxCells) {
    throw InputError("values: got a farm of " + std::to_string(scenario->CellCount()) +
                     " cells, expected at most " + std::to_string(kMaxCells));
  }
  if (episodes > 1 && scenario->layout != LayoutMode::kFixed) {
    throw InputError("values: got layout.mode per_episode, expected fixed to average over " +
                     std::to_string(episodes) + " episodes");
  }
  const auto cells = static_cast<std::size_t>(scenario->CellCount());
  RolloutValues values{scenario->width,
                       scenario->height,
                       EvaluationSeed(seed),
                       episode,
                       episodes,
                       {},
                       discount,
                       {},
                       {}};
  values.value.assign(cells, 0.0);
  Farm farm(scenario);
  for (std::int32_t k = 0; k < episodes && !IsStopped(stop); ++k) {
    farm.Reset(values.seed, episode + static_cast<std::uint64_t>(k));
    if (k == 0) NotePlaces(farm, values);
    const std::vector<Cell> starts = FreeCells(farm);
    std::vector<double> here(cells, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t first = 0; first < starts.size(); first += kCellsAtOnce) {
      const std::size_t count = std::min(kCellsAtOnce, starts.size() - first);
      LocalEnvironment environment(scenario,
                                   {static_cast<std::int32_t>(count), observation_types, false, 1});
      const std::unique_ptr<Policy> policy = make_policy(environment.spec());
      const auto returns = PlayOut(environment, &PlaceInEach(farm, starts, first, environment),
                                   *policy, values.seed, discount, stop);
      for (std::size_t i = 0; i < count; ++i) {
        const Cell start = starts[first + i];
        here[static_cast<std::size_t>(LinearIndex(start, values.width))] = returns[i];
      }
    }
    for (std::size_t i = 0; i < cells; ++i) values.value[i] += here[i] / episodes;
  }
  return values;
}

void WriteValues(const std::string& path, const RolloutValues& values, const std::string& policy,
                 const Scenario& scenario) {
  json layers = json::array();
  if (scenario.seas) {
    for (const SeaLayer& layer : scenario.seas->layers) {
      layers.push_back({{"name", layer.name},
                        {"units", layer.units},
                        {"values", ToRows(layer.values, values.width)}});
    }
  }
  const json text{
      {"scenario", scenario.name},
      {"scenario_hash", scenario.hash},
      {"policy", policy},
      {"cell_size_m", scenario.cell_size_m},
      {"farm_seed", values.seed},
      {"episode", values.episode},
      {"episodes", values.episodes},
      {"discount", values.discount},
      {"what", values.discount < 1.0
                   ? "discounted return of the episode when ship 0 starts in the cell"
                   : "undiscounted return of the episode when ship 0 starts in the cell"},
      {"values", ToRows(values.value, values.width)},
      {"ports", ToPairs(values.ports)},
      {"devices", ToPairs(values.devices)},
      {"seas", layers}};
  WriteFileAtomically(path, text.dump() + "\n");
}

}  // namespace aquafarm::agents
