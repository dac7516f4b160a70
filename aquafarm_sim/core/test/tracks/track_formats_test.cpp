// SPDX-License-Identifier: BSD-3-Clause
// Line-based and column-based tracks: CMA, JMA, ATCF, IBTrACS.
#include <gtest/gtest.h>

#include <cmath>

#include "storm_samples.h"

namespace aquafarm {
namespace {

TEST(Cma, HasTwoMinuteWindsAndItsGrades) {
  const StormTrack& storm = FindTrack(Load("cma.txt"), "2106");
  EXPECT_EQ(storm.name, "In-fa");
  EXPECT_EQ(storm.agency, "CMA");
  EXPECT_EQ(storm.line, 5);
  ASSERT_EQ(storm.fixes.size(), 3U);
  const StormFix& fix = storm.fixes[2];
  EXPECT_EQ(fix.time, kInFaNoon);
  EXPECT_DOUBLE_EQ(fix.position.latitude, 30.0);
  EXPECT_DOUBLE_EQ(fix.position.longitude, 122.2);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_EQ(fix.wind_mps, 33.0);
  EXPECT_EQ(fix.averaging_min, 2);
  EXPECT_EQ(fix.pressure_hpa, 970.0);
  EXPECT_TRUE(fix.rings.empty());
  EXPECT_EQ(fix.line, 8);
}

TEST(Cma, DistinguishesMissingWindsFromWeakOnes) {
  const StormFile file = Load("cma.txt");
  const std::vector<StormFix>& fixes = FindTrack(file, "Faye(Gloria)").fixes;
  EXPECT_EQ(fixes[0].wind_mps, 12.0);
  EXPECT_EQ(fixes[1].wind_mps, std::nullopt) << "9 is below 10 m/s";
  EXPECT_EQ(fixes[1].wind_below_mps, 10.0);
  EXPECT_EQ(fixes[2].wind_mps, std::nullopt);
  EXPECT_EQ(fixes[2].wind_below_mps, std::nullopt);
  EXPECT_EQ(fixes[2].second_wind_mps, 18.0);
  EXPECT_TRUE(fixes[2].extratropical);
  EXPECT_EQ(fixes[2].grade, StormGrade::kUnknown);
}

TEST(Cma, IdentifiesStormsByNumberOrElseBySerial) {
  const StormFile file = Load("cma.txt");
  ASSERT_EQ(file.tracks.size(), 3U);
  EXPECT_EQ(file.tracks[0].id, "7127,7128");
  EXPECT_EQ(file.tracks[2].id, "CMA12");
  EXPECT_EQ(file.tracks[2].name, "");
  EXPECT_NEAR(file.tracks[2].fixes[0].position.longitude, -0.1, 1e-9);
  EXPECT_DOUBLE_EQ(file.tracks[2].fixes[0].position.latitude, -5.0);
}

TEST(Cma, LeavesOutATimeThatIsThereTwiceAndSaysSo) {
  const StormFile file = ParseStormFile(Sample("cma.txt"), "year.txt");
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{
                "year.txt:9: time: 2021-07-25T06:00:00Z occurs twice; the second is dropped"});
}

TEST(Jma, TurnsAnAsideCircleIntoQuadrants) {
  const StormFile file = Load("jma.txt");
  const StormTrack& storm = FindTrack(file, "in-fa");
  EXPECT_EQ(storm.id, "2106");
  const StormFix& fix = storm.fixes[1];
  EXPECT_EQ(fix.time, kInFaNoon);
  EXPECT_NEAR(*fix.wind_mps, 33.44, 0.01);
  EXPECT_EQ(fix.averaging_min, 10);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_TRUE(fix.landfall);
  ExpectRadii(fix, 50, NauticalMiles({80, 80, 80, 80}));
  // 325 nm to the east, 240 nm to the west: a circle of 282.5 nm that lies 42.5 nm to the east.
  ExpectRadii(fix, 30, NauticalMiles({310.95, 310.95, 250.85, 250.85}));
  EXPECT_EQ(fix.Ring(34), nullptr);
}

TEST(Jma, DistinguishesBlankRadiiFromNone) {
  const StormTrack storm = FindTrack(Load("jma.txt"), "2106");
  EXPECT_TRUE(storm.fixes[0].rings.empty());
  EXPECT_EQ(storm.fixes[0].wind_mps, std::nullopt);
  EXPECT_EQ(storm.fixes[0].grade, StormGrade::kTropicalDepression);
  ExpectRadii(storm.fixes[2], 50, {0, 0, 0, 0});
  EXPECT_TRUE(storm.fixes[2].extratropical);
}

TEST(Jma, HasYearsFrom1951AndLongitudesBeyond180) {
  const StormFix fix = FindTrack(Load("jma.txt"), "5101").fixes[0];
  EXPECT_EQ(fix.time, -595382400);  // 1951-02-19 00:00 UTC
  EXPECT_NEAR(fix.position.longitude, -179.5, 1e-9);
  EXPECT_EQ(fix.grade, StormGrade::kUnknown);
}

TEST(Atcf, MergesTheRowsOfATime) {
  const StormTrack storm = FindTrack(Load("atcf.dat"), "NEOGURI");
  EXPECT_EQ(storm.id, "WP082014");
  ASSERT_EQ(storm.fixes.size(), 3U);
  const StormFix& fix = storm.fixes[1];
  EXPECT_NEAR(*fix.wind_mps, 36.01, 0.01);
  EXPECT_EQ(fix.averaging_min, 1);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_NEAR(*fix.max_wind_radius_km, 55.56, 0.01);
  ExpectRadii(fix, 34, NauticalMiles({110, 90, 0, 100}));
  // A semicircle towards the north-east contains half of SE and half of NW.
  const double half = std::sqrt((60.0 * 60.0 + 40.0 * 40.0) / 2.0);
  ExpectRadii(fix, 50, NauticalMiles({60, half, 40, half}));
  ExpectRadii(fix, 64, NauticalMiles({20, 20, 20, 20}));
  EXPECT_TRUE(storm.fixes[0].rings.empty());
  EXPECT_TRUE(storm.fixes[2].extratropical);
  EXPECT_EQ(storm.fixes[2].wind_mps, std::nullopt);
  EXPECT_TRUE(storm.fixes[0].motion_computed) << "0 and 0 in the deck";
}

TEST(Atcf, ReadsSouthAndWestAndAQuadrantAboutTheNorth) {
  const StormFix fix = FindTrack(Load("atcf.dat"), "lusi").fixes[0];
  EXPECT_DOUBLE_EQ(fix.position.latitude, -10.0);
  EXPECT_DOUBLE_EQ(fix.position.longitude, -179.0);
  const auto mean = [](double a, double b) { return std::sqrt((a * a + b * b) / 2.0); };
  ExpectRadii(fix, 34, NauticalMiles({mean(80, 60), mean(60, 40), mean(40, 20), mean(20, 80)}));
  EXPECT_EQ(fix.heading_deg, 270.0);
  EXPECT_NEAR(*fix.speed_kmh, 18.52, 1e-9);
  EXPECT_FALSE(fix.motion_computed);
}

TEST(Ibtracs, TakesTheWindsOfTheAgencyInCharge) {
  const StormFile file = Load("ibtracs.csv");
  const StormFix& tokyo = FindTrack(file, "2021198N21140").fixes[0];
  EXPECT_NEAR(*tokyo.wind_mps, 33.44, 0.01);
  EXPECT_EQ(tokyo.averaging_min, 10);
  EXPECT_EQ(tokyo.pressure_hpa, 970.0);
  EXPECT_NEAR(tokyo.position.longitude, -122.2, 1e-9);
  EXPECT_TRUE(tokyo.extratropical);
  const StormTrack& ialy = FindTrack(file, "Ialy");
  EXPECT_EQ(ialy.agency, "IBTrACS PROVISIONAL");
  EXPECT_NEAR(*ialy.fixes[0].wind_mps, 18.01, 0.01);
  EXPECT_EQ(ialy.fixes[0].averaging_min, 1) << "WMO_WIND is blank";
  EXPECT_FALSE(ialy.fixes[0].interpolated);
  EXPECT_TRUE(ialy.fixes[1].interpolated);
  EXPECT_EQ(ialy.fixes[1].heading_deg, 0.0) << "360";
  EXPECT_TRUE(ialy.fixes[0].rings.empty());
  ExpectRadii(ialy.fixes[1], 34, NauticalMiles({60, 0, 50, 0}));
}

}  // namespace
}  // namespace aquafarm
