// SPDX-License-Identifier: BSD-3-Clause
// Rings with a radius for each quadrant.
#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/disaster.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;
using test::StillDisaster;

/// A storm at (x, y) that reaches farthest to the north-east; its inner ring has no south-west
/// quadrant.
DisasterSpec Lopsided(float x, float y) {
  DisasterSpec storm = StillDisaster(x, y, {3.0F, 6.0F}, {-20.0F, -5.0F});
  storm.quadrants = {{3.0F, 2.0F, 0.0F, 1.0F}, {6.0F, 5.0F, 2.0F, 4.0F}};
  return storm;
}

// Slow oracle: the same rule computed with bearings.
float SlowRisk(const DisasterSpec& storm, double x, double y) {
  const double east = x - static_cast<double>((*storm.start)[0]);
  const double north = y - static_cast<double>((*storm.start)[1]);
  double bearing = std::atan2(east, north) * 180.0 / M_PI;
  if (bearing < 0.0) bearing += 360.0;
  const auto quadrant = static_cast<std::size_t>(bearing / 90.0) % 4;
  for (std::size_t k = 0; k < storm.quadrants.size(); ++k) {
    const auto radius = static_cast<double>(storm.quadrants[k][quadrant]);
    if (radius > 0.0 && std::hypot(east, north) <= radius) return storm.risks[k];
  }
  return 0.0F;
}

TEST(Quadrants, AreThoseOfTheBearing) {
  const Disaster storm = SpawnDisaster(Lopsided(10, 10), 0, 1, 0, 25, 25);
  EXPECT_EQ(RiskOf(storm, 10, 13), -20.0F) << "due north is of the north-east";
  EXPECT_EQ(RiskOf(storm, 13, 10), -5.0F) << "due east is of the south-east";
  EXPECT_EQ(RiskOf(storm, 10, 8), -5.0F) << "due south is of the south-west";
  EXPECT_EQ(RiskOf(storm, 10, 7), 0.0F);
  EXPECT_EQ(RiskOf(storm, 9, 10), -20.0F) << "due west is of the north-west";
  EXPECT_EQ(RiskOf(storm, 10, 10), -20.0F);
  EXPECT_EQ(storm.reach(), 6.0F) << "the largest of all";
}

TEST(Quadrants, AgreeWithAnglesEverywhere) {
  const DisasterSpec spec = Lopsided(10.25F, 9.75F);
  const Disaster storm = SpawnDisaster(spec, 0, 1, 0, 25, 25);
  for (int y = 0; y < 25; ++y) {
    for (int x = 0; x < 25; ++x) {
      EXPECT_EQ(RiskOf(storm, static_cast<float>(x), static_cast<float>(y)), SlowRisk(spec, x, y))
          << x << ", " << y;
    }
  }
}

TEST(Quadrants, OfOneRadiusAreACircle) {
  DisasterSpec round = StillDisaster(7.5F, 8.25F, {2.0F, 4.5F}, {-20.0F, -5.0F});
  const Disaster circle = SpawnDisaster(round, 0, 1, 0, 25, 25);
  round.quadrants = {{2.0F, 2.0F, 2.0F, 2.0F}, {4.5F, 4.5F, 4.5F, 4.5F}};
  const Disaster quadrants = SpawnDisaster(round, 0, 1, 0, 25, 25);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const auto px = static_cast<float>(x);
      const auto py = static_cast<float>(y);
      EXPECT_EQ(RiskOf(circle, px, py), RiskOf(quadrants, px, py)) << x << ", " << y;
    }
  }
}

TEST(Quadrants, GrowAndShrinkToNothing) {
  Disaster storm = SpawnDisaster(Lopsided(10, 10), 0, 1, 0, 25, 25);
  GrowRings(storm, 1.0F);
  EXPECT_EQ(storm.quadrant[3][0], 2.0F);
  EXPECT_EQ(storm.quadrant[2][0], 0.0F) << "it is not there, so it does not spread";
  EXPECT_EQ(RiskOf(storm, 9.5F, 9.5F), -5.0F);
  EXPECT_EQ(storm.reach(), 7.0F);
  GrowRings(storm, -3.0F);
  EXPECT_EQ(storm.quadrant[2][1], 0.0F);
  EXPECT_EQ(RiskOf(storm, 10, 9), 0.0F);
}

/// A farm crossed by such a storm, which changes its shape on the track.
Scenario Crossed() {
  Scenario scenario = test::CrowdedScenario(1, 0);
  DisasterSpec storm = Lopsided(0, 0);
  storm.start.reset();
  Waypoint west{0.0F, -2.0F, 4.0F, 3, storm.radii, storm.risks, storm.quadrants};
  Waypoint east = west;
  east.step = 40.0F;
  east.x = 14.0F;
  east.quadrants = {{1.0F, 0.0F, 0.0F, 0.0F}, {2.0F, 7.0F, 3.0F, 1.0F}};
  east.radii = {1.0F, 7.0F};
  storm.track = {west, east};
  scenario.disasters = {storm};
  return scenario;
}

TEST(Quadrants, AreInterpolatedAlongATrackAndSavedWithTheEpisode) {
  Farm farm = MakeFarm(Crossed());
  test::RandomSteps(farm, 20, 3);
  const Disaster& half = farm.disasters()[0];
  EXPECT_FLOAT_EQ(half.quadrant[1][1], 6.0F) << "between 5 and 7";
  EXPECT_FLOAT_EQ(half.radius[1], 6.0F) << "the largest of its quadrants, not between 6 and 7";
  const std::string saved = farm.Save();
  Farm again = MakeFarm(Crossed());
  again.Load(saved);
  EXPECT_EQ(again.Hash(), farm.Hash());
  test::RandomSteps(farm, 10, 4);
  test::RandomSteps(again, 10, 4);
  EXPECT_EQ(again.Hash(), farm.Hash());
  Farm round = MakeFarm([] {
    Scenario scenario = Crossed();
    for (DisasterSpec& storm : scenario.disasters) {
      storm.quadrants.clear();
      for (Waypoint& waypoint : storm.track) waypoint.quadrants.clear();
    }
    return scenario;
  }());
  test::RandomSteps(round, 20, 3);
  round.Load(round.Save());
  EXPECT_THROW(round.Load(saved.substr(0, saved.size() / 2)), InputError);
}

TEST(Quadrants, ArePaintedOnPlanesAsTheyAreFelt) {
  const Scenario scenario = Crossed();
  Farm farm = MakeFarm(scenario);
  test::RandomSteps(farm, 17, 5);
  View view;
  Observe(farm, 0, view);
  const Encoder encoder(farm.scenario());
  std::vector<std::uint8_t> planes(encoder.planes_size());
  encoder.Planes(view, planes.data());
  int felt = 0;
  for (std::int32_t y = 0; y < scenario.height; ++y) {
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      const float risk = farm.RiskAt({x, y});
      EXPECT_EQ(planes[static_cast<std::size_t>(y * scenario.width + x)],
                static_cast<std::uint8_t>(-risk / 20.0F * 255.0F + 0.5F));
      felt += risk < 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(felt, 10);
}

TEST(Quadrants, AreReadAndWrittenBack) {
  const Scenario scenario = Crossed();
  const Scenario read = ParseScenario(ToYaml(scenario), "again.yaml");
  ASSERT_EQ(read.disasters[0].track.size(), 2U);
  EXPECT_EQ(read.disasters[0].track[1].quadrants, scenario.disasters[0].track[1].quadrants);
  EXPECT_EQ(read.disasters[0].track[1].radii, (std::vector<float>{1.0F, 7.0F}));
  EXPECT_EQ(read.hash, HashScenario(scenario));
}

std::string Refused(const Scenario& scenario) {
  try {
    ValidateScenario(scenario);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was taken";
}

TEST(Quadrants, ThatDoNotFitAreRefused) {
  Scenario scenario = Crossed();
  scenario.disasters[0].track[1].quadrants.clear();
  EXPECT_EQ(Refused(scenario),
            "disasters[0].track[1].quadrants: got 0 rings, expected quadrants for every ring at "
            "every point of the disaster, or at no point");
  scenario = Crossed();
  scenario.disasters[0].track[1].quadrants[1][0] = 0.5F;
  EXPECT_EQ(Refused(scenario),
            "disasters[0].track[1].quadrants[1][0]: got 0.5, expected at least the radius of "
            "the inner ring, 1");
  scenario = Crossed();
  scenario.disasters[0].track[1].radii[1] = 9.0F;
  EXPECT_EQ(Refused(scenario),
            "disasters[0].track[1].quadrants: got radii that differ from the largest quadrant of "
            "each ring, expected equal ones");
}

}  // namespace
}  // namespace aquafarm
