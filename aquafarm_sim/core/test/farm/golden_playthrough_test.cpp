// SPDX-License-Identifier: BSD-3-Clause
// Plays every shipped scenario with a fixed seed and compares the result with the human-readable
// file test/golden/NAME.txt. After an intended change of the rules, run
//   AQUAFARM_UPDATE_GOLDEN=1 build/golden_playthrough_test
// then review the difference and document it in CHANGELOG.rst.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

// Returns the farm as text, north up: # island, o rock, P port, d device, 0-9 ships, . open water,
// ~ water at a risk.
std::string Map(const Farm& farm) {
  const Scenario& scenario = farm.scenario();
  std::ostringstream text;
  for (std::int32_t y = scenario.height - 1; y >= 0; --y) {
    std::string row;
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      const Cell cell{x, y};
      const std::uint8_t bits = farm.layout().bits(cell);
      char mark = RiskAt(farm.disasters(), cell) < 0.0F ? '~' : '.';
      if ((bits & kIslandBit) != 0) mark = '#';
      if ((bits & kRockBit) != 0) mark = 'o';
      if ((bits & kPortBit) != 0) mark = 'P';
      for (const Device& device : farm.devices()) {
        if (device.cell == cell && device.status == DeviceStatus::kDeployed) mark = 'd';
      }
      for (std::size_t id = 0; id < farm.ships().size(); ++id) {
        if (farm.ships()[id].cell == cell) mark = static_cast<char>('0' + id % 10);
      }
      row += mark;
    }
    text << row << '\n';
  }
  return text.str();
}

std::string Number(float value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", static_cast<double>(value));
  return text;
}

// A simple policy that heads for the nearest goal. It delivers the devices on most charts.
Action Pilot(const Farm& farm, std::int32_t id, RandomStream& rng) {
  const Ship& ship = farm.ships()[static_cast<std::size_t>(id)];
  const ActionMask legal = farm.LegalActions(id);
  if ((legal & MaskOf(Action::kDropOff)) != 0) return Action::kDropOff;
  if ((legal & MaskOf(Action::kPickup)) != 0) return Action::kPickup;
  std::vector<Cell> goals;
  if (ship.aboard > 0 || ship.own_device != kNone) {
    goals = farm.layout().ports;
  } else {
    for (const Device& device : farm.devices()) {
      if (device.status == DeviceStatus::kDeployed) goals.push_back(device.cell);
    }
  }
  if (goals.empty()) return Action::kHold;
  const Cell goal = *std::min_element(goals.begin(), goals.end(), [&](Cell a, Cell b) {
    return MovesBetween(ship.cell, a) < MovesBetween(ship.cell, b);
  });
  Action best = Action::kHold;
  std::int32_t nearest = MovesBetween(ship.cell, goal);
  for (int move = 0; move < kMoveCount; ++move) {
    const Cell by = kMoves[static_cast<std::size_t>(move)];
    const Cell to{ship.cell.x + by.x, ship.cell.y + by.y};
    if (to.x < 0 || to.y < 0 || to.x >= farm.scenario().width || to.y >= farm.scenario().height) {
      continue;
    }
    if ((farm.layout().bits(to) & kBlockedBits) != 0 || MovesBetween(to, goal) >= nearest) continue;
    nearest = MovesBetween(to, goal);
    best = static_cast<Action>(move);
  }
  // Random moves escape from dead ends.
  return best != Action::kHold && rng.Below(8) != 0 ? best
                                                    : static_cast<Action>(rng.Below(kMoveCount));
}

std::string Playthrough(const std::shared_ptr<const Scenario>& scenario) {
  constexpr std::int32_t kShown = 25;
  Farm farm(scenario);
  farm.Reset(1, 0);
  std::ostringstream text;
  text << scenario->name << ", seed 1, episode 0\n" << Map(farm);
  for (const Device& device : farm.devices()) {
    text << ToString(device.kind) << " at (" << device.cell.x << ", " << device.cell.y << ") worth "
         << Number(device.value) << '\n';
  }
  RandomStream rng({1, 0, RngStream::kExploration, 0});
  std::vector<std::uint8_t> codes(farm.ships().size());
  while (!farm.over()) {
    for (std::size_t id = 0; id < codes.size(); ++id) {
      codes[id] = static_cast<std::uint8_t>(Pilot(farm, static_cast<std::int32_t>(id), rng));
    }
    farm.Step(codes.data());
    const bool told = farm.step() <= kShown || farm.over();
    for (std::size_t id = 0; id < codes.size() && told; ++id) {
      const Ship& ship = farm.ships()[id];
      text << "step " << farm.step() << " ship " << id << ' ' << ToString(ship.action) << " -> ("
           << ship.cell.x << ", " << ship.cell.y << ") " << ToString(ship.outcome) << " reward "
           << Number(ship.reward) << '\n';
    }
    if (!told) continue;
    for (const Disaster& disaster : farm.disasters()) {
      text << "  " << ToString(disaster.kind) << " at (" << Number(disaster.x) << ", "
           << Number(disaster.y) << ") heading " << disaster.heading_deg << '\n';
    }
  }
  const EpisodeRecord& record = farm.record();
  text << Map(farm) << ToString(record.reason) << " after " << record.steps << " steps, return "
       << Number(record.episode_return) << ", delivered " << record.delivered << " of "
       << record.devices << " with health " << Number(record.delivered_health) << ", "
       << record.crashes << " crashes, " << record.collisions << " collisions, "
       << record.steps_in_disaster << " steps in disaster\n";
  return text.str();
}

std::string ReadFile(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(GoldenPlaythrough, EveryShippedScenarioPlaysAsWritten) {
  const fs::path core = AQUAFARM_CORE_DIR;
  int played = 0;
  for (const auto& entry : fs::directory_iterator(core / "../scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    const auto scenario = std::make_shared<const Scenario>(LoadScenario(entry.path().string()));
    const std::string text = Playthrough(scenario);
    const fs::path golden = core / "test/golden" / (entry.path().stem().string() + ".txt");
    if (std::getenv("AQUAFARM_UPDATE_GOLDEN") != nullptr) std::ofstream(golden) << text;
    EXPECT_EQ(text, ReadFile(golden)) << golden;
    ++played;
  }
  EXPECT_GE(played, 8);
}

}  // namespace
}  // namespace aquafarm
