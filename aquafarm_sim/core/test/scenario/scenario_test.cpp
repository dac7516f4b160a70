// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/scenario.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "aquafarm/base/check.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/scenario/validate.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

DisasterSpec TrackedDisaster() {
  DisasterSpec disaster;
  disaster.radii = {1.0F, 2.0F};
  disaster.risks = {-20.0F, -5.0F};
  disaster.track = {{0.0F, 0.0F, 0.0F, 1, {1.0F, 2.0F}, {-20.0F, -5.0F}},
                    {9.0F, 4.0F, 4.0F, 2, {0.0F, 0.0F}, {-20.0F, -5.0F}}};
  return disaster;
}

std::string MessageOf(const std::function<void()>& validate) {
  try {
    validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string AfterChange(const std::function<void(DisasterSpec&)>& change) {
  DisasterSpec disaster = TrackedDisaster();
  change(disaster);
  return MessageOf([&] { ValidateDisaster(disaster); });
}

TEST(Names, AreThoseOfScenarioFiles) {
  EXPECT_EQ(ToString(LayoutMode::kPerEpisode), "per_episode");
  EXPECT_EQ(ToString(DevicePlacement::kUniform), "uniform");
  EXPECT_EQ(ToString(DevicePlacement::kExplicit), "explicit");
  EXPECT_EQ(ToString(Border::kReflect), "reflect");
  EXPECT_EQ(ToString(Border::kLeave), "leave");
  EXPECT_EQ(ToString(ViewMode::kPartial), "partial");
  EXPECT_EQ(ToString(RewardSharing::kTeam), "team");
  EXPECT_THROW(ToString(static_cast<Border>(9)), LogicError);
}

TEST(Defaults, ArePassedAndAreThePapers) {
  const Scenario scenario;
  EXPECT_NO_THROW(ValidateScenario(scenario));
  EXPECT_EQ(scenario.CellCount(), 625);
  EXPECT_EQ(scenario.AgentCount(), 1);
  EXPECT_NO_THROW(ValidateDisaster(DisasterSpec{}));
  EXPECT_NO_THROW(ValidateDisaster(TrackedDisaster()));
}

TEST(ValidateDisaster, NamesWhatIsWrong) {
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.grade = 0; }), "grade: got 0, expected [1, 4]");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.radii = {4.0F}; }),
            "radii: got 1 entries, expected as many as risks: 2");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) {
              d.track.clear();
              d.radii = {4.0F, 2.0F};
            }),
            "radii[1]: got 2, expected more than radii[0] = 4");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.duration = 0; }),
            "duration: got 0, expected [1, 10000000]");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.heading_deg = -1; }),
            "heading_deg: got -1, expected [0, 359]");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.kind = static_cast<DisasterKind>(77); }),
            "kind: got code 77, expected [0, 5]");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.border = static_cast<Border>(3); }),
            "border: got code 3, expected [0, 2]");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) { d.track[1].step = 0.0F; }),
            "track[1].step: got 0, expected more than the step of track[0], 0");
  EXPECT_EQ(AfterChange([](DisasterSpec& d) {
              d.track[1].radii = {2.0F, 1.0F};
            }),
            "track[1].radii[1]: got 1, expected at least radii[0] = 2");
}

TEST(ValidateDisaster, RefusesHostileNumbersEverywhere) {
  for (const float bad : {kNan, kInfinity, -kInfinity, 1.0e30F, -1.0e30F}) {
    const std::vector<std::function<void(DisasterSpec&)>> changes{
        [=](DisasterSpec& d) { d.radii[1] = bad; },
        [=](DisasterSpec& d) { d.risks[1] = bad; },
        [=](DisasterSpec& d) { d.speed = bad; },
        [=](DisasterSpec& d) { d.turn_probability = bad; },
        [=](DisasterSpec& d) { d.radius_growth = bad; },
        [=](DisasterSpec& d) {
          d.start = {{bad, 0.0F}};
        },
        [=](DisasterSpec& d) {
          d.start = {{0.0F, bad}};
        },
        [=](DisasterSpec& d) { d.track[1].step = bad; },
        [=](DisasterSpec& d) { d.track[1].x = bad; },
        [=](DisasterSpec& d) { d.track[1].y = bad; },
        [=](DisasterSpec& d) { d.track[1].radii[1] = bad; },
        [=](DisasterSpec& d) { d.track[1].risks[0] = bad; }};
    for (std::size_t i = 0; i < changes.size(); ++i) {
      EXPECT_NE(AfterChange(changes[i]), "no error") << "change " << i << " to " << bad;
    }
  }
}

TEST(ValidateDisaster, BoundsEveryList) {
  const std::vector<std::function<void(DisasterSpec&)>> changes{
      [](DisasterSpec& d) { d.radii.clear(), d.risks.clear(); },
      [](DisasterSpec& d) { d.radii.resize(5), d.risks.resize(5, -5.0F); },
      [](DisasterSpec& d) { d.risks.resize(1000000, -5.0F); },
      [](DisasterSpec& d) { d.track[0].radii.resize(5); },
      [](DisasterSpec& d) { d.track[0].radii.clear(); },
      [](DisasterSpec& d) { d.track[0].risks.resize(3, -5.0F); },
      [](DisasterSpec& d) { d.track.resize(10001, d.track[0]); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_NE(AfterChange(changes[i]), "no error") << "change " << i;
  }
}

TEST(ValidateScenario, NamesTheDisaster) {
  Scenario scenario;
  scenario.disasters = {DisasterSpec{}, DisasterSpec{}};
  scenario.disasters[1].radii = {1.0F, 1.0F, 2.0F};
  EXPECT_EQ(MessageOf([&] { ValidateScenario(scenario); }),
            "disasters[1].radii[1]: got 1, expected more than radii[0] = 1");
  scenario.disasters.assign(kMaxDisasters, DisasterSpec{});
  EXPECT_NO_THROW(ValidateScenario(scenario));
  scenario.disasters.emplace_back();
  EXPECT_THROW(ValidateScenario(scenario), InputError);
}

TEST(ValidateScenario, RefusesNumbersThatAFileCouldNotSay) {
  const std::vector<std::function<void(Scenario&)>> changes{
      [](Scenario& s) { s.width = 0; },
      [](Scenario& s) { s.height = kMaxSide + 1; },
      [](Scenario& s) { s.name.clear(); },
      [](Scenario& s) { s.cell_size_m = kNan; },
      [](Scenario& s) { s.step_duration_s = 0.0; },
      [](Scenario& s) { s.step_limit = 0; },
      [](Scenario& s) { s.start_time = std::numeric_limits<std::int64_t>::max(); },
      [](Scenario& s) {
        s.origin = GeoPoint{kNan, 0.0};
      },
      [](Scenario& s) {
        s.islands = {{{-1, 0}, 1, 1}};
      },
      [](Scenario& s) {
        s.islands = {{{0, 0}, 0, 1}};
      },
      [](Scenario& s) {
        s.rocks.count = {-1, 2};
      },
      [](Scenario& s) {
        s.rocks.reward = {-5.0F, 1.0F};
      },
      [](Scenario& s) { s.ports.count = 0; },
      [](Scenario& s) { s.ships.count = 65; },
      [](Scenario& s) { s.ships.capacity = 0; },
      [](Scenario& s) { s.devices.kinds.clear(); },
      [](Scenario& s) { s.devices.count = 0; },
      [](Scenario& s) {
        s.devices.value = {kNan, kNan};
      },
      [](Scenario& s) { s.devices.health = 1.5F; },
      [](Scenario& s) { s.rewards.island_crash = 1.0F; },
      [](Scenario& s) { s.damage.crash_probability = 2.0F; },
      [](Scenario& s) { s.view.bulletin_noise = kInfinity; },
      [](Scenario& s) { s.layout = static_cast<LayoutMode>(7); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scenario scenario;
    changes[i](scenario);
    EXPECT_THROW(ValidateScenario(scenario), InputError) << "change " << i;
  }
}

TEST(ValidateScenario, PassesTheFarmsOfTheOtherTests) {
  EXPECT_NO_THROW(ValidateScenario(test::TinyScenario()));
  EXPECT_NO_THROW(ValidateScenario(test::CrowdedScenario(3)));
}

TEST(ValidateScenario, LetsSelfPropelledDevicesGoWithoutShips) {
  Scenario scenario;
  scenario.ships.count = 0;
  scenario.devices.self_propelled = scenario.devices.count;
  EXPECT_NO_THROW(ValidateScenario(scenario));
  EXPECT_EQ(scenario.AgentCount(), 3);
}

TEST(GeoFrame, GoesThereAndBack) {
  const GeoFrame frame({30.2, 122.7}, 500.0);
  for (const GeoPoint point : {GeoPoint{30.2, 122.7}, GeoPoint{30.3, 122.5}, GeoPoint{30.0, 123}}) {
    const std::array<double, 2> cell = frame.ToGrid(point);
    const GeoPoint back = frame.ToGeo(cell[0], cell[1]);
    EXPECT_NEAR(back.latitude, point.latitude, 1e-5);
    EXPECT_NEAR(back.longitude, point.longitude, 1e-5);
  }
  EXPECT_GT(frame.ToGrid({30.2, 122.8})[0], 0.0) << "x is east";
  EXPECT_GT(frame.ToGrid({30.3, 122.7})[1], 0.0) << "y is north";
}

}  // namespace
}  // namespace aquafarm
