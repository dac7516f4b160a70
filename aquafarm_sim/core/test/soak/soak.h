// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Steps farms for a long time and checks invariants after each step: every device is accounted
/// for, every reward is the sum of its terms, and the mask of legal actions is correct. Also checks
/// that a farm that was saved and loaded has the same hash and continues identically.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::soak {

inline constexpr std::int64_t kSavePeriod = 1'000'000;  // steps between saves
inline constexpr int kStepsAfterLoad = 200;             // steps for which both farms are compared

class Fault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void Must(bool holds, const char* what) {
  if (!holds) throw Fault(what);
}

/// The state before a step, as far as the checks need it.
struct Before {
  std::vector<ActionMask> legal;
  std::vector<bool> active;
  std::vector<DeviceStatus> status;
  std::vector<float> health;
  double episode_return{};
  std::int32_t step{};
};

inline Before Look(const Farm& farm) {
  Before before;
  for (std::int32_t ship = 0; ship < static_cast<std::int32_t>(farm.ships().size()); ++ship) {
    before.legal.push_back(farm.LegalActions(ship));
    before.active.push_back(farm.ships()[static_cast<std::size_t>(ship)].active);
  }
  for (const Device& device : farm.devices()) {
    before.status.push_back(device.status);
    before.health.push_back(device.health);
  }
  before.episode_return = static_cast<double>(farm.record().episode_return);
  before.step = farm.step();
  return before;
}

inline bool OnMap(const Farm& farm, Cell cell) {
  return cell.x >= 0 && cell.y >= 0 && cell.x < farm.layout().cells.cols() &&
         cell.y < farm.layout().cells.rows();
}

inline void CheckDevices(const Farm& farm, const Before& before) {
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

inline void CheckShips(const Farm& farm, const Before& before,
                       const std::vector<std::uint8_t>& actions) {
  for (std::size_t i = 0; i < farm.ships().size(); ++i) {
    const Ship& ship = farm.ships()[i];
    if (!before.active[i]) continue;
    Must(OnMap(farm, ship.cell), "a ship is off the map");
    Must((farm.layout().bits(ship.cell) & kBlockedBits) == 0, "a ship is on land or a rock");
    const auto action = static_cast<Action>(actions[i]);
    const bool illegal = action != Action::kHold && (before.legal[i] & MaskOf(action)) == 0;
    Must((ship.terms.illegal != 0.0F) == illegal, "the mask of legal actions is wrong");
  }
}

inline void CheckRewards(const Farm& farm, const Before& before) {
  const bool team = farm.scenario().rewards.sharing == RewardSharing::kTeam;
  float sum = 0.0F;
  for (std::size_t i = 0; i < farm.ships().size(); ++i) {
    const Ship& ship = farm.ships()[i];
    if (!before.active[i]) continue;
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

/// Chooses the actions of all ships for the next step.
/// @param legal legal actions by ship
/// @param actions result, one Action per ship; illegal actions are allowed
using Chooser = std::function<void(const Farm& farm, const std::vector<ActionMask>& legal,
                                   std::mt19937_64& rng, std::vector<std::uint8_t>& actions)>;

/// Takes one checked step.
inline void Step(Farm& farm, const Chooser& choose, std::mt19937_64& rng,
                 std::vector<std::uint8_t>& actions) {
  const Before before = Look(farm);
  actions.resize(farm.ships().size());
  choose(farm, before.legal, rng, actions);
  farm.Step(actions.data());
  CheckDevices(farm, before);
  CheckShips(farm, before, actions);
  CheckRewards(farm, before);
}

/// Saves a farm, loads it into another one, and checks that both continue identically.
inline void CheckLoad(Farm& farm, Farm& other, const Chooser& choose, std::mt19937_64& rng,
                      std::vector<std::uint8_t>& actions) {
  other.Load(farm.Save());
  Must(other.Hash() == farm.Hash(), "the hash differs after save and load");
  for (int i = 0; i < kStepsAfterLoad && !farm.over(); ++i) {
    Step(farm, choose, rng, actions);
    other.Step(actions.data());
    Must(other.Hash() == farm.Hash(), "a loaded farm continues differently");
  }
}

/// Creates the chooser for a scenario. The scenario outlives the chooser.
/// @throws InputError if the chooser does not support the scenario, which is then left out
using MakeChooser = std::function<Chooser(const std::shared_ptr<const Scenario>& scenario)>;

/// Takes `steps` checked steps in a scenario and prints a summary line.
/// @throws Fault if a check fails; the message contains scenario, seed, episode and step
inline void Soak(const std::string& path, std::int64_t steps, std::uint64_t seed,
                 const MakeChooser& make) {
  const auto scenario = std::make_shared<const Scenario>(LoadScenario(path));
  Chooser choose;
  try {
    choose = make(scenario);
  } catch (const InputError& error) {
    std::printf("%s: left out: %s\n", path.c_str(), error.what());
    return;
  }
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
      Step(farm, choose, rng, actions);
      if (++since < std::min(kSavePeriod, steps / 2) || farm.over()) continue;
      since = 0;
      ++saves;
      CheckLoad(farm, other, choose, rng, actions);
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
inline std::vector<std::string> Scenarios(const std::vector<std::string>& places) {
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

/// Runs a program with the usage PROGRAM STEPS SEED SCENARIO.yaml|FOLDER... It takes STEPS steps in
/// each scenario.
/// @returns the exit code: 0 without a fault, 1 after the first fault, which is printed, or 2 for
///   invalid arguments
inline int Main(int argc, char** argv, const char* name, const MakeChooser& make) {
  if (argc < 4 || std::atoll(argv[1]) < 1) {
    std::fprintf(stderr, "usage: %s STEPS SEED SCENARIO.yaml|FOLDER...\n", name);
    return 2;
  }
  try {
    for (const std::string& path : Scenarios({argv + 3, argv + argc})) {
      Soak(path, std::atoll(argv[1]), static_cast<std::uint64_t>(std::atoll(argv[2])), make);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 1;
  }
  return 0;
}

}  // namespace aquafarm::soak
