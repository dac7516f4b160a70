// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/place_storm.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/wind_radii.h"
#include "count_allocations.h"

namespace aquafarm {
namespace {

constexpr std::int64_t kStart = 1627192800;
constexpr double kCell_m = 1000.0;
constexpr double kStep_s = 600.0;
const GeoPoint kOrigin{30.0, 122.0};

// Moves due west along 30 N by 0.2 degrees an hour, with recorded rings of 300, 100 and 40 km.
StormTrack WestGoing(std::size_t fixes) {
  StormTrack track;
  for (std::size_t i = 0; i < fixes; ++i) {
    StormFix fix;
    fix.time = kStart + static_cast<std::int64_t>(i) * 3600;
    fix.position = {30.0, 123.0 - 0.2 * static_cast<double>(i)};
    fix.wind_mps = 35.0;
    fix.averaging_min = 2;
    fix.grade = StormGrade::kTyphoon;
    for (const auto& [wind_kt, radius_km] : {std::pair{34, 300.0}, {50, 100.0}, {64, 40.0}}) {
      AddRing({wind_kt, {radius_km, radius_km, radius_km, radius_km}, false}, fix.rings);
    }
    track.fixes.push_back(fix);
  }
  return track;
}

StormPath PathOf(const StormTrack& track, RingReduction reduction = RingReduction::kEqualArea) {
  return ToPath(ToRings(track, reduction), GeoFrame(kOrigin, kCell_m), kCell_m, kStep_s, kStart);
}

std::vector<Waypoint> Place(const StormPath& path, const std::vector<StormErrors>& errors) {
  return StormPlacer().Place(path, errors, DefaultGradeRisks());
}

TEST(PlacedStorm, WithoutErrorsIsTheDisasterOfTheStorm) {
  const StormTrack track = WestGoing(5);
  const std::vector<Waypoint> placed = Place(PathOf(track), {});
  const DisasterSpec disaster =
      ToDisaster(ToRings(track, RingReduction::kEqualArea), DefaultGradeRisks(),
                 GeoFrame(kOrigin, kCell_m), kCell_m, kStep_s, kStart);
  ASSERT_EQ(placed.size(), 5U);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_EQ(placed[i].x, disaster.track[i].x);
    EXPECT_EQ(placed[i].step, 6.0F * static_cast<float>(i));
    EXPECT_EQ(placed[i].radii, (std::vector<float>{40.0F, 100.0F, 300.0F}));
    EXPECT_EQ(placed[i].risks, (std::vector<float>{-20.0F, -10.0F, -5.0F}));
    EXPECT_EQ(placed[i].grade, 3);
  }
}

TEST(PlacedStorm, IsDisplacedAlongAndAcrossItsMotionAndInTime) {
  const StormPath path = PathOf(WestGoing(5));
  StormErrors error;
  error.along_km = 10.0;
  error.across_km = 4.0;
  error.shift_s = 1200.0;
  const std::vector<Waypoint> placed = Place(path, {error});
  // The storm moves to the west: forward is west, right is north. The parallel of 30 N bends away
  // from the tangent plane's west by less than one degree here.
  EXPECT_NEAR(placed[2].x, path.points[2].x - 10.0, 0.1);
  EXPECT_NEAR(placed[2].y, path.points[2].y + 4.0, 0.1);
  EXPECT_EQ(placed[2].step, 12.0F + 2.0F);
}

TEST(PlacedStorm, TakesOneErrorPerFixAndKeepsTheOrderOfTime) {
  std::vector<StormErrors> errors(5);
  errors[1].shift_s = 7200.0;  // later than the next fix
  errors[3].size_factor = 2.0;
  const std::vector<Waypoint> placed = Place(PathOf(WestGoing(5)), errors);
  EXPECT_EQ(placed[1].step, 18.0F);
  for (std::size_t i = 1; i < placed.size(); ++i) EXPECT_GT(placed[i].step, placed[i - 1].step);
  EXPECT_EQ(placed[2].radii[2], 300.0F);
  EXPECT_EQ(placed[3].radii, (std::vector<float>{80.0F, 200.0F, 600.0F}));
  EXPECT_THROW(Place(PathOf(WestGoing(5)), std::vector<StormErrors>(3)), LogicError);
}

TEST(PlacedStorm, HasTheRingsAndTheGradeOfItsNewWind) {
  const StormPath path = PathOf(WestGoing(2));
  const auto ratio = [&path](std::int32_t wind_kt, double wind_mps) {
    const double latitude = path.points[0].latitude;
    return EstimateRadius(wind_kt, wind_mps, latitude, 2).median_km /
           EstimateRadius(wind_kt, 35.0, latitude, 2).median_km;
  };
  StormErrors weaker;
  weaker.wind_factor = 0.8;  // 28 m/s: STS, without winds of 64 kt
  const Waypoint weak = Place(path, {weaker})[0];
  EXPECT_EQ(weak.grade, 2);
  EXPECT_EQ(weak.radii[0], 0.0F);
  EXPECT_NEAR(weak.radii[1], 100.0 * ratio(50, 28.0), 1e-3);
  EXPECT_NEAR(weak.radii[2], 300.0 * ratio(34, 28.0), 1e-3);
  EXPECT_EQ(weak.risks, (std::vector<float>{-16.0F, -9.0F, -5.0F}));
  StormErrors stronger;
  stronger.wind_add_mps = 10.0;
  const Waypoint strong = Place(path, {stronger})[0];
  EXPECT_EQ(strong.grade, 4);
  EXPECT_NEAR(strong.radii[0], 40.0 * ratio(64, 45.0), 1e-3);
}

TEST(PlacedStorm, GainsARingScaledAsTheNextWeakerOne) {
  StormTrack track = WestGoing(2);
  for (StormFix& fix : track.fixes) {
    fix.wind_mps = 28.0;
    fix.rings.pop_back();  // no wind of 64 kt
  }
  StormErrors stronger;
  stronger.wind_add_mps = 7.0;
  const Waypoint placed = Place(PathOf(track), {stronger})[0];
  const double anomaly = 100.0 / EstimateRadius(50, 28.0, 30.0, 2).median_km;
  EXPECT_NEAR(placed.radii[0], anomaly * EstimateRadius(64, 35.0, 30.0, 2).median_km, 1e-3);
}

TEST(PlacedStorm, GainsItsFirstRingInTheSizeOfTheStorm) {
  StormTrack track = WestGoing(1);
  track.fixes[0].wind_mps = 16.0;
  track.fixes[0].grade = StormGrade::kTropicalDepression;
  track.fixes[0].rings.clear();
  StormPath path = PathOf(track);
  StormErrors stronger;
  stronger.wind_add_mps = 4.0;
  const float usual = Place(path, {stronger})[0].radii[2];
  EXPECT_NEAR(usual, EstimateRadius(34, 20.0, 30.0, 2).median_km, 1e-3);
  path.points[0].size = 1.8;
  EXPECT_NEAR(Place(path, {stronger})[0].radii[2], 1.8F * usual, 1e-3F);
  EXPECT_EQ(Place(path, {})[0].radii[2], 0.0F);
}

TEST(PlacedStorm, KeepsMeasuredRadiiOfAnotherWind) {
  StormPath path = PathOf(WestGoing(1));
  StormErrors weaker;
  weaker.wind_add_mps = -20.0;
  EXPECT_EQ(Place(path, {weaker})[0].radii[2], 0.0F);
  path.points[0].keeps_radii.fill(true);
  weaker.size_factor = 0.5;
  EXPECT_EQ(Place(path, {weaker})[0].radii, (std::vector<float>{20.0F, 50.0F, 150.0F}));
  EXPECT_EQ(Place(path, {weaker})[0].grade, 1);  // the risk is that of the wind
}

TEST(PlacedStorm, ChangesTheRadiiThatAreNotMeasured) {
  StormPath path = PathOf(WestGoing(1));
  StormErrors weaker;
  weaker.wind_add_mps = -7.0;  // 28 m/s: no wind of 64 kt
  const std::vector<float> changed = Place(path, {weaker})[0].radii;
  path.points[0].keeps_radii[2] = true;  // that of gales
  const std::vector<float> radii = Place(path, {weaker})[0].radii;
  EXPECT_EQ(radii, (std::vector<float>{changed[0], changed[1], 300.0F}));
  EXPECT_NE(changed[2], 300.0F);
}

TEST(PlacedStorm, AddsARingThatIsNewlyReachedNextToMeasuredOnes) {
  StormTrack track = WestGoing(1);
  track.fixes[0].wind_mps = 25.0;  // 50 kt are 25.7 m/s
  track.fixes[0].rings.erase(track.fixes[0].rings.begin() + 1, track.fixes[0].rings.end());
  StormPath path = PathOf(track);
  path.points[0].keeps_radii.fill(true);
  StormErrors stronger;
  stronger.wind_add_mps = 3.0;
  ASSERT_EQ(Place(path, {})[0].radii[1], 0.0F);
  const std::vector<float> radii = Place(path, {stronger})[0].radii;
  EXPECT_EQ(radii[2], 300.0F) << "the measured ring stays";
  EXPECT_GT(radii[1], 10.0F);
  EXPECT_LE(radii[1], radii[2]);
}

TEST(PlacedStorm, KeepsQuadrants) {
  StormTrack track = WestGoing(2);
  track.fixes[0].rings[0].radius_km = {400.0, 300.0, 0.0, 200.0};
  StormErrors larger;
  larger.size_factor = 1.5;
  const Waypoint placed = Place(PathOf(track, RingReduction::kQuadrants), {larger})[0];
  EXPECT_EQ(placed.quadrants[2], (QuadrantRadii{600.0F, 450.0F, 0.0F, 300.0F}));
  EXPECT_EQ(placed.radii[2], 600.0F);
  EXPECT_EQ(placed.quadrants[1][2], 0.0F) << "not beyond the weaker wind";
}

TEST(PlacedStorm, IsPlacedWithoutAllocationAndQuickly) {
  const StormPath longer = PathOf(WestGoing(30));
  const StormPath shorter = PathOf(WestGoing(10));
  const GradeRisks& risks = DefaultGradeRisks();
  std::vector<StormErrors> errors(1);
  errors[0].wind_factor = 1.1;
  StormPlacer placer;
  std::vector<Waypoint> waypoints;
  for (const StormPath* path : {&longer, &shorter, &longer}) {
    placer.Place(*path, errors, risks, waypoints);
  }
  const long before = allocations;
  double least_us = 1e9;
  for (int i = 0; i < 200; ++i) {
    const auto start = std::chrono::steady_clock::now();
    placer.Place(i % 2 == 0 ? shorter : longer, errors, risks, waypoints);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    if (i % 2 == 1) least_us = std::min(least_us, took.count());
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_LE(least_us, 20.0) << "a storm of 30 fixes";
}

}  // namespace
}  // namespace aquafarm
