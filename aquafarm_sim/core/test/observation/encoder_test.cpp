// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::CrowdedScenario;
using test::MakeFarm;
using test::StepOne;
using test::StillDisaster;
using test::TinyScenario;

TEST(TabularIndex, CountsTheStatusSetsOfTheRules) {
  Scenario scenario;  // 25 × 25, 3 devices, capacity 1
  EXPECT_EQ(Encoder(scenario).state_count(), 625U * (8 + 3 * 4));
  scenario.ships.capacity = 3;
  EXPECT_EQ(Encoder(scenario).state_count(), 625U * 27);
  scenario.devices.count = 14;
  scenario.width = scenario.height = 1000;
  EXPECT_EQ(Encoder(scenario).state_count(), 0U) << "too many for a table";
  scenario.devices.count = 40;
  EXPECT_EQ(Encoder(scenario).state_count(), 0U);
}

TEST(TabularIndex, ThePapersCountsAreMisprints) {
  // Factors of the paper: each device is delivered or not, independent of its carrier. Counted on a
  // farm of the same size: |O| = 25·25·2³ = 5,000 (printed: 32,000); |S| = |O|·4 ports = 20,000
  // (printed: 128,000).
  Scenario scenario;
  scenario.width = scenario.height = 25;
  scenario.devices.count = 3;
  scenario.ports.count = 4;
  const Encoder encoder(scenario);
  std::set<std::vector<std::int32_t>> observations;
  for (std::uint32_t index = 0; index < encoder.state_count(); ++index) {
    const Encoder::TabularState state = encoder.Decode(index);
    std::vector<std::int32_t> observation{state.cell.x, state.cell.y};
    for (const DeviceStatus status : state.status) {
      observation.push_back(status == DeviceStatus::kDelivered ? 1 : 0);
    }
    observations.insert(observation);
  }
  EXPECT_EQ(observations.size(), 5000U);
  EXPECT_EQ(observations.size() * static_cast<std::size_t>(scenario.ports.count), 20000U);
}

TEST(TabularIndex, ATinyFarmReachesExactlyItsStates) {
  // 3 × 3 cells, an island in a corner, two devices: 8 water cells, 2² + 2·2 = 8 status sets.
  Scenario scenario = TinyScenario();
  scenario.width = scenario.height = 3;
  scenario.islands = {{{0, 0}, 1, 1}};
  scenario.rocks.count = {0, 0};
  scenario.rocks.cells.clear();
  scenario.ports.cells = {{1, 0}};
  scenario.devices.sites = {{{2, 2}, DeviceKind::kMonitoring, 80.0F, false},
                            {{0, 2}, DeviceKind::kMonitoring, 70.0F, false}};
  scenario.step_limit = 2000;
  Farm farm = MakeFarm(scenario);
  const Encoder encoder(farm.scenario());
  EXPECT_EQ(encoder.state_count(), 9U * 8);
  std::set<std::uint32_t> seen;
  RandomStream rng({1, 0, RngStream::kExploration, 0});
  for (std::uint64_t episode = 0; episode < 200; ++episode) {
    farm.Reset(1, episode);
    seen.insert(encoder.Index(farm, 0));
    while (!farm.over()) {
      StepOne(farm, static_cast<Action>(rng.Below(kActionCount)));
      const std::uint32_t index = encoder.Index(farm, 0);
      ASSERT_LT(index, encoder.state_count());
      const Encoder::TabularState state = encoder.Decode(index);
      EXPECT_EQ(state.cell, farm.ships()[0].cell);
      for (std::size_t d = 0; d < 2; ++d) EXPECT_EQ(state.status[d], farm.devices()[d].status);
      seen.insert(index);
    }
  }
  // The state with all devices delivered is only reached in the port: 8 cells × 7 sets plus one.
  EXPECT_EQ(seen.size(), 8U * 7 + 1);
}

TEST(TabularIndex, WhatAnotherShipHasIsGone) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 2;
  Farm farm = MakeFarm(scenario);
  const Encoder encoder(farm.scenario());
  for (const Action action : {Action::kNorth, Action::kNorth, Action::kPickup}) {
    const std::uint8_t codes[] = {test::Act(action), test::Act(Action::kHold)};
    farm.Step(codes);
  }
  EXPECT_EQ(encoder.Decode(encoder.Index(farm, 0)).status[0], DeviceStatus::kAboard);
  EXPECT_EQ(encoder.Decode(encoder.Index(farm, 1)).status[0], DeviceStatus::kDelivered);
}

std::vector<float> FeaturesOf(const Farm& farm, std::int32_t ship) {
  const Encoder encoder(farm.scenario());
  View view;
  Observe(farm, ship, view);
  constexpr float kGuard = -777.0F;
  std::vector<float> features(static_cast<std::size_t>(encoder.feature_count()) + 1, kGuard);
  encoder.Features(view, features.data());
  EXPECT_EQ(features.back(), kGuard) << "wrote past feature_count";
  features.pop_back();
  EXPECT_EQ(std::count(features.begin(), features.end(), kGuard), 0) << "left one unwritten";
  EXPECT_EQ(encoder.feature_names().size(), features.size());
  return features;
}

float Feature(const Farm& farm, const std::string& name, std::int32_t ship = 0) {
  const Encoder encoder(farm.scenario());
  const std::vector<std::string> names = encoder.feature_names();
  const auto at = std::find(names.begin(), names.end(), name);
  EXPECT_NE(at, names.end()) << name;
  return FeaturesOf(farm, ship)[static_cast<std::size_t>(at - names.begin())];
}

TEST(Features, AreAsManyAsNamedOnEveryFarm) {
  EXPECT_EQ(FeaturesOf(MakeFarm(TinyScenario()), 0).size(), 5U + 8 + 5 + 2);
  Farm crowded = MakeFarm(CrowdedScenario(3, 2));
  EXPECT_EQ(FeaturesOf(crowded, 4).size(), 5U + 8 + 5 * 5 + 2 * 2 + 2 * 7 + 4 * 4 + 5);
}

TEST(Features, OfKindsAreThoseOfDevicesAndKnownDisasters) {
  Scenario scenario = TinyScenario();
  scenario.devices.sites.push_back({{2, 3}, DeviceKind::kDeepWaterBreeding, 80.0F, false});
  scenario.disasters = {StillDisaster(4, 2, {1}, {-10}), StillDisaster(90, 90, {1}, {-10})};
  scenario.disasters[0].kind = DisasterKind::kRedTide;
  scenario.disasters[0].grade = 3;
  scenario.view = {ViewMode::kPartial, 5.0F, 0, 0.0F};
  const std::size_t without = FeaturesOf(MakeFarm(scenario), 0).size();
  scenario.view.kinds = true;
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(FeaturesOf(farm, 0).size(), without + 2 * 4 + 2 * 7);
  EXPECT_EQ(Feature(farm, "device0.monitoring"), 1.0F);
  EXPECT_EQ(Feature(farm, "device0.deep_water_breeding"), 0.0F);
  EXPECT_EQ(Feature(farm, "device1.deep_water_breeding"), 1.0F);
  EXPECT_EQ(Feature(farm, "disaster0.red_tide"), 1.0F);
  EXPECT_EQ(Feature(farm, "disaster0.typhoon"), 0.0F);
  EXPECT_EQ(Feature(farm, "disaster0.grade"), 0.75F);
  EXPECT_EQ(Feature(farm, "disaster1.typhoon"), 0.0F) << "not known";
  EXPECT_EQ(Feature(farm, "disaster1.grade"), 0.0F);
}

TEST(Features, HaveNoNegativeTimeLeftUnderALongerDisasterSetInPlay) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {StillDisaster(20, 20, {1}, {-5})};
  scenario.disasters[0].duration = 2;
  Farm farm = MakeFarm(scenario);
  DisasterSpec longer = scenario.disasters[0];
  longer.duration = 50;
  farm.SetDisaster(0, longer);
  for (int step = 0; step < 6; ++step) {
    EXPECT_EQ(Feature(farm, "time_left", 0),
              step < 2 ? 1.0F - static_cast<float>(step) / 2.0F : 0.0F)
        << step;
    StepOne(farm, Action::kHold);
  }
  EXPECT_FALSE(farm.over()) << "the longer disaster keeps the episode going";
}

// The scale is the energy of 400 straight moves of 1 km with 2 + 0.5 kWh.
TEST(Features, HaveTheEnergyUsedWhereItIsInTheReward) {
  Scenario scenario = TinyScenario();
  scenario.step_limit = 400;
  scenario.energy = EnergySpec{0.0, {2.0, 0.5, 0.4, 0.5}, {}};
  EXPECT_EQ(FeaturesOf(MakeFarm(scenario), 0).size(), 5U + 8 + 5 + 2);
  scenario.energy->weight = 0.1;
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(FeaturesOf(farm, 0).size(), 5U + 8 + 5 + 2 + 1);
  EXPECT_EQ(Feature(farm, "energy_used"), 0.0F);
  StepOne(farm, Action::kNorth);
  EXPECT_NEAR(Feature(farm, "energy_used"), 1.0F / 400.0F, 1e-8F);
  StepOne(farm, Action::kHold);
  EXPECT_NEAR(Feature(farm, "energy_used"), 1.2F / 400.0F, 1e-8F);
}

TEST(Features, DistinguishSeveralAgentsAndTheCargoOfTheOthers) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 2;
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(Feature(farm, "agent0.self", 0), 1.0F);
  EXPECT_EQ(Feature(farm, "agent1.self", 0), 0.0F);
  EXPECT_EQ(Feature(farm, "agent0.self", 1), 0.0F);
  EXPECT_EQ(Feature(farm, "agent1.self", 1), 1.0F);
  EXPECT_EQ(Feature(farm, "other0.aboard", 1), 0.0F);
  for (const Action action : {Action::kNorth, Action::kNorth, Action::kPickup}) {
    const std::uint8_t codes[] = {test::Act(action), test::Act(Action::kHold)};
    farm.Step(codes);
  }
  EXPECT_EQ(Feature(farm, "other0.aboard", 1), 1.0F);
  EXPECT_EQ(Feature(farm, "other0.aboard", 0), 0.0F);
}

TEST(Features, SayWhereThingsAre) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {StillDisaster(4, 2, {1}, {-10})};
  Farm farm = MakeFarm(scenario);
  EXPECT_FLOAT_EQ(Feature(farm, "device0.north"), 2.0F / 5.0F);
  EXPECT_EQ(Feature(farm, "device0.east"), 0.0F);
  EXPECT_EQ(Feature(farm, "device0.deployed"), 1.0F);
  EXPECT_FLOAT_EQ(Feature(farm, "device0.worth"), 0.8F);
  EXPECT_EQ(Feature(farm, "blocked.south"), 1.0F);
  EXPECT_EQ(Feature(farm, "blocked.west"), 1.0F);
  EXPECT_EQ(Feature(farm, "blocked.north"), 0.0F);
  EXPECT_FLOAT_EQ(Feature(farm, "disaster0.east"), 2.0F / 5.0F);
  EXPECT_EQ(Feature(farm, "free_capacity"), 1.0F);
  for (const Action action : {Action::kNorth, Action::kNorth, Action::kPickup}) {
    StepOne(farm, action);
  }
  EXPECT_EQ(Feature(farm, "device0.aboard"), 1.0F);
  EXPECT_EQ(Feature(farm, "free_capacity"), 0.0F);
  EXPECT_FLOAT_EQ(Feature(farm, "time_left"), 1.0F - 3.0F / 1000.0F);
}

TEST(Features, HaveTheRouteToPortsAndToDeployedDevices) {
  Scenario scenario = TinyScenario();
  scenario.view.routes = true;
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(FeaturesOf(farm, 0).size(), 5U + 8 + 5 + 2 + 2 * 3);
  EXPECT_EQ(Feature(farm, "device0.way_east"), 0.0F);
  EXPECT_EQ(Feature(farm, "device0.way_north"), 1.0F);
  EXPECT_FLOAT_EQ(Feature(farm, "device0.way_steps"), 2.0F / 5.0F);
  EXPECT_EQ(Feature(farm, "port0.way_north"), 0.0F);
  EXPECT_EQ(Feature(farm, "port0.way_steps"), 0.0F);
  for (const Action action : {Action::kNorth, Action::kNorth, Action::kPickup, Action::kWest}) {
    StepOne(farm, action);
  }
  EXPECT_EQ(Feature(farm, "device0.way_steps"), 0.0F);  // the device is aboard
  EXPECT_EQ(Feature(farm, "port0.way_east"), 1.0F);
  EXPECT_EQ(Feature(farm, "port0.way_north"), -1.0F);
  EXPECT_FLOAT_EQ(Feature(farm, "port0.way_steps"), 2.0F / 5.0F);

  Scenario crowded = CrowdedScenario(3, 2);
  crowded.view.routes = true;
  EXPECT_EQ(FeaturesOf(MakeFarm(crowded), 4).size(),
            5U + 8 + 5 * 5 + 2 * 2 + 2 * 7 + 4 * 4 + 5 + (2 + 3) * 3);
}

/// Compares the features of the risks ahead with an oracle that maps a cell and a number of steps
/// to a risk. @returns the number of positions with a risk
template <typename Oracle>
int ExpectCourses(const Farm& farm, const Oracle& risk_ahead) {
  const Cell self = farm.ships()[0].cell;
  std::vector<float> sums(kMoveCount + 1);
  int risky = 0;
  for (int step = 1; step <= 6; ++step) {
    for (std::size_t move = 0; move <= kMoveCount; ++move) {
      const Cell by = move < kMoveCount ? kMoves[move] : Cell{0, 0};
      const Cell to{std::clamp(self.x + step * by.x, 0, farm.scenario().width - 1),
                    std::clamp(self.y + step * by.y, 0, farm.scenario().height - 1)};
      const float risk = risk_ahead(to, step) / 20.0F;
      risky += risk != 0.0F ? 1 : 0;
      sums[move] += risk;
      if (step > 1 || move == kMoveCount) continue;
      EXPECT_FLOAT_EQ(Feature(farm, "risk." + std::string(ToString(static_cast<Action>(move)))),
                      risk);
    }
  }
  for (std::size_t move = 0; move < kMoveCount; ++move) {
    EXPECT_NEAR(Feature(farm, "course." + std::string(ToString(static_cast<Action>(move)))),
                sums[move] / 6.0F, 1e-6);
  }
  EXPECT_NEAR(Feature(farm, "course.stay"), sums[kMoveCount] / 6.0F, 1e-6);
  return risky;
}

TEST(Features, HaveTheBlockedMovesWhereTheyAreSaidToBe) {
  for (const int ships : {1, 3}) {
    const Scenario scenario = CrowdedScenario(ships, 0);
    const std::vector<std::string> names = Encoder(scenario).feature_names();
    for (int move = 0; move < kMoveCount; ++move) {
      EXPECT_EQ(names[static_cast<std::size_t>(kFirstBlockedFeature + move)],
                "blocked." + std::string(ToString(static_cast<Action>(move))));
    }
  }
}

/// Compares the features with the disasters themselves, moved step by step, and the sea.
void ExpectCoursesInPlay(Scenario scenario) {
  scenario.view.lookahead_risk = true;
  Farm farm = MakeFarm(std::move(scenario));
  int risky = 0;
  for (int round = 0; round < 40; ++round) {
    StepOne(farm, static_cast<Action>(round % kMoveCount));
    risky += ExpectCourses(farm, [&](Cell cell, int steps) {
      std::vector<Disaster> ahead = farm.disasters();
      for (Disaster& disaster : ahead) {
        for (int i = 0; i < steps; ++i) {
          disaster.x += disaster.dx;
          disaster.y += disaster.dy;
        }
      }
      return std::min(RiskAt(ahead, cell), farm.scenario().SeaRiskAt(cell));
    });
  }
  EXPECT_GT(risky, 200);
}

TEST(Features, HaveTheRiskForecastAlongEachCourse) {
  Scenario scenario = CrowdedScenario(1, 0);
  ExpectCoursesInPlay(scenario);
  // Rings by quadrants, of which one is absent in a quadrant; one storm ends before the other.
  scenario.disasters[0].quadrants = {{1.0F, 0.5F, 0.0F, 1.0F}, {2.5F, 2.0F, 1.0F, 1.5F}};
  scenario.disasters[0].duration = 20;
  ExpectCoursesInPlay(scenario);
  scenario.seas.emplace();
  for (int i = 0; i < scenario.CellCount(); ++i) {
    scenario.seas->risk.push_back(i % 5 == 0 ? -7.0F : 0.0F);
  }
  ExpectCoursesInPlay(scenario);
}

TEST(Features, HaveTheRiskOfTheSeaAlongEachCourse) {
  Scenario scenario = CrowdedScenario(1, 0);
  scenario.view.lookahead_risk = true;
  scenario.disasters.clear();
  scenario.seas.emplace();
  for (int i = 0; i < scenario.CellCount(); ++i) {
    scenario.seas->risk.push_back(i % 3 == 0 ? 0.0F : -5.0F - static_cast<float>(i % 7));
  }
  Farm farm = MakeFarm(scenario);
  int risky = 0;
  for (int round = 0; round < 10; ++round) {
    StepOne(farm, static_cast<Action>(round % kMoveCount));
    risky += ExpectCourses(farm, [&](Cell cell, int) {
      const auto index = static_cast<std::size_t>(cell.y * scenario.width + cell.x);
      return scenario.seas->risk[index];
    });
  }
  EXPECT_GT(risky, 200);
}

// Out of sight a disaster is assumed to have kept the motion of the last bulletin since its issue.
TEST(Features, HaveTheRiskThatAnOldBulletinLeadsToExpect) {
  Scenario scenario = CrowdedScenario(1, 0);
  scenario.damage.crash_probability = 0.0F;
  scenario.view = {ViewMode::kPartial, 0.5F, 9, 0.0F};
  scenario.view.lookahead_risk = true;
  DisasterSpec west = StillDisaster(-5.0F, 4.0F, {2.0F, 5.0F}, {-15.0F, -6.0F});
  west.speed = 0.15F;
  west.heading_deg = 90;
  DisasterSpec east = StillDisaster(16.0F, 4.0F, {2.0F, 5.0F}, {-15.0F, -6.0F});
  east.speed = 0.1F;
  east.heading_deg = 270;
  scenario.disasters = {west, east};
  Farm farm = MakeFarm(scenario);
  int risky = 0;
  int old = 0;
  View view;
  for (int round = 1; round <= 26 && !farm.over(); ++round) {
    StepOne(farm, static_cast<Action>(round % kMoveCount));
    Observe(farm, 0, view);
    if (view.disasters[0].visible || view.disasters[1].visible) continue;
    old += view.disasters[0].age > 0 ? 1 : 0;
    risky += ExpectCourses(farm, [&](Cell cell, int steps) {
      std::vector<Disaster> ahead = farm.disasters();
      const auto since = static_cast<float>(round % 9 + steps);
      ahead[0].x = farm.BulletinOf(0).x + 0.15F * since;
      ahead[1].x = farm.BulletinOf(1).x - 0.1F * since;
      return RiskAt(ahead, cell);
    });
  }
  EXPECT_GT(risky, 100);
  EXPECT_GT(old, 10);
}

// Slow oracle: computes the planes cell by cell with look-ups.
std::vector<std::uint8_t> SlowPlanes(const View& view) {
  const Layout& layout = *view.layout;
  const int width = view.scenario->width;
  const int height = view.scenario->height;
  const auto byte = [](float part) {
    return static_cast<std::uint8_t>(std::min(std::max(part, 0.0F), 1.0F) * 255.0F + 0.5F);
  };
  std::vector<std::uint8_t> planes;
  for (int plane = 0; plane < Encoder::kPlaneCount; ++plane) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Cell cell{x, y};
        float part = 0.0F;
        if (plane == 2) part = -layout.crash_reward(y, x) / 20.0F;
        if (plane == 3) part = (layout.bits(cell) & kPortBit) != 0 ? 1.0F : 0.0F;
        for (const KnownDevice& device : view.devices) {
          const bool here = device.cell == cell && device.status == DeviceStatus::kDeployed;
          if (plane == 4 && here) part = device.health * device.value * (1.0F / 100.0F);
          if (plane == 6 && device.aboard_self && view.self == cell) {
            part += device.health * device.value * (1.0F / 100.0F);
          }
        }
        if (plane == 6) part /= static_cast<float>(view.capacity);
        if (plane == 5) part = view.active && view.self == cell ? 1.0F : 0.0F;
        for (const KnownShip& other : view.others) {
          if (plane == 7 && other.visible && other.cell == cell) part = 1.0F;
        }
        for (const KnownDisaster& known : view.disasters) {
          if (plane > 1 || !known.known) continue;
          ObservableDisaster disaster = known.belief;
          const float ahead = static_cast<float>(known.age) + 10.0F;
          if (plane == 1) {
            disaster.x += ahead * disaster.dx;
            disaster.y += ahead * disaster.dy;
          }
          const float risk =
              RiskOf(disaster, static_cast<float>(cell.x), static_cast<float>(cell.y));
          part = std::max(part, -risk * (1.0F / 20.0F));
        }
        planes.push_back(byte(part));
      }
    }
  }
  return planes;
}

TEST(Planes, AgreeWithTheSlowOracleOnRandomFarms) {
  for (const bool partial : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Scenario scenario = CrowdedScenario(2, 1);
      scenario.width = seed % 2 == 0 ? 12 : 90;  // also wider than a block of columns
      scenario.disasters[0].radii = {1.0F, 3.5F, 6.0F, 30.0F};
      scenario.disasters[0].risks = {-20.0F, -15.0F, -10.0F, -5.0F};
      if (partial) scenario.view = {ViewMode::kPartial, 2.0F, 7, 1.5F};
      Farm farm = MakeFarm(scenario);
      farm.Reset(seed, 0);
      RandomStream rng({seed, 0, RngStream::kExploration, 0});
      const Encoder encoder(farm.scenario());
      View view;
      std::vector<std::uint8_t> planes(encoder.planes_size(), 99);
      while (!farm.over()) {
        std::vector<std::uint8_t> codes(farm.ships().size());
        for (auto& code : codes) code = static_cast<std::uint8_t>(rng.Below(kActionCount));
        farm.Step(codes.data());
        if (farm.step() % 9 != 0) continue;
        const auto ship = static_cast<std::int32_t>(rng.Below(3));
        Observe(farm, ship, view);
        encoder.Planes(view, planes.data());
        ASSERT_EQ(planes, SlowPlanes(view)) << "seed " << seed << " step " << farm.step();
      }
    }
  }
}

TEST(Planes, HaveANameEach) {
  EXPECT_EQ(Encoder::plane_names().size(), static_cast<std::size_t>(Encoder::kPlaneCount));
}

}  // namespace
}  // namespace aquafarm
