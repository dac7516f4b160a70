// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/route.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "evaluation/stop.h"

namespace aquafarm::agents {
namespace {

using nlohmann::json;

json ToJson(Cell cell) { return json::array({cell.x, cell.y}); }

json ToJson(const std::vector<GreedyAction>& moves) {
  json list = json::array();
  for (const GreedyAction& move : moves) {
    list.push_back({move.cell.x, move.cell.y, ToString(static_cast<Action>(move.action))});
  }
  return list;
}

json ToJson(const std::vector<Disaster>& disasters) {
  json list = json::array();
  for (const Disaster& disaster : disasters) {
    if (disaster.steps_left <= 0) continue;
    json radii = json::array();
    for (std::int32_t k = 0; k < disaster.rings; ++k) {
      radii.push_back(disaster.radius[static_cast<std::size_t>(k)]);
    }
    list.push_back({{"x", disaster.x}, {"y", disaster.y}, {"radii", radii}});
    for (std::size_t k = 0; disaster.by_quadrant && k < radii.size(); ++k) {
      json ring = json::array();
      for (const auto& quadrant : disaster.quadrant) ring.push_back(quadrant[k]);
      list.back()["quadrants"].push_back(ring);
    }
  }
  return list;
}

json ToJson(const Layout& layout) {
  json islands = json::array();
  json rocks = json::array();
  json ports = json::array();
  json devices = json::array();
  const auto height = static_cast<std::int32_t>(layout.cells.rows());
  const auto width = static_cast<std::int32_t>(layout.cells.cols());
  for (std::int32_t y = 0; y < height; ++y) {
    for (std::int32_t x = 0; x < width; ++x) {
      if ((layout.bits({x, y}) & kIslandBit) != 0) islands.push_back({x, y});
    }
  }
  for (const Cell rock : layout.rocks) rocks.push_back(ToJson(rock));
  for (const Cell port : layout.ports) ports.push_back(ToJson(port));
  for (const PlacedDevice& device : layout.devices) {
    devices.push_back(
        {{"cell", ToJson(device.cell)}, {"kind", ToString(device.kind)}, {"value", device.value}});
  }
  return {{"width", width}, {"height", height}, {"islands", islands},
          {"rocks", rocks}, {"ports", ports},   {"devices", devices}};
}

RouteStep Look(const Farm& farm) {
  const Ship& ship = farm.ships()[0];
  return {ship.cell,
          ship.aboard,
          farm.record().delivered,
          farm.record().episode_return,
          farm.disasters(),
          0};
}

}  // namespace

Route TraceRoute(const std::shared_ptr<const Scenario>& scenario, std::uint8_t observation_types,
                 const MakePolicyFor& make_policy, std::uint64_t seed, std::uint64_t episode,
                 const std::atomic<bool>* stop) {
  LocalEnvironment environment(scenario, {1, observation_types, false, 1});
  const std::unique_ptr<Policy> policy = make_policy(environment.spec());
  policy->Begin(EvaluationSeed(seed), 1);
  Route route;
  const Farm& farm = environment.batch().farm(0);
  const std::unique_ptr<Policy> elsewhere = make_policy(environment.spec());
  const StepResults* results = &environment.Reset(EvaluationSeed(seed), episode);
  route.layout = farm.shared_layout();
  route.at_start = GreedyActions(farm, observation_types, *elsewhere, stop);
  route.steps.push_back(Look(farm));
  std::vector<std::uint8_t> actions;
  while (!farm.over() && !IsStopped(stop)) {
    policy->Act(*results, actions);
    route.steps.back().action = actions[0];
    route.actions.insert(route.actions.end(), actions.begin(), actions.end());
    results = &environment.Step(actions);
    route.steps.push_back(Look(farm));
    if (route.after_pickup.empty() && farm.ships()[0].aboard > 0 && !farm.over()) {
      route.after_pickup = GreedyActions(farm, observation_types, *elsewhere, stop);
    }
  }
  route.result = SummaryOf(farm.record(), 0);
  return route;
}

void WriteRoute(const std::string& path, const Route& route, const EnvironmentSpec& spec) {
  json steps = json::array();
  for (std::size_t i = 0; i < route.steps.size(); ++i) {
    const RouteStep& one = route.steps[i];
    json step{{"cell", ToJson(one.cell)},
              {"aboard", one.aboard},
              {"delivered", one.delivered},
              {"return", one.episode_return},
              {"disasters", ToJson(one.disasters)}};
    if (i + 1 < route.steps.size()) step["action"] = ToString(static_cast<Action>(one.action));
    steps.push_back(step);
  }
  const json text{{"scenario", spec.scenario_name},
                  {"scenario_hash", spec.scenario_hash},
                  {"version", spec.version},
                  {"farm_seed", route.result.seed},
                  {"episode", route.result.episode},
                  {"reason", ToString(route.result.reason)},
                  {"return", route.result.episode_return},
                  {"chart", ToJson(*route.layout)},
                  {"steps", steps},
                  {"actions", route.actions},
                  {"best_moves_at_start", ToJson(route.at_start)},
                  {"best_moves_after_pickup", ToJson(route.after_pickup)}};
  WriteFileAtomically(path, text.dump() + "\n");
}

}  // namespace aquafarm::agents
