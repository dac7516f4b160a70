// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/presets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/base/check.h"

namespace aquafarm {
namespace {

const GridScale kScale{500.0, 360.0};  // a tenth of an hour per step

DisasterSpec Made(const std::string& text) { return ParseDisasterPreset(text, kScale); }

TEST(Presets, HaveTheGradesOfTheWarnings) {
  const std::vector<std::pair<const char*, int>> cases{{"storm:wind_mps=10.8,radius_km=9", 1},
                                                       {"storm:wind_mps=17.2,radius_km=9", 2},
                                                       {"storm:wind_mps=24.5,radius_km=9", 3},
                                                       {"storm:wind_mps=32.7,radius_km=9", 4},
                                                       {"wave:height_m=2.5,radius_km=9", 1},
                                                       {"wave:height_m=3.4,radius_km=9", 1},
                                                       {"wave:height_m=3.5,radius_km=9", 2},
                                                       {"wave:height_m=4.5,radius_km=9", 3},
                                                       {"wave:height_m=6,radius_km=9", 4},
                                                       {"storm_surge:level=3,radius_km=9", 3},
                                                       {"red_tide:area_km2=99", 1},
                                                       {"red_tide:area_km2=100", 2},
                                                       {"red_tide:area_km2=500", 3},
                                                       {"red_tide:area_km2=1000", 4},
                                                       {"oil_spill:area_km2=1", 3},
                                                       {"chemical_spill:area_km2=1,grade=4", 4}};
  for (const auto& [text, grade] : cases) EXPECT_EQ(Made(text).grade, grade) << text;
  EXPECT_EQ(Made("chemical_spill:area_km2=1").kind, DisasterKind::kChemicalSpill);
  EXPECT_EQ(Made("storm:wind_mps=20,radius_km=9").kind, DisasterKind::kTyphoon);
}

TEST(Presets, HaveTwoRingsOfAllAndHalfTheArea) {
  const DisasterSpec tide = Made("red_tide:area_km2=78.54,growth_m_h=100");  // radius 5 km
  ASSERT_EQ(tide.radii.size(), 2U);
  EXPECT_NEAR(tide.radii[1], 10.0F, 1e-3F);
  EXPECT_NEAR(tide.radii[0] * tide.radii[0] * 2.0F, 100.0F, 0.1F);
  EXPECT_NEAR(tide.radius_growth, 0.02F, 1e-6F) << "10 m a step";
  EXPECT_EQ(tide.risks, (std::vector<float>{-8.0F, -5.0F}));
  EXPECT_EQ(tide.duration, 240);
  EXPECT_EQ(tide.speed, 0.0F);
  EXPECT_EQ(tide.border, Border::kReflect);
}

TEST(Presets, DriftWithTheCurrent) {
  const DisasterSpec tide = Made("red_tide:area_km2=120,current_mps=0.5,current_to_deg=45");
  EXPECT_NEAR(tide.speed, 0.36F, 1e-5F) << "180 m a step";
  EXPECT_EQ(tide.heading_deg, 45);
  EXPECT_EQ(tide.border, Border::kLeave);
  EXPECT_EQ(tide.turn_probability, 0.0F);
}

TEST(Presets, OfSpillsDriftAsideOfTheWindToo) {
  const DisasterSpec north = Made("oil_spill:area_km2=2,wind_mps=10,wind_from_deg=270");
  EXPECT_EQ(north.heading_deg, 105) << "a west wind, 15 degrees to the right";
  EXPECT_NEAR(north.speed, 0.3F * 360.0F / 500.0F, 1e-5F);
  GridScale scale = kScale;
  scale.south = true;
  EXPECT_EQ(
      ParseDisasterPreset("oil_spill:area_km2=2,wind_mps=10,wind_from_deg=270", scale).heading_deg,
      75);
  // 0.3 m/s towards 105 degrees plus 0.3 m/s towards 345 degrees: 0.3 m/s towards 45 degrees.
  const DisasterSpec both =
      Made("oil_spill:area_km2=2,wind_mps=10,wind_from_deg=270,current_mps=0.3,current_to_deg=345");
  EXPECT_EQ(both.heading_deg, 45);
  EXPECT_NEAR(both.speed, north.speed, 1e-5F);
}

TEST(Presets, AreRefusedWithTheKey) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"tsunami",
       "disaster: got 'tsunami', expected one of storm, storm_surge, wave, red_tide, "
       "oil_spill, chemical_spill"},
      {"wave", "disaster: wave: height_m: missing, expected a number in [2.5, 30]"},
      {"wave:height_m=1,radius_km=2", "disaster: wave: height_m: got 1, expected [2.5, 30]"},
      {"wave:height_m=4,radius_km=2,area_km2=3",
       "disaster: wave: got 'area_km2', expected one of height_m, radius_km, current_mps, "
       "current_to_deg, growth_m_h, duration_h"},
      {"wave:height_m=4,height_m=5", "disaster: wave: got 'height_m' twice, expected it once"},
      {"wave:height_m", "disaster: wave: got 'height_m', expected KEY=NUMBER"},
      {"wave:height_m=nan,radius_km=2", "disaster: wave: got 'height_m=nan', expected KEY=NUMBER"},
      {"storm_surge:level=2.7,radius_km=9",
       "disaster: storm_surge: level: got 2.7, expected a whole number in [1, 4]"},
      {"wave:height_m=4,,", "disaster: wave: got '', expected KEY=NUMBER"}};
  for (const auto& [text, words] : cases) {
    try {
      Made(text);
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), words);
    }
  }
}

}  // namespace
}  // namespace aquafarm
