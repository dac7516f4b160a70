// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/view.h"

#include <gtest/gtest.h>

#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;
using test::StepOne;
using test::StillDisaster;
using test::TinyScenario;

Scenario PartialScenario() {
  Scenario scenario = TinyScenario();
  scenario.width = 30;
  scenario.height = 30;
  scenario.view = {ViewMode::kPartial, 3.0F, 10, 0.0F};
  scenario.damage.exposure_damage = 0.01F;
  return scenario;
}

TEST(FullView, KnowsEverything) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 2;
  scenario.disasters = {StillDisaster(100, 100, {2}, {-5})};
  Farm farm = MakeFarm(scenario);
  View view;
  Observe(farm, 1, view);
  ASSERT_EQ(view.others.size(), 1U);
  EXPECT_EQ(view.others[0].id, 0);
  EXPECT_TRUE(view.others[0].visible);
  EXPECT_TRUE(view.devices[0].health_known);
  EXPECT_TRUE(view.disasters[0].visible);
  EXPECT_EQ(view.disasters[0].belief.x, 100.0F);
}

TEST(PartialView, SeesADisasterWhenItsEdgeIsInRange) {
  for (const auto& [x, visible] : {std::pair{7.0F, true}, std::pair{7.5F, false}}) {
    Scenario scenario = PartialScenario();
    scenario.view.bulletin_period = 0;
    scenario.disasters = {StillDisaster(x, 0, {2}, {-5})};  // the ship is at (2, 0)
    View view;
    const Farm farm = MakeFarm(scenario);
    Observe(farm, 0, view);
    EXPECT_EQ(view.disasters[0].visible, visible) << x;
    EXPECT_EQ(view.disasters[0].known, visible) << "without bulletins nothing is known unseen";
  }
}

TEST(PartialView, TheLastBulletinStandsWithItsAge) {
  Scenario scenario = PartialScenario();
  scenario.disasters = {StillDisaster(20, 20, {2}, {-5})};
  scenario.disasters[0].speed = 0.5F;
  Farm farm = MakeFarm(scenario);
  View view;
  for (int step = 0; step < 25; ++step) {
    Observe(farm, 0, view);
    const KnownDisaster& known = view.disasters[0];
    ASSERT_TRUE(known.known);
    EXPECT_FALSE(known.visible);
    EXPECT_EQ(known.age, step % 10);
    EXPECT_EQ(known.belief.y, 20.0F + 0.5F * static_cast<float>(step - step % 10));
    EXPECT_EQ(known.belief.heading_deg, 0);
    StepOne(farm, Action::kHold);
  }
}

TEST(PartialView, OutOfSightRingsAreThoseOfTheBulletin) {
  Scenario scenario = PartialScenario();
  scenario.view.bulletin_period = 10;
  DisasterSpec growing = StillDisaster(20, 20, {2}, {-5});
  growing.radius_growth = 0.25F;
  DisasterSpec tracked = StillDisaster(20, 20, {1}, {-5});
  tracked.start.reset();
  const auto at = [](float step, float radius, float risk, std::int32_t grade) {
    return Waypoint{step, 20, 20, grade, {radius}, {risk}};
  };
  tracked.track = {at(0, 1, -5, 1), at(15, 1, -5, 1), at(16, 3, -20, 4), at(1000, 3, -20, 4)};
  scenario.disasters = {growing, tracked};
  Farm farm = MakeFarm(scenario);
  View view;
  for (std::int32_t step = 0; step < 35; ++step) {
    Observe(farm, 0, view);
    ASSERT_FALSE(view.disasters[0].visible || view.disasters[1].visible);
    const std::int32_t told = step - step % 10;
    EXPECT_FLOAT_EQ(view.disasters[0].belief.radius[0], 2.0F + 0.25F * static_cast<float>(told));
    EXPECT_EQ(view.disasters[1].belief.radius[0], told < 16 ? 1.0F : 3.0F) << "step " << step;
    EXPECT_EQ(view.disasters[1].belief.risk[0], told < 16 ? -5.0F : -20.0F);
    EXPECT_EQ(view.disasters[1].belief.grade, told < 16 ? 1 : 4);
    StepOne(farm, Action::kHold);
  }
}

// SetDisaster announces the rings and the grade of a disaster. Its position stays unknown to a ship
// without a sensor in range.
TEST(PartialView, OutOfSightAReplacementIsAnnouncedButNotItsPlace) {
  Scenario scenario = PartialScenario();
  scenario.view.bulletin_period = 10;
  DisasterSpec first = StillDisaster(20, 20, {2}, {-5});
  scenario.disasters = {first};
  Farm farm = MakeFarm(scenario);
  for (int step = 0; step < 3; ++step) StepOne(farm, Action::kHold);
  DisasterSpec other = StillDisaster(18, 22, {4}, {-20});
  other.grade = 4;
  other.duration = 77;
  other.radius_growth = 0.5F;
  farm.SetDisaster(0, other);
  StepOne(farm, Action::kHold);
  View view;
  Observe(farm, 0, view);
  const KnownDisaster& known = view.disasters[0];
  ASSERT_FALSE(known.visible);
  EXPECT_EQ(known.belief.radius[0], 4.0F) << "as announced, without its growth since";
  EXPECT_EQ(known.belief.grade, 4);
  EXPECT_EQ(known.belief.steps_left, 76);
  EXPECT_EQ(known.belief.x, 20.0F) << "of the last bulletin";
  EXPECT_EQ(known.belief.y, 20.0F);
  EXPECT_EQ(known.age, 4);
}

TEST(PartialView, OutOfSightRingsThatShrankToNothingAreStillThoseOfTheBulletin) {
  Scenario scenario = PartialScenario();
  scenario.view.bulletin_period = 10;
  DisasterSpec circle = StillDisaster(20, 20, {3}, {-5});
  circle.radius_growth = -0.25F;
  DisasterSpec quarters = circle;
  quarters.quadrants = {{3.0F, 1.0F, 0.0F, 2.0F}};
  scenario.disasters = {circle, quarters};
  Farm farm = MakeFarm(scenario);
  View view;
  View again;
  for (std::int32_t step = 0; step < 35; ++step) {
    Observe(farm, 0, view);
    ASSERT_FALSE(view.disasters[0].visible || view.disasters[1].visible);
    const float shrunk = 0.25F * static_cast<float>(step - step % 10);
    const auto left = [shrunk](float radius) { return std::max(0.0F, radius - shrunk); };
    EXPECT_FLOAT_EQ(view.disasters[0].belief.radius[0], left(3.0F)) << "step " << step;
    for (std::size_t q = 0; q < 4; ++q) {
      EXPECT_FLOAT_EQ(view.disasters[1].belief.quadrant[q][0], left(quarters.quadrants[0][q]))
          << "step " << step << ", quadrant " << q;
    }
    Farm loaded = MakeFarm(scenario);
    loaded.Load(farm.Save());
    Observe(loaded, 0, again);
    EXPECT_EQ(again.disasters[1].belief.quadrant, view.disasters[1].belief.quadrant);
    StepOne(farm, Action::kHold);
  }
}

TEST(PartialView, BulletinsAreOffByNoMoreThanTheirNoise) {
  Scenario scenario = PartialScenario();
  scenario.view.bulletin_period = 1;
  scenario.view.bulletin_noise = 2.0F;
  scenario.disasters = {StillDisaster(20, 20, {2}, {-5})};
  Farm farm = MakeFarm(scenario);
  View view;
  float widest = 0.0F;
  for (int step = 0; step < 200; ++step) {
    StepOne(farm, Action::kHold);
    Observe(farm, 0, view);
    const float off = std::abs(view.disasters[0].belief.x - 20.0F);
    EXPECT_LE(off, 2.0F);
    widest = std::max(widest, off);
  }
  EXPECT_GT(widest, 1.5F);
}

TEST(PartialView, HealthIsKnownInRangeOnly) {
  Scenario scenario = PartialScenario();
  scenario.devices.sites = {{{2, 3}, DeviceKind::kMonitoring, 80.0F, false},
                            {{2, 4}, DeviceKind::kMonitoring, 80.0F, false}};
  scenario.disasters = {StillDisaster(2, 4, {8}, {-10})};
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kHold);
  View view;
  Observe(farm, 0, view);
  EXPECT_TRUE(view.devices[0].health_known);
  EXPECT_FLOAT_EQ(view.devices[0].health, 0.9F);
  EXPECT_FALSE(view.devices[1].health_known);
  EXPECT_EQ(view.devices[1].health, 1.0F);
  EXPECT_EQ(view.devices[1].cell, (Cell{2, 4})) << "its place is on the chart";
}

TEST(PartialView, OtherShipsAndWhatTheyCarryAreSeenInRangeOnly) {
  Scenario scenario = PartialScenario();
  scenario.ships.count = 2;
  scenario.ports.cells = {{2, 0}, {20, 0}};
  scenario.devices.sites = {{{20, 1}, DeviceKind::kMonitoring, 80.0F, false}};
  scenario.islands.push_back({{21, 0}, 2, 1});
  Farm farm = MakeFarm(scenario);
  for (std::uint64_t episode = 0; episode < 64; ++episode) {
    farm.Reset(1, episode);
    if (farm.ships()[0].cell == Cell{2, 0} && farm.ships()[1].cell == Cell{20, 0}) break;
  }
  ASSERT_EQ(farm.ships()[1].cell, (Cell{20, 0}));
  const std::vector<std::vector<Action>> script{{Action::kHold, Action::kNorth},
                                                {Action::kHold, Action::kPickup},
                                                {Action::kHold, Action::kNorth}};
  for (const auto& actions : script) {
    const std::uint8_t codes[] = {test::Act(actions[0]), test::Act(actions[1])};
    farm.Step(codes);
  }
  View view;
  Observe(farm, 0, view);
  EXPECT_FALSE(view.others[0].visible);
  EXPECT_EQ(view.devices[0].status, DeviceStatus::kAboard);
  EXPECT_EQ(view.devices[0].cell, (Cell{20, 1})) << "where it was deployed";
  Observe(farm, 1, view);
  EXPECT_EQ(view.devices[0].cell, (Cell{20, 2}));
  EXPECT_TRUE(view.devices[0].aboard_self);
}

TEST(PartialView, NetworkedAgentsSeeWithEachOthersSensors) {
  Scenario scenario = PartialScenario();
  scenario.devices.sites = {{{2, 3}, DeviceKind::kMonitoring, 80.0F, false},
                            {{26, 26}, DeviceKind::kMonitoring, 80.0F, true},
                            {{14, 14}, DeviceKind::kMonitoring, 80.0F, true}};
  scenario.view.bulletin_period = 0;
  scenario.disasters = {StillDisaster(27, 27, {2}, {-20})};
  View view;
  Observe(MakeFarm(scenario), 0, view);
  EXPECT_FALSE(view.others[0].visible);
  EXPECT_FALSE(view.devices[1].health_known);
  EXPECT_FALSE(view.disasters[0].known);
  scenario.view.shared_sight = true;
  Farm farm = MakeFarm(scenario);
  Observe(farm, 0, view);
  EXPECT_TRUE(view.others[0].visible);
  EXPECT_TRUE(view.others[1].visible);
  EXPECT_TRUE(view.devices[1].health_known);
  EXPECT_TRUE(view.disasters[0].visible);
}

// A buoy at (20, 20) with a radius of 5, and a cage, all far from the ship at (2, 0).
Scenario BuoyScenario() {
  Scenario scenario = PartialScenario();
  scenario.view.bulletin_period = 0;
  scenario.view.monitoring_radius = 5.0F;
  scenario.devices.sites = {{{20, 20}, DeviceKind::kMonitoring, 80.0F, false},
                            {{10, 10}, DeviceKind::kTemporaryBreeding, 80.0F, false}};
  return scenario;
}

TEST(MonitoringDevice, SeesExactlyItsRadiusFarForAllShips) {
  for (const auto& [cell, seen] :
       {std::pair{Cell{25, 20}, true}, std::pair{Cell{23, 24}, true},
        std::pair{Cell{26, 20}, false}, std::pair{Cell{24, 24}, false}}) {
    Scenario scenario = BuoyScenario();
    scenario.ships.count = 2;
    scenario.devices.sites.push_back({cell, DeviceKind::kBreedingRelease, 80.0F, false});
    const Farm farm = MakeFarm(scenario);
    for (const std::int32_t ship : {0, 1}) {
      View view;
      Observe(farm, ship, view);
      EXPECT_EQ(view.devices[2].health_known, seen) << cell.x << ' ' << cell.y;
      EXPECT_TRUE(view.devices[0].health_known) << "the buoy itself";
      EXPECT_FALSE(view.devices[1].health_known) << "a cage sees nothing";
    }
  }
}

TEST(MonitoringDevice, SeesADisasterWhenItsEdgeIsInRange) {
  for (const auto& [x, visible] : {std::pair{27.0F, true}, std::pair{27.25F, false}}) {
    Scenario scenario = BuoyScenario();
    scenario.disasters = {StillDisaster(x, 20.0F, {2}, {-5})};
    View view;
    const Farm farm = MakeFarm(scenario);
    Observe(farm, 0, view);
    EXPECT_EQ(view.disasters[0].visible, visible) << x;
  }
}

TEST(MonitoringDevice, SeesOnlyWhileItIsInPlaceAndWhole) {
  Scenario scenario = BuoyScenario();
  scenario.devices.sites[0].cell = {2, 1};
  scenario.disasters = {StillDisaster(7.5F, 1.0F, {1}, {-5})};
  Farm farm = MakeFarm(scenario);
  View view;
  Observe(farm, 0, view);
  EXPECT_TRUE(view.disasters[0].visible);
  StepOne(farm, Action::kNorth);
  ASSERT_EQ(StepOne(farm, Action::kPickup).aboard, 1);
  Observe(farm, 0, view);
  EXPECT_FALSE(view.disasters[0].visible) << "aboard, 5.5 cells from the ship's sensor of 3";

  scenario.devices.health = 0.05F;
  scenario.disasters.push_back(StillDisaster(2.0F, 1.0F, {1}, {-20}));
  Farm stormy = MakeFarm(scenario);
  Observe(stormy, 0, view);
  EXPECT_TRUE(view.disasters[0].visible);
  StepOne(stormy, Action::kHold);
  EXPECT_EQ(stormy.devices()[0].health, 0.0F);
  Observe(stormy, 0, view);
  EXPECT_FALSE(view.disasters[0].visible) << "destroyed";

  scenario = BuoyScenario();
  scenario.devices.sites[0].self_propelled = true;
  scenario.disasters = {StillDisaster(20.0F, 26.0F, {1}, {-5})};
  Observe(MakeFarm(scenario), 0, view);
  EXPECT_FALSE(view.disasters[0].visible) << "a device that moves is not in place";
}

TEST(MonitoringDevice, ChangesNothingInFullViewOrWithoutARadius) {
  Scenario scenario = BuoyScenario();
  scenario.view.monitoring_radius = 0.0F;
  View view;
  Observe(MakeFarm(scenario), 0, view);
  EXPECT_FALSE(view.devices[0].health_known);
  EXPECT_EQ(view.sensors.size(), 1U);
}

// Compares the visible cells of a farm with an oracle that computes distances in integers.
TEST(MonitoringDevice, AgreesWithASlowOracleOnEveryCell) {
  for (const std::int32_t radius : {1, 4, 7}) {
    Scenario scenario = BuoyScenario();
    scenario.view.monitoring_radius = static_cast<float>(radius);
    scenario.ships.count = 2;
    scenario.devices.sites.push_back({{4, 22}, DeviceKind::kMonitoring, 80.0F, false});
    scenario.devices.sites.push_back({{27, 6}, DeviceKind::kMonitoring, 80.0F, true});
    Farm farm = MakeFarm(scenario);
    const auto is_within = [](Cell a, Cell b, std::int32_t range) {
      return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) <= range * range;
    };
    std::int32_t seen = 0;
    for (std::int32_t i = 0; i < scenario.CellCount(); ++i) {
      const Cell cell{i % scenario.width, i / scenario.width};
      if ((farm.layout().bits(cell) & kBlockedBits) != 0 || cell == Cell{27, 6}) continue;
      farm.PlaceShip(1, cell);
      View view;
      Observe(farm, 0, view);
      const bool expected = is_within(farm.ships()[0].cell, cell, 3) ||
                            is_within({20, 20}, cell, radius) || is_within({4, 22}, cell, radius);
      EXPECT_EQ(view.others[0].visible, expected) << cell.x << ' ' << cell.y;
      seen += view.others[0].visible ? 1 : 0;
    }
    EXPECT_GT(seen, 2 * radius * radius);
  }
}

TEST(View, KnownRiskIsTheWorstOfWhatIsKnown) {
  Scenario scenario = PartialScenario();
  scenario.view.bulletin_period = 0;
  scenario.disasters = {StillDisaster(4, 0, {2}, {-6}), StillDisaster(25, 25, {2}, {-20})};
  const Farm farm = MakeFarm(scenario);
  View view;
  Observe(farm, 0, view);
  EXPECT_EQ(KnownRiskAt(view, {2, 0}), -6.0F);
  EXPECT_EQ(KnownRiskAt(view, {25, 25}), 0.0F) << "not reported yet";
}

}  // namespace
}  // namespace aquafarm
