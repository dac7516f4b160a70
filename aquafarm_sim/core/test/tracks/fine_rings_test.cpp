// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/fine_rings.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "aquafarm/tracks/wind_radii.h"

namespace aquafarm {
namespace {

constexpr std::int64_t kHour_s = 3600;
constexpr std::int64_t kFirstFix = 1627192800;  // 2021-07-25 06:00 UTC
constexpr std::size_t kGale = 2;                // ring of 34 kt

// A storm on 30 N. The first fix is at the start.
class Fine : public ::testing::Test {
 protected:
  // Adds a fix. @param gale_km radius of 34 kt; negative: not reported, 0: it does not blow
  StormFix& Add(int hours, std::optional<double> wind_mps, double gale_km = -1.0) {
    StormFix fix;
    fix.time = kFirstFix + hours * kHour_s;
    fix.position = {30.0, 122.0};
    fix.wind_mps = wind_mps;
    fix.averaging_min = 2;
    if (wind_mps) fix.grade = GradeOfWind(*wind_mps);
    fix.forecast = hours > 0;
    if (gale_km >= 0.0) AddRing({34, {gale_km, gale_km, gale_km, gale_km}, false}, fix.rings);
    track_.fixes.push_back(fix);
    return track_.fixes.back();
  }
  // Radius of gales at a time [km].
  double Gale(int hours, RingReduction reduction = RingReduction::kEqualArea) const {
    return ToFineRings(track_, reduction, kFirstFix)
        .storm.At(kFirstFix + hours * kHour_s)
        ->radii_km[kGale];
  }
  static double Median(double wind_mps) { return EstimateRadius(34, wind_mps, 30.0, 2).median_km; }

  StormTrack track_;
};

// The winds fall below a gale after 9 of 12 hours.
TEST_F(Fine, AStormThatWeakensKeepsItsGalesWhileItsWindIsAGale) {
  Add(0, 32.0);
  Add(12, 12.8);
  EXPECT_NEAR(Gale(6), Median(22.4), 0.1);
  EXPECT_NEAR(Gale(9), Median(17.6), 0.1);
  EXPECT_EQ(Gale(12), 0.0);
  EXPECT_LT(ToRings(track_, RingReduction::kEqualArea).At(kFirstFix + 9 * kHour_s)->radii_km[kGale],
            0.5 * Gale(9))
      << "linear radii are too small";
}

TEST_F(Fine, AForecastThatStatesNoGalesEndsThemNoEarlier) {
  Add(0, 32.0, 300.0);
  Add(12, 12.8, 0.0);
  const double size = std::pow(300.0 / Median(32.0), std::exp(-9.0 / kSizeMemory_h));
  EXPECT_NEAR(Gale(9), size * Median(17.6), 0.1 * Gale(9));
  EXPECT_GT(Gale(9), 75.0) << "linear";
}

TEST_F(Fine, ReportedRadiiStayAsTheyAreAndAreLinearBetween) {
  Add(0, 32.0, 300.0);
  Add(12, 25.0, 180.0);
  EXPECT_EQ(Gale(0), 300.0);
  EXPECT_NEAR(Gale(6), 240.0, 1e-9);
  EXPECT_EQ(Gale(12), 180.0);
}

TEST_F(Fine, CirclesAndQuadrantsHaveTheSameRadii) {
  Add(0, 32.0, 400.0);
  Add(12, 25.0);
  Add(24, 12.0);
  for (const int hours : {3, 6, 12, 18, 20, 24}) {
    EXPECT_NEAR(Gale(hours), Gale(hours, RingReduction::kQuadrants), 1e-9) << hours;
    EXPECT_NEAR(Gale(hours), Gale(hours, RingReduction::kLargest), 1e-9) << hours;
  }
  EXPECT_GT(Gale(12), 1.2 * Median(25.0)) << "the size of the report is kept";
}

TEST_F(Fine, StretchesWithoutAWindHaveTheLargerRadii) {
  Add(0, 32.0, 300.0);
  Add(12, std::nullopt, 100.0);
  Add(24, std::nullopt, 200.0);
  const auto [storm, held] = ToFineRings(track_, RingReduction::kQuadrants, kFirstFix);
  EXPECT_EQ(held, 2);
  EXPECT_EQ(storm.waypoints.size(), 9U);
  EXPECT_EQ(storm.waypoints[1].quadrants_km[kGale], (std::array<double, 4>{300, 300, 300, 300}));
  EXPECT_EQ(Gale(9), 300.0);
  EXPECT_EQ(Gale(12), 100.0) << "as stated";
  EXPECT_EQ(Gale(15), 200.0);
  EXPECT_EQ(Gale(21), 200.0);
}

TEST_F(Fine, WindsOfTwoAveragingPeriodsAreNotMixed) {
  Add(0, 32.0, 300.0);
  Add(12, 30.0, 250.0).averaging_min = 10;
  EXPECT_EQ(ToFineRings(track_, RingReduction::kEqualArea, kFirstFix).held, 1);
  EXPECT_EQ(Gale(6), 300.0);
}

// Where the wind is unknown, a radius of 0 does not mean calm.
TEST_F(Fine, NothingIsAddedNextToAPointWithoutWindAndRadii) {
  Add(0, 32.0, 300.0);
  Add(12, std::nullopt);
  Add(24, 32.0, 300.0);
  const auto [storm, held] = ToFineRings(track_, RingReduction::kEqualArea, kFirstFix);
  EXPECT_EQ(storm.waypoints.size(), 3U);
  EXPECT_EQ(storm.silent, 1);
  EXPECT_EQ(held, 0);
  EXPECT_TRUE(storm.At(kFirstFix + 6 * kHour_s)->silent);
  EXPECT_TRUE(storm.At(kFirstFix + 18 * kHour_s)->silent);
}

TEST_F(Fine, PointsAreAddedAfterATimeAndCountedOnce) {
  Add(0, 32.0);
  Add(12, 20.0);
  EXPECT_EQ(FineTrack(track_, kFirstFix).fixes.size(), 5U);
  EXPECT_EQ(FineTrack(track_, kFirstFix + 12 * kHour_s).fixes.size(), 2U) << "it is past";
  EXPECT_EQ(ToFineRings(track_, RingReduction::kEqualArea, kFirstFix).storm.estimated, 2)
      << "of the track's own points";
}

TEST_F(Fine, PointsBetweenCrossTheDateLineAndKeepCommonRings) {
  Add(0, 30.0, 200.0).position.longitude = 179.0;
  AddRing({50, {80.0, 80.0, 80.0, 80.0}, false}, track_.fixes.front().rings);
  Add(6, 20.0, 100.0).position.longitude = -179.0;
  const StormTrack fine = FineTrack(track_, kFirstFix);
  ASSERT_EQ(fine.fixes.size(), 3U);
  const StormFix& middle = fine.fixes[1];
  EXPECT_EQ(middle.time, kFirstFix + 3 * kHour_s);
  EXPECT_NEAR(std::abs(middle.position.longitude), 180.0, 1e-9);
  EXPECT_EQ(middle.wind_mps, 25.0);
  EXPECT_EQ(middle.grade, StormGrade::kSevereTropicalStorm);
  ASSERT_EQ(middle.rings.size(), 1U) << "50 kt are estimated from the wind";
  EXPECT_EQ(middle.rings[0].radius_km[0], 150.0);
  EXPECT_TRUE(middle.forecast);
}

}  // namespace
}  // namespace aquafarm
