// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/fetch_by_value.h"

#include <string>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/training/saved_policy.h"

namespace aquafarm::agents::test {
namespace {

using aquafarm::test::MakeFarm;
using aquafarm::test::StillDisaster;

// One row of water of 9 cells, with a port at the west end and devices of rising value eastwards.
//
//   P . a . . b . . c     a: 50, b: 60, c: 90
Scenario Row() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.width = 9;
  scenario.height = 1;
  scenario.islands = {};
  scenario.rocks.cells = {};
  scenario.rocks.count = {0, 0};
  scenario.ports.cells = {{0, 0}};
  scenario.devices.sites = {{{2, 0}, DeviceKind::kMonitoring, 50.0F, false},
                            {{5, 0}, DeviceKind::kMonitoring, 60.0F, false},
                            {{8, 0}, DeviceKind::kMonitoring, 90.0F, false}};
  scenario.step_limit = 100;
  return scenario;
}

// Devices in the order of their delivery, for example "ca".
std::string Delivered(Farm& farm) {
  FetchByValue fetcher;
  std::vector<std::uint8_t> actions(farm.ships().size());
  std::string order;
  while (!farm.over()) {
    fetcher.Act(farm, actions.data());
    farm.Step(actions.data());
    for (std::size_t id = 0; id < farm.devices().size(); ++id) {
      const char name = static_cast<char>('a' + id);
      const bool is_home = farm.devices()[id].status == DeviceStatus::kDelivered;
      if (is_home && order.find(name) == std::string::npos) order += name;
    }
  }
  return order;
}

TEST(FetchByValue, FetchesTheMostValuableDeviceFirst) {
  Farm farm = MakeFarm(Row());
  EXPECT_EQ(Delivered(farm), "cba");
  EXPECT_EQ(farm.step(), 18 + 12 + 6);  // each trip: there, pickup, back, drop-off
  EXPECT_TRUE(farm.record().Success());
}

TEST(FetchByValue, SkipsADeviceThatCannotBeBroughtHome) {
  for (const auto& [limit, order] : {std::pair<int, std::string>{18, "c"},
                                     {17, "b"},
                                     {30, "cb"},
                                     {29, "ca"},
                                     {23, "c"},
                                     {24, "ca"},
                                     {5, ""}}) {
    Scenario scenario = Row();
    scenario.step_limit = limit;
    Farm farm = MakeFarm(scenario);
    EXPECT_EQ(Delivered(farm), order) << limit << " steps";
  }
}

TEST(FetchByValue, CountsTheStepsUntilTheDisasterEnds) {
  for (const auto& [duration, order] :
       {std::pair<int, std::string>{18, "c"}, {17, "b"}, {12, "b"}, {11, "a"}}) {
    Scenario scenario = Row();
    scenario.disasters = {StillDisaster(100.0F, 100.0F, {1.0F}, {-5.0F})};
    scenario.disasters[0].duration = duration;
    Farm farm = MakeFarm(scenario);
    EXPECT_EQ(Delivered(farm), order) << duration << " steps";
  }
}

TEST(FetchByValue, LoadsSeveralDevicesBeforeItReturns) {
  Scenario scenario = Row();
  scenario.ships.capacity = 3;
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(Delivered(farm), "abc");
  EXPECT_EQ(farm.step(), 8 + 3 + 8 + 1);
}

// Two ships meet head on in a channel: the one with the higher id makes way.
TEST(FetchByValue, ShipsMakeWayInAChannel) {
  Scenario scenario = Row();
  scenario.ships.count = 2;
  scenario.height = 2;
  scenario.islands = {{{3, 1}, 2, 1}};
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(Delivered(farm).size(), 3U);
  EXPECT_EQ(farm.record().collisions, 0);
  EXPECT_EQ(farm.record().crashes, 0);
}

// Slow oracle of the rule: among devices at sea that no other ship fetches and that fit into the
// remaining steps, none is more valuable than the one that a lone ship picks up.
TEST(FetchByValue, NoReachableDeviceIsWorthMoreThanTheOneFetched) {
  int pickups = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Scenario scenario = aquafarm::test::CrowdedScenario(1, 0);
    scenario.ships.capacity = 1;
    scenario.step_limit = 30 + static_cast<std::int32_t>(seed);
    Farm farm = MakeFarm(scenario);
    farm.Reset(seed, 0);
    FetchByValue fetcher;
    std::uint8_t action = 0;
    std::int32_t free_since = 0;  // step of the last drop-off
    Cell chosen_at = farm.ships()[0].cell;
    while (!farm.over()) {
      fetcher.Act(farm, &action);
      if (action == static_cast<std::uint8_t>(Action::kPickup)) {
        ++pickups;
        float fetched = 0.0F;
        float best = 0.0F;
        Grid<std::int32_t> away;
        Grid<std::int32_t> home;
        std::vector<Cell> queue;
        StepsByWater(farm.layout().cells, &chosen_at, 1, away, queue);
        StepsByWater(farm.layout().cells, farm.layout().ports.data(), farm.layout().ports.size(),
                     home, queue);
        for (const Device& device : farm.devices()) {
          if (device.status != DeviceStatus::kDeployed) continue;
          if (device.cell == farm.ships()[0].cell) fetched = std::max(fetched, device.value);
          const std::int32_t end = free_since + away(device.cell.y, device.cell.x) +
                                   home(device.cell.y, device.cell.x) + 2;
          if (end <= scenario.step_limit) best = std::max(best, device.value);
        }
        EXPECT_EQ(fetched, best) << "seed " << seed << " step " << farm.step();
      }
      farm.Step(&action);
      if (farm.ships()[0].outcome == Outcome::kOk && action == 9) {
        free_since = farm.step();
        chosen_at = farm.ships()[0].cell;
      }
    }
    EXPECT_EQ(farm.record().crashes, 0) << "seed " << seed;
    EXPECT_EQ(farm.ships()[0].aboard, 0) << "seed " << seed << ": a device was not brought home";
  }
  EXPECT_GT(pickups, 40);
}

TEST(FetchByValue, CrowdedTeamsNeitherCrashNorCollide) {
  std::int32_t delivered = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Farm farm = MakeFarm(aquafarm::test::CrowdedScenario(3, 1));
    farm.Reset(seed, 0);
    delivered += static_cast<std::int32_t>(Delivered(farm).size());
    EXPECT_EQ(farm.record().crashes, 0) << "seed " << seed;
    EXPECT_EQ(farm.record().collisions, 0) << "seed " << seed;
  }
  EXPECT_EQ(delivered, 60 * 5);
}

Evaluation EvaluationOf(const char* name, const Scenario& scenario, std::int32_t farms) {
  const SavedPolicy saved = FindPolicy(name);
  LocalEnvironment environment(Share(scenario), {farms, saved.observation_types, false, 1});
  return Evaluate(environment, *MakePolicy(saved, environment.spec()), 3, 30);
}

TEST(FetchByValue, IsAPolicyOfAnyNumberOfFarms) {
  const Scenario scenario = aquafarm::test::CrowdedScenario(2, 1);
  const Evaluation one = EvaluationOf("fetch_by_value", scenario, 1);
  EXPECT_EQ(one.mean_return, EvaluationOf("fetch_by_value", scenario, 7).mean_return);
  EXPECT_EQ(one.success_rate, 1.0);
}

TEST(DoNothing, HoldsEveryShipToTheEnd) {
  const Scenario scenario = aquafarm::test::CrowdedScenario(2, 1);
  const Evaluation evaluation = EvaluationOf("do_nothing", scenario, 4);
  EXPECT_EQ(evaluation.success_rate, 0.0);
  EXPECT_EQ(evaluation.mean_steps, 150.0);  // until the longer of the two disasters ends
  for (const EpisodeSummary& result : evaluation.episodes) {
    EXPECT_EQ(result.delivered, 0);
    EXPECT_EQ(result.crashes + result.collisions, 0);
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
