// SPDX-License-Identifier: BSD-3-Clause
// Plans where the damage depends on the kinds of devices and disasters, on quadrants and on grades.
// The golden test compares plans with test/golden/kinds_route.txt, which
// AQUAFARM_UPDATE_GOLDEN=1 build/planner_kinds_test writes again.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "agents_fixture.h"
#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "aquafarm/agents/planning/team_planner.h"
#include "planning/brute_force.h"

namespace aquafarm::agents {
namespace {

using test::BruteForce;
using test::ExpectBruteForce;
using test::Play;

float& FactorOf(Scenario& scenario, DeviceKind device, DisasterKind disaster) {
  return scenario.damage
      .kinds[static_cast<std::size_t>(device)][static_cast<std::size_t>(disaster)];
}

// A cage and a buoy under a storm and a red tide, which differ in what they damage.
Scenario KindsScenario(std::int32_t duration, float exposure, std::int32_t capacity) {
  Scenario scenario = test::TinyScenario(duration, exposure, capacity);
  scenario.devices.sites[0].kind = DeviceKind::kTemporaryBreeding;
  scenario.devices.sites[1].value = 40.0F;
  DisasterSpec tide = scenario.disasters[0];
  tide.kind = DisasterKind::kRedTide;
  tide.radii = {1.5F, 2.5F};
  tide.risks = {-9.0F, -6.0F};
  tide.radius_growth = 0.1F;
  scenario.disasters.push_back(tide);
  FactorOf(scenario, DeviceKind::kTemporaryBreeding, DisasterKind::kRedTide) = 3.0F;
  FactorOf(scenario, DeviceKind::kTemporaryBreeding, DisasterKind::kTyphoon) = 0.5F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kRedTide) = 0.0F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kTyphoon) = 1.5F;
  return scenario;
}

TEST(PlannerOfKinds, EqualsBruteForce) {
  for (const float exposure : {0.005F, 0.03F}) {  // 0.03: health is clamped at 0
    for (const std::int32_t capacity : {1, 2}) {
      SCOPED_TRACE(std::to_string(exposure) + " and capacity " + std::to_string(capacity));
      ExpectBruteForce(KindsScenario(8, exposure, capacity), 4);
    }
  }
}

TEST(PlannerOfKinds, EqualsBruteForceWithQuadrantsAndARiskySea) {
  Scenario scenario = KindsScenario(8, 0.02F, 1);
  DisasterSpec& storm = scenario.disasters[0];
  storm.quadrants = {{0.8F, 0.0F, 0.5F, 0.8F}, {3.0F, 0.5F, 1.7F, 1.0F}};
  storm.radii = {0.8F, 3.0F};
  scenario.seas = SeaSpec{{}, std::vector<float>(12, 0.0F), {}};
  scenario.seas->risk[9] = -6.0F;  // position of a waiting device, (1, 2)
  ExpectBruteForce(scenario, 4);
}

// The grade of the storm rises from 1 to 4 on its way, and its risks with it.
TEST(PlannerOfKinds, EqualsBruteForceWhereAStormGrowsStronger) {
  Scenario scenario = KindsScenario(8, 0.02F, 1);
  scenario.disasters[0].grade = 4;
  scenario.disasters[0].grade_factors = {0.5F, 0.75F, 1.0F, 1.5F};
  DisasterSpec& tide = scenario.disasters[1];
  tide.grade_factors = {0.6F, 0.8F, 1.0F, 2.0F};
  tide.radius_growth = 0.0F;
  const GradeRisks risks = RisksByGrade(tide);
  tide.track = {{0.0F, -2.0F, 1.0F, 1, tide.radii, risks[0], {}},
                {3.0F, 0.0F, 1.0F, 3, tide.radii, risks[2], {}},
                {8.0F, 3.0F, 2.0F, 4, tide.radii, risks[3], {}}};
  tide.grade = 1;
  ExpectBruteForce(scenario, 4);
}

// Energy in the reward, kinds, rings by quadrant, and a storm whose grade rises.
TEST(PlannerOfKinds, EqualsBruteForceWithEverythingOn) {
  for (const std::int32_t capacity : {1, 2}) {
    SCOPED_TRACE(capacity);
    Scenario scenario = KindsScenario(8, 0.02F, capacity);
    scenario.energy = EnergySpec{0.7, {1.0, 0.8, 0.6, 0.1}, {1.0, 0.8, 0.6, 0.1}};
    DisasterSpec& storm = scenario.disasters[0];
    storm.grade_factors = {0.5F, 0.75F, 1.0F, 1.5F};
    storm.quadrants = {{0.8F, 0.0F, 0.5F, 0.8F}, {3.0F, 0.5F, 1.7F, 1.0F}};
    storm.radii = {0.8F, 3.0F};
    const GradeRisks risks = RisksByGrade(storm);
    storm.track = {{0.0F, -1.0F, 1.0F, 2, storm.radii, risks[1], storm.quadrants},
                   {4.0F, 1.0F, 2.0F, 3, storm.radii, risks[2], storm.quadrants},
                   {8.0F, 3.0F, 1.0F, 4, storm.radii, risks[3], storm.quadrants}};
    storm.grade = 2;
    ExpectBruteForce(scenario, 3);
  }
}

// Disasters that keep their motion, so that the assumption of `planner` is the truth.
TEST(PlannerOfKinds, OfTheHeadingEqualsBruteForceWhereDisastersKeepIt) {
  Scenario scenario = KindsScenario(8, 0.02F, 1);
  for (DisasterSpec& disaster : scenario.disasters) {
    disaster.turn_probability = 0.0F;
    disaster.grade_factors = {0.5F, 0.75F, 1.0F, 1.5F};
    disaster.grade = 4;
  }
  ValidateScenario(scenario);
  const auto shared = std::make_shared<const Scenario>(scenario);
  Planner planner(*shared);
  Farm farm(shared);
  for (std::uint64_t episode = 0; episode < 4; ++episode) {
    farm.Reset(5, episode);
    std::map<std::string, double> seen;
    EXPECT_NEAR(planner.Solve(farm, Foresight::kPersistence).expected_return,
                BruteForce(farm, seen), 1e-3)
        << "episode " << episode;
  }
}

TEST(TeamPlannerOfKinds, OfOneShipEqualsBruteForce) {
  const auto scenario = std::make_shared<const Scenario>(KindsScenario(8, 0.02F, 1));
  TeamPlanner planner(*scenario, Foresight::kOracle);
  Farm farm(scenario);
  for (std::uint64_t episode = 0; episode < 4; ++episode) {
    farm.Reset(5, episode);
    std::map<std::string, double> seen;
    const double expected = BruteForce(farm, seen);
    TeamPlanner::PlanState course;
    while (!farm.over()) {
      std::uint8_t action = 0;
      planner.Act(farm, course, &action);
      farm.Step(&action);
    }
    EXPECT_NEAR(static_cast<double>(farm.ships()[0].episode_return), expected, 1e-3) << episode;
  }
}

TEST(TeamBoundOfKinds, HoldsForTwoShips) {
  for (std::uint64_t episode = 0; episode < 6; ++episode) {
    Scenario scenario = KindsScenario(30, 0.01F, 1);
    scenario.ships.count = 2;
    const auto shared = std::make_shared<const Scenario>(scenario);
    TeamPlanner planner(*shared, Foresight::kOracle);
    Farm farm(shared);
    farm.Reset(5, episode);
    const double bound = TeamBound(farm);
    TeamPlanner::PlanState course;
    while (!farm.over()) {
      std::uint8_t actions[2] = {};
      planner.Act(farm, course, actions);
      farm.Step(actions);
    }
    EXPECT_LE(static_cast<double>(farm.record().episode_return), bound + 1e-2) << episode;
  }
}

TEST(DisasterRisk, OfAKindIsTheDamagingRiskOfTheFarm) {
  const auto scenario = std::make_shared<const Scenario>(KindsScenario(20, 0.02F, 1));
  Farm farm(scenario);
  farm.Reset(5, 2);
  Farm start(scenario);
  start.Reset(5, 2);
  DisasterRisk risks(start, Foresight::kOracle);
  constexpr auto kHold = static_cast<std::uint8_t>(Action::kHold);
  float worst = 0.0F;
  for (std::int32_t step = 1; step <= 20; ++step) {
    farm.Step(&kHold);
    const RiskLayers& layers = risks.At(step);
    for (const DeviceKind kind : {DeviceKind::kTemporaryBreeding, DeviceKind::kMonitoring}) {
      for (std::int32_t i = 0; i < scenario->CellCount(); ++i) {
        const float risk = farm.DamagingRiskAt({i % 4, i / 4}, kind);
        EXPECT_EQ(layers.Damaging(kind).data()[i], risk) << step;
        worst = std::min(worst, risk);
      }
    }
  }
  EXPECT_LT(worst, kWorstRisk) << "a factor above 1 was met";
}

// A red tide over the whole farm; a port in the middle, one device to the west and one to the east.
Scenario TideScenario(DeviceKind west, DeviceKind east) {
  Scenario scenario;
  scenario.name = "kinds";
  scenario.width = 11;
  scenario.height = 3;
  scenario.rocks.count = {0, 0};
  scenario.ports.cells = {{5, 1}};
  scenario.devices.placement = DevicePlacement::kExplicit;
  scenario.devices.sites = {{{1, 1}, west, 80.0F, false}, {{9, 1}, east, 80.0F, false}};
  scenario.damage.exposure_damage = 0.001F;
  DisasterSpec tide = aquafarm::test::StillDisaster(5.0F, 1.0F, {20.0F}, {-5.0F});
  tide.kind = DisasterKind::kRedTide;
  tide.duration = 60;
  scenario.disasters = {tide};
  FactorOf(scenario, DeviceKind::kTemporaryBreeding, DisasterKind::kRedTide) = 4.0F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kRedTide) = 0.0F;
  return scenario;
}

std::string RouteOf(DeviceKind west, DeviceKind east) {
  const auto scenario = test::Share(TideScenario(west, east));
  Farm farm(scenario);
  farm.Reset(1, 0);
  std::ostringstream text;
  for (const Device& device : farm.devices()) {
    text << ToString(device.kind) << " at (" << device.cell.x << ", " << device.cell.y << ")\n";
  }
  const Plan plan = Planner(*scenario).Solve(farm, Foresight::kOracle);
  for (const std::uint8_t action : plan.actions) {
    farm.Step(&action);
    const Ship& ship = farm.ships()[0];
    text << "step " << farm.step() << ' ' << ToString(static_cast<Action>(action)) << " -> ("
         << ship.cell.x << ", " << ship.cell.y << ") reward " << ship.reward << '\n';
  }
  EXPECT_NEAR(plan.expected_return, static_cast<double>(farm.ships()[0].episode_return), 1e-3);
  text << "return " << farm.ships()[0].episode_return << "\n\n";
  return text.str();
}

TEST(GoldenRoute, ChangesWhenTwoDevicesSwapTheirKinds) {
  constexpr auto kCage = DeviceKind::kTemporaryBreeding;
  constexpr auto kBuoy = DeviceKind::kMonitoring;
  const std::string text =
      "The best routes in a red tide that damages cages four times as much as other devices, and "
      "buoys not at all\n\n" +
      RouteOf(kCage, kBuoy) + RouteOf(kBuoy, kCage);
  const std::string path = AQUAFARM_CORE_DIR "/test/golden/kinds_route.txt";
  if (std::getenv("AQUAFARM_UPDATE_GOLDEN") != nullptr) std::ofstream(path) << text;
  std::ifstream file(path);
  std::ostringstream golden;
  golden << file.rdbuf();
  EXPECT_EQ(text, golden.str());
  // The cage is fetched first, wherever it is.
  const auto is_west_first = [](const std::string& route) {
    return route.find("pickup -> (1, 1)") < route.find("pickup -> (9, 1)");
  };
  EXPECT_TRUE(is_west_first(RouteOf(kCage, kBuoy)));
  EXPECT_FALSE(is_west_first(RouteOf(kBuoy, kCage)));
}

}  // namespace
}  // namespace aquafarm::agents
