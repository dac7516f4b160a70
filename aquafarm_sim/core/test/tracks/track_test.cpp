// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/track.h"

#include <gtest/gtest.h>

#include "aquafarm/tracks/wind_name.h"
#include "aquafarm/tracks/wind_radii.h"
#include "storm_samples.h"

namespace aquafarm {
namespace {

TEST(Motion, IsComputedWhereTheSourceHasNone) {
  const StormTrack storm = FindTrack(Load("cma.txt"), "in-FA");
  // 29.7N 123.0E to 29.9N 122.7E: 22.2 km north, 29.0 km west in 3 h.
  EXPECT_NEAR(*storm.fixes[0].heading_deg, 307.4, 0.3);
  EXPECT_NEAR(*storm.fixes[0].speed_kmh, 12.2, 0.1);
  EXPECT_TRUE(storm.fixes[0].motion_computed);
  EXPECT_EQ(storm.fixes[2].heading_deg, storm.fixes[1].heading_deg) << "the last keeps its course";
}

TEST(Winds, HaveTheNamesOfMarineWarnings) {
  EXPECT_EQ(RingName(64), "hurricane force (64 kt)");
  EXPECT_EQ(RingName(63), "storm (63 kt)");
  EXPECT_EQ(RingName(50), "storm (50 kt)");
  EXPECT_EQ(RingName(34), "gale (34 kt)");
  EXPECT_EQ(RingName(30), "near gale (30 kt)");
  EXPECT_EQ(RingName(20), "wind (20 kt)");
}

TEST(Grades, AreThoseOfTheStandard) {
  EXPECT_EQ(GradeOfWind(10.7), StormGrade::kUnknown);
  EXPECT_EQ(GradeOfWind(10.8), StormGrade::kTropicalDepression);
  EXPECT_EQ(GradeOfWind(17.2), StormGrade::kTropicalStorm);
  EXPECT_EQ(GradeOfWind(24.5), StormGrade::kSevereTropicalStorm);
  EXPECT_EQ(GradeOfWind(32.7), StormGrade::kTyphoon);
  EXPECT_EQ(GradeOfWind(41.5), StormGrade::kSevereTyphoon);
  EXPECT_EQ(GradeOfWind(51.0), StormGrade::kSuperTyphoon);
  EXPECT_EQ(ToString(StormGrade::kSuperTyphoon), "SuperTY");
  EXPECT_EQ(DisasterGrade(StormGrade::kTropicalStorm), 1);
  EXPECT_EQ(DisasterGrade(StormGrade::kSevereTyphoon), 4);
}

TEST(EstimatedRings, HaveTheMedianRadiusAndAreMarked) {
  StormFix fix;
  fix.position = {30.0, 122.2};
  EXPECT_FALSE(EstimateRing(fix, 34)) << "no wind";
  fix.wind_mps = 38.0;
  fix.averaging_min = 2;
  for (const std::int32_t wind_kt : {64, 34, 50}) EXPECT_TRUE(EstimateRing(fix, wind_kt));
  ASSERT_EQ(fix.rings.size(), 3U);
  EXPECT_EQ(fix.rings[0].wind_kt, 34) << "the weakest first";
  for (const WindRing& ring : fix.rings) {
    EXPECT_EQ(ring.radius_km[kSouthWestQuadrant],
              EstimateRadius(ring.wind_kt, 38.0, 30.0, 2).median_km);
  }
  EXPECT_GT(fix.rings[1].radius_km[0], fix.rings[2].radius_km[0]);
  EXPECT_TRUE(fix.rings[0].estimated);
  EXPECT_FALSE(EstimateRing(fix, 34)) << "there is one";
}

TEST(EstimatedRings, AreNoneAboveTheStormsOwnWind) {
  StormFix fix;
  fix.position = {30.0, 122.2};
  fix.wind_mps = 20.0;
  ASSERT_TRUE(EstimateRing(fix, 34));
  ASSERT_TRUE(EstimateRing(fix, 50));
  EXPECT_GT(fix.Ring(34)->radius_km[0], 0.0);
  EXPECT_EQ(fix.Ring(50)->radius_km[0], 0.0);
}

}  // namespace
}  // namespace aquafarm
