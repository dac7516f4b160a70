// SPDX-License-Identifier: BSD-3-Clause
// Steps farms for a long time and checks after each step what must always hold. Each episode is
// played by random actions, by legal random actions, or by a ship that heads for the nearest goal.
//   farm_soak STEPS SEED SCENARIO.yaml…    (or folders of scenarios; STEPS for each)
// Prints one line per scenario. Exit code 1 after the first fault, with the scenario, seed, episode
// and step that reproduce it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace {

using namespace aquafarm;

constexpr std::int64_t kSavePeriod = 1'000'000;  // steps between saves
constexpr int kStepsAfterLoad = 200;             // that both farms then take alike

class Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void Must(bool holds, const char* what) {
  if (!holds) throw Fault(what);
}

/// What the checks need to know of the state before a step.
struct Before {
  std::vector<ActionMask> legal;
  std::vector<bool> in_play;
  std::vector<DeviceStatus> status;
  std::vector<float> health;
  double episode_return{};
  std::int32_t step{};
};

Before Look(const Farm& farm) {
  Before before;
  for (std::int32_t ship = 0; ship < static_cast<std::int32_t>(farm.ships().size()); ++ship) {
    before.legal.push_back(farm.LegalActions(ship));
    before.in_play.push_back(farm.ships()[static_cast<std::size_t>(ship)].in_play);
  }
  for (const Device& device : farm.devices()) {
    before.status.push_back(device.status);
    before.health.push_back(device.health);
  }
  before.episode_return = static_cast<double>(farm.record().episode_return);
  before.step = farm.step();
  return before;
}

bool OnMap(const Farm& farm, Cell cell) {
  return cell.x >= 0 && cell.y >= 0 && cell.x < farm.layout().cells.cols() &&
         cell.y < farm.layout().cells.rows();
}

void CheckDevices(const Farm& farm, const Before& before) {
  std::vector<std::int32_t> aboard(farm.ships().size());
  std::int32_t delivered = 0;
  for (std::size_t i = 0; i < farm.devices().size(); ++i) {
    const Device& device = farm.devices()[i];
    Must(OnMap(farm, farm.CellOf(static_cast<std::int32_t>(i))), "a device is off the map");
    Must((device.status == DeviceStatus::kAboard) == (device.carrier != kNone),
         "a device has a carrier and is not aboard, or the other way round");
    Must(device.health >= 0.0F && device.health <= before.health[i],
         "the health of a device rose or is negative");
    Must(before.status[i] != DeviceStatus::kDelivered || device.status == DeviceStatus::kDelivered,
         "a delivered device is back");
    if (device.carrier != kNone) ++aboard.at(static_cast<std::size_t>(device.carrier));
    if (device.status != DeviceStatus::kDelivered) continue;
    ++delivered;
    Must((farm.layout().bits(device.cell) & kPortBit) != 0, "a device is delivered out of port");
  }
  Must(delivered == farm.record().delivered, "the count of delivered devices is wrong");
  const bool all = delivered == static_cast<std::int32_t>(farm.devices().size());
  Must(all == (farm.reason() == EndReason::kAllRetrieved), "the end does not follow the devices");
  for (std::size_t i = 0; i < aboard.size(); ++i) {
    const Ship& ship = farm.ships()[i];
    Must(ship.aboard == aboard[i], "a ship's count of devices aboard is wrong");
    Must(ship.aboard <= farm.scenario().ships.capacity, "a ship is overloaded");
  }
}

void CheckShips(const Farm& farm, const Before& before, const std::vector<std::uint8_t>& actions) {
  for (std::size_t i = 0; i < farm.ships().size(); ++i) {
    const Ship& ship = farm.ships()[i];
    if (!before.in_play[i]) continue;
    Must(OnMap(farm, ship.cell), "a ship is off the map");
    Must((farm.layout().bits(ship.cell) & kBlockedBits) == 0, "a ship is on land or a rock");
    const auto action = static_cast<Action>(actions[i]);
    const bool illegal = action != Action::kHold && (before.legal[i] & MaskOf(action)) == 0;
    Must((ship.terms.illegal != 0.0F) == illegal, "the mask of legal actions is wrong");
  }
}

void CheckRewards(const Farm& farm, const Before& before) {
  const bool team = farm.scenario().rewards.sharing == RewardSharing::kTeam;
  float sum = 0.0F;
  for (std::size_t i = 0; i < farm.ships().size(); ++i) {
    const Ship& ship = farm.ships()[i];
    if (!before.in_play[i]) continue;
    const float total = ship.terms.Total();
    Must(std::isfinite(total), "a reward is not finite");
    Must(team || ship.reward == total, "a reward is not the sum of its terms");
    sum += total;
  }
  for (const Ship& ship : farm.ships()) Must(!team || ship.reward == sum, "a share is wrong");
  const double expected = before.episode_return + static_cast<double>(sum);
  const double got = static_cast<double>(farm.record().episode_return);
  Must(std::abs(got - expected) <= 1e-3 + 1e-6 * std::abs(expected), "the return is not the sum");
  Must(farm.step() == before.step + 1, "the step was not counted");
  Must(farm.step() <= farm.scenario().step_limit, "the episode is longer than its limit");
}

int Distance(Cell a, Cell b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); }

/// Returns the move towards the nearest port with a device aboard, else towards the nearest device.
Action Homing(const Farm& farm, const Ship& ship, ActionMask legal, std::mt19937_64& rng) {
  for (const Action act : {Action::kDropOff, Action::kPickup}) {
    if ((legal & MaskOf(act)) != 0) return act;
  }
  std::vector<Cell> goals;
  const bool laden = ship.aboard > 0 || ship.own_device != kNone;
  if (laden) goals = farm.layout().ports;
  for (const Device& device : farm.devices()) {
    const bool fetchable = device.status == DeviceStatus::kDeployed && !device.self_propelled;
    if (!laden && fetchable) goals.push_back(device.cell);
  }
  auto best = static_cast<Action>(rng() % kMoveCount);
  if (rng() % 2 == 0) return best;  // gets around obstacles
  int nearest = std::numeric_limits<int>::max();
  for (std::size_t move = 0; move < kMoves.size(); ++move) {
    const Cell to{ship.cell.x + kMoves[move].x, ship.cell.y + kMoves[move].y};
    if (!OnMap(farm, to) || (farm.layout().bits(to) & kBlockedBits) != 0) continue;
    for (const Cell goal : goals) {
      if (Distance(to, goal) >= nearest) continue;
      nearest = Distance(to, goal);
      best = static_cast<Action>(move);
    }
  }
  return best;
}

void Choose(const Farm& farm, const Before& before, std::mt19937_64& rng,
            std::vector<std::uint8_t>& actions) {
  actions.resize(farm.ships().size());
  for (std::size_t i = 0; i < actions.size(); ++i) {
    std::uint64_t action = rng() % (kActionCount + 1);
    if (farm.episode() % 3 == 1) {
      while ((before.legal[i] & (1U << action)) == 0) action = rng() % kActionCount;
    } else if (farm.episode() % 3 == 2) {
      action = static_cast<std::uint64_t>(Homing(farm, farm.ships()[i], before.legal[i], rng));
    }
    actions[i] = static_cast<std::uint8_t>(action);
  }
}

/// Takes one checked step.
void Step(Farm& farm, std::mt19937_64& rng, std::vector<std::uint8_t>& actions) {
  const Before before = Look(farm);
  Choose(farm, before, rng, actions);
  farm.Step(actions.data());
  CheckDevices(farm, before);
  CheckShips(farm, before, actions);
  CheckRewards(farm, before);
}

/// Loads the saved farm into another one; both must then continue alike.
void CheckLoad(Farm& farm, Farm& other, std::mt19937_64& rng, std::vector<std::uint8_t>& actions) {
  other.Load(farm.Save());
  Must(other.Hash() == farm.Hash(), "the hash differs after save and load");
  for (int i = 0; i < kStepsAfterLoad && !farm.over(); ++i) {
    Step(farm, rng, actions);
    other.Step(actions.data());
    Must(other.Hash() == farm.Hash(), "a loaded farm continues differently");
  }
}

void Soak(const std::string& path, std::int64_t steps, std::uint64_t seed) {
  const auto scenario = std::make_shared<const Scenario>(LoadScenario(path));
  Farm farm(scenario);
  Farm other(scenario);
  std::mt19937_64 rng(seed);
  std::vector<std::uint8_t> actions;
  std::int64_t saves = 0;
  std::int64_t successes = 0;
  std::uint64_t episodes = 0;
  farm.Reset(seed, 0);
  try {
    for (std::int64_t i = 0, since = 0; i < steps; ++i) {
      if (farm.over()) {
        successes += farm.record().Success() ? 1 : 0;
        farm.Reset(seed, ++episodes);
      }
      Step(farm, rng, actions);
      if (++since < std::min(kSavePeriod, steps / 2) || farm.over()) continue;
      since = 0;
      ++saves;
      CheckLoad(farm, other, rng, actions);
    }
  } catch (const std::exception& error) {
    throw Fault(path + ": seed " + std::to_string(seed) + " episode " +
                std::to_string(farm.episode()) + " step " + std::to_string(farm.step()) + ": " +
                error.what());
  }
  std::printf("%s: %lld steps, %llu episodes, %lld successes, %lld saves\n", path.c_str(),
              static_cast<long long>(steps), static_cast<unsigned long long>(episodes),
              static_cast<long long>(successes), static_cast<long long>(saves));
  std::fflush(stdout);
}

/// Replaces each folder by the scenarios in it.
std::vector<std::string> Scenarios(const std::vector<std::string>& places) {
  std::vector<std::string> paths;
  for (const std::string& place : places) {
    if (!std::filesystem::is_directory(place)) paths.push_back(place);
    if (!std::filesystem::is_directory(place)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(place)) {
      if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || std::atoll(argv[1]) < 1) {
    std::fprintf(stderr, "usage: farm_soak STEPS SEED SCENARIO.yaml|FOLDER...\n");
    return 2;
  }
  try {
    for (const std::string& path : Scenarios({argv + 3, argv + argc})) {
      Soak(path, std::atoll(argv[1]), static_cast<std::uint64_t>(std::atoll(argv[2])));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "farm_soak: %s\n", error.what());
    return 1;
  }
  return 0;
}
