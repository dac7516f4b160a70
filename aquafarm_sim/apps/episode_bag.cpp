// SPDX-License-Identifier: BSD-3-Clause
// Converts the output of aquafarm_evaluate --route to a bag for rendering, replay and verification.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/bags/episode_log.h"

namespace {

using aquafarm::InputError;

void Write(const std::string& scenario_path, const std::string& route_path,
           const std::string& bag_path) {
  const auto scenario =
      std::make_shared<const aquafarm::Scenario>(aquafarm::LoadScenario(scenario_path));
  std::ifstream file(route_path);
  if (!file)
    throw InputError(route_path + ": cannot be read, expected a file of aquafarm_evaluate --route");
  aquafarm_sim::EpisodeLog log;
  std::uint64_t hash = 0;
  try {
    const nlohmann::json route = nlohmann::json::parse(file);
    hash = route.at("scenario_hash");
    log.seed = route.at("farm_seed");
    log.episode = route.at("episode");
    for (const nlohmann::json& action : route.at("actions")) {
      const auto number = action.get<std::int64_t>();
      if (number < 0 || number > aquafarm::kActionCount) {
        throw InputError(route_path + ": actions: got " + std::to_string(number) +
                         ", expected [0, 10]");
      }
      log.actions.push_back(static_cast<std::uint8_t>(number));
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(route_path + ": is not a route: " + error.what());
  }
  if (hash != scenario->hash) {
    throw InputError(route_path + ": is a route in another scenario than " + scenario_path);
  }
  aquafarm::Farm farm(scenario);
  farm.Reset(log.seed, log.episode);
  const std::size_t agents = farm.ships().size();
  for (std::size_t i = 0; i + agents <= log.actions.size() && !farm.over(); i += agents) {
    farm.Step(log.actions.data() + i);
  }
  log.record = farm.record();
  aquafarm_sim::EpisodeBagWriter(scenario, {"/aquafarm/", "map", 10.0, 1}).Write(log, bag_path);
}

}  // namespace

int main(int argc, char** argv) {
  std::string scenario;
  std::string route;
  std::string bag;
  CLI::App app("Plays a route of aquafarm_evaluate again and writes it as a bag.", "episode_bag");
  app.add_option("scenario", scenario, "scenario file")->required();
  app.add_option("route", route, "JSON file of aquafarm_evaluate --route")->required();
  app.add_option("-o,--output", bag, "bag to write")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    Write(scenario, route, bag);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "episode_bag: %s\n", error.what());
    return 2;
  }
  return 0;
}
