// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/team_planner.h"

#include <cmath>
#include <map>

#include "agents_fixture.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "tiny_farms.h"

namespace aquafarm::agents::test {
namespace {

using aquafarm::test::StillDisaster;

//   3 D . . o     two ships, ports at (0, 0) and (1, 0)
//   2 . # . .
//   1 . . . D
//   0 P P . .
Scenario TinyTeam() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.width = scenario.height = 4;
  scenario.islands = {{{1, 2}, 1, 1}};
  scenario.rocks.cells = {{3, 3}};
  scenario.ports.cells = {{0, 0}, {1, 0}};
  scenario.devices.sites = {{{0, 3}, DeviceKind::kMonitoring, 60.0F, false},
                            {{3, 1}, DeviceKind::kMonitoring, 80.0F, false}};
  scenario.ships.count = 2;
  scenario.rewards.sharing = RewardSharing::kTeam;
  scenario.damage.exposure_damage = 0.01F;
  scenario.step_limit = 9;
  return scenario;
}

float Play(Farm& farm, Foresight foresight) {
  TeamPlanner planner(farm.scenario(), foresight);
  TeamPlanner::PlanState course;
  std::vector<std::uint8_t> actions(farm.ships().size());
  while (!farm.over()) {
    planner.Act(farm, course, actions.data());
    farm.Step(actions.data());
  }
  return farm.record().episode_return;
}

using Actions = std::vector<std::uint8_t>;  // two per step

void Replay(const Actions& actions, Farm& farm) {
  farm.Reset(farm.seed(), farm.episode());
  for (std::size_t i = 0; i < actions.size(); i += 2) farm.Step(actions.data() + i);
}

// If ships, devices and their health are equal, only the highest return so far matters.
std::uint64_t StateOf(const Farm& farm) {
  std::uint64_t key = 0;
  for (const Ship& ship : farm.ships()) {
    key = key * 16 + static_cast<std::uint64_t>(LinearIndex(ship.cell, farm.scenario().width));
  }
  for (const Device& device : farm.devices()) {
    key = key * 8 + static_cast<std::uint64_t>(device.status) * 2 + (device.carrier == 1 ? 1U : 0U);
    key = key * 1024 + static_cast<std::uint64_t>(std::lround(device.health * 1000.0F));
  }
  return key;
}

// Tries every joint action in every reachable state, layer by layer.
float BestJointReturn(Farm& farm) {
  struct Way {
    float value{};
    Actions actions;
  };
  std::map<std::uint64_t, Way> layer{{0, {}}};
  float best = -1e9F;
  while (!layer.empty()) {
    std::map<std::uint64_t, Way> next;
    for (auto& [key, way] : layer) {
      Replay(way.actions, farm);
      const ActionMask legal[] = {farm.LegalActions(0), farm.LegalActions(1)};
      for (int joint = 0; joint < kActionCount * kActionCount; ++joint) {
        const std::uint8_t step[] = {static_cast<std::uint8_t>(joint / kActionCount),
                                     static_cast<std::uint8_t>(joint % kActionCount)};
        if (((legal[0] >> step[0]) & 1U) == 0 || ((legal[1] >> step[1]) & 1U) == 0) continue;
        Replay(way.actions, farm);
        farm.Step(step);
        const float value = farm.record().episode_return;
        if (farm.over()) {
          best = std::max(best, value);
          continue;
        }
        Way& known = next[StateOf(farm)];
        if (!known.actions.empty() && known.value >= value) continue;
        known = {value, way.actions};
        known.actions.insert(known.actions.end(), step, step + 2);
      }
    }
    layer = std::move(next);
  }
  Replay({}, farm);
  return best;
}

TEST(TeamPlanner, IsBoundedAndNearTheBestThereIs) {
  for (const float storm_x : {-9.0F, 3.0F}) {
    Scenario scenario = TinyTeam();
    DisasterSpec storm = StillDisaster(storm_x, 3.0F, {1.5F}, {-6.0F});
    storm.speed = 0.5F;
    storm.heading_deg = 180;
    scenario.disasters = {storm};
    Farm farm = aquafarm::test::MakeFarm(scenario);
    {
      farm.Reset(3, 1);
      const float best = BestJointReturn(farm);
      const double bound = TeamBound(farm);
      const float planned = Play(farm, Foresight::kOracle);
      EXPECT_LE(static_cast<double>(best), bound + 1e-3);
      EXPECT_GE(static_cast<double>(best), 0.9 * bound) << "the bound says something";
      EXPECT_LE(planned, best + 1e-3F);
      EXPECT_GE(planned, 0.95F * best);
    }
  }
}

TEST(TeamBound, CountsEachTripAloneInQuietWater) {
  Scenario scenario = TinyTeam();
  scenario.disasters.clear();
  const Farm farm = aquafarm::test::MakeFarm(scenario);
  // Distances from the nearest port: three moves to (0, 3), two moves to (3, 1).
  const double far = 20 + 60 - 3 + 20 - 3;
  const double near = 20 + 80 - 2 + 20 - 2;
  EXPECT_DOUBLE_EQ(TeamBound(farm), far + near);
}

TEST(TeamBound, CountsAPickupThatNeverGetsHome) {
  Scenario scenario = TinyTeam();
  scenario.disasters.clear();
  scenario.ships.count = 1;
  scenario.devices.sites.resize(1);
  scenario.step_limit = 5;
  Farm farm = aquafarm::test::MakeFarm(scenario);
  EXPECT_DOUBLE_EQ(TeamBound(farm), 20 - 3);
  scenario.rewards.drop_off = -100.0F;  // no delivery is worth its reward
  Farm other = aquafarm::test::MakeFarm(scenario);
  EXPECT_DOUBLE_EQ(TeamBound(other), 20 - 3);
}

TEST(TeamBound, ChargesARiskOnceWhereDevicesShareAShip) {
  Scenario scenario = TinyTeam();
  scenario.ships = {1, 2};
  scenario.damage.exposure_damage = 0.0F;
  scenario.step_limit = 40;
  scenario.disasters = {StillDisaster(1.0F, 1.0F, {9.0F}, {-6.0F})};
  Farm farm = aquafarm::test::MakeFarm(scenario);
  // The risk is everywhere: a ship with both devices pays it once, not for each device.
  Planner planner(farm.scenario());
  const double best = planner.Solve(farm, Foresight::kOracle).expected_return;
  EXPECT_GT(best, 0.0);
  EXPECT_LE(best, TeamBound(farm));
}

TEST(TeamBound, NeverCountsLessThanNothingForADeviceThatIsWornOut) {
  Scenario scenario = TinyTeam();
  scenario.ships.count = 1;
  scenario.devices.sites.resize(1);
  scenario.damage.exposure_damage = 0.5F;
  scenario.step_limit = 30;
  scenario.disasters = {StillDisaster(0.0F, 1.0F, {1.1F}, {-5.0F})};
  Farm farm = aquafarm::test::MakeFarm(scenario);
  Planner planner(farm.scenario());
  const double best = planner.Solve(farm, Foresight::kOracle).expected_return;
  EXPECT_LE(best, TeamBound(farm) + 1e-6);
}

TEST(TeamBound, RefusesRewardsForWaiting) {
  Scenario scenario = TinyTeam();
  scenario.rewards.collision = 2.0F;
  EXPECT_EQ(
      MessageOf<InputError>([&] { TeamBound(aquafarm::test::MakeFarm(scenario)); }),
      "bound: rewards.collision: got more than 0, expected at most 0; evaluate without the bound");
}

TEST(TeamPlanner, PlansAgainWhenABulletinArrives) {
  Scenario scenario = TinyTeam();
  scenario.disasters = {StillDisaster(-9.0F, 3.0F, {1.5F}, {-6.0F})};
  Farm farm = aquafarm::test::MakeFarm(scenario);
  TeamPlanner planner(farm.scenario(), Foresight::kPersistence);
  TeamPlanner::PlanState course;
  std::vector<std::uint8_t> actions(2);
  planner.Act(farm, course, actions.data());
  farm.Step(actions.data());
  planner.Act(farm, course, actions.data());
  EXPECT_EQ(course.start, 0) << "on course";
  farm.SetDisaster(0, StillDisaster(2.0F, 3.0F, {1.5F}, {-6.0F}));
  planner.Act(farm, course, actions.data());
  EXPECT_EQ(course.start, 1) << "planned again";
}

TEST(TeamBound, OfADeviceThatDrivesItselfIsItsWayHome) {
  Scenario scenario = TinyTeam();
  scenario.disasters.clear();
  scenario.ships.count = 0;
  scenario.devices.sites = {{{3, 1}, DeviceKind::kMonitoring, 80.0F, true}};
  Farm farm = aquafarm::test::MakeFarm(scenario);
  EXPECT_DOUBLE_EQ(TeamBound(farm), 80 + 20 - 2);
  EXPECT_FLOAT_EQ(Play(farm, Foresight::kOracle), 98.0F);
}

TEST(TeamPlanner, SharesOutTheWorkEvenly) {
  const Farm farm = aquafarm::test::MakeFarm(TinyTeam());
  const TeamPlanner planner(farm.scenario(), Foresight::kPersistence);
  const auto shares = planner.Assign(farm);
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_EQ(shares[0].size(), 1U);
  EXPECT_EQ(shares[1].size(), 1U);
  EXPECT_NE(shares[0], shares[1]);
}

// A person or another policy may have loaded more devices than the planner would.
TEST(TeamPlanner, TakesOverShipsWithAnyLoad) {
  Scenario scenario = TinyTeam();
  scenario.width = 10;
  scenario.ships.capacity = 8;
  scenario.devices.sites.clear();
  for (std::int32_t x = 2; x < 9; ++x) {
    scenario.devices.sites.push_back({{x, 0}, DeviceKind::kMonitoring, 60.0F, false});
  }
  scenario.devices.sites.push_back({{9, 3}, DeviceKind::kMonitoring, 60.0F, false});
  scenario.step_limit = 80;
  Farm farm = aquafarm::test::MakeFarm(scenario);
  const std::int32_t start = farm.ships()[0].cell.x;
  for (std::int32_t x = start + 1; x < 9; ++x) {
    const std::uint8_t east[] = {aquafarm::test::Act(Action::kEast),
                                 aquafarm::test::Act(Action::kDropOff)};
    farm.Step(east);
    const std::uint8_t pick_up[] = {aquafarm::test::Act(Action::kPickup),
                                    aquafarm::test::Act(Action::kDropOff)};
    if (x >= 2) farm.Step(pick_up);
  }
  ASSERT_EQ(farm.ships()[0].aboard, 7) << "more than an even share and two";
  const auto shares = TeamPlanner(scenario, Foresight::kOracle).Assign(farm);
  EXPECT_EQ(shares[1], std::vector<std::int32_t>{7}) << "the other ship has room";
  Play(farm, Foresight::kOracle);
  EXPECT_TRUE(farm.record().Success());
}

TEST(TeamPlanner, KeepsShipsOutOfEachOthersWay) {
  Scenario scenario = aquafarm::test::CrowdedScenario(4, 2);
  scenario.width = scenario.height = 14;
  scenario.ships.capacity = 1;
  scenario.disasters.clear();
  Farm farm = aquafarm::test::MakeFarm(scenario);
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    farm.Reset(5, episode);
    Play(farm, Foresight::kOracle);
    EXPECT_TRUE(farm.record().Success()) << "episode " << episode;
    EXPECT_EQ(farm.record().collisions, 0) << "episode " << episode;
  }
}

TEST(Reservations, BlockWhatTheOrderOfMovingBlocks) {
  Reservations reserved;
  reserved.Add(1, 10, {5, 6, 7});  // ship 1 at 5 now, at 6 in step 11, at 7 in step 12
  for (const std::int32_t other : {0, 2}) {
    EXPECT_TRUE(reserved.IsTaken(other, 11, 6));
    EXPECT_FALSE(reserved.IsTaken(other, 13, 6));
  }
  EXPECT_TRUE(reserved.IsTaken(2, 11, 7)) << "ship 1 is about to go there, before ship 2 leaves";
  EXPECT_FALSE(reserved.IsTaken(0, 11, 7)) << "ship 0 leaves first";
  EXPECT_TRUE(reserved.IsTaken(0, 11, 5)) << "ship 1 has not left yet when ship 0 moves";
  EXPECT_FALSE(reserved.IsTaken(2, 11, 5)) << "it has when ship 2 does";
}

}  // namespace
}  // namespace aquafarm::agents::test
