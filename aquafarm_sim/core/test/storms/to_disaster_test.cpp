// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/to_disaster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/disaster.h"
#include "aquafarm/scenario/validate.h"
#include "aquafarm/tracks/reader.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

constexpr std::int64_t kHour_s = 3600;
constexpr std::int64_t kStart = 1627192800;  // 2021-07-25 06:00 UTC
const GeoPoint kRanch{30.0, 122.0};

StormFix Fix(std::int64_t hours, double longitude, double wind_mps) {
  StormFix fix;
  fix.time = kStart + hours * kHour_s;
  fix.position = {30.0, longitude};
  fix.wind_mps = wind_mps;
  fix.grade = GradeOfWind(wind_mps);
  return fix;
}

WindRing Ring(std::int32_t wind_kt, const std::array<double, kQuadrantCount>& radius_km) {
  return {wind_kt, radius_km, false};
}

// Passes the ranch from east to west in 20 hours. One degree of longitude (96.5 km) takes five
// hours.
StormTrack WestGoing() {
  StormTrack track;
  track.id = "9901";
  for (const std::int64_t hours : {0, 10, 20}) {
    StormFix fix = Fix(hours, 124.0 - 0.2 * static_cast<double>(hours), 35.0);
    fix.rings = {Ring(34, {200, 200, 200, 200}), Ring(50, {100, 100, 60, 60}),
                 Ring(64, {40, 40, 40, 0})};
    track.fixes.push_back(fix);
  }
  return track;
}

TEST(ToRings, KeepsTheAreaOfTheQuadrantsOrTakesTheLargest) {
  const StormRings equal = ToRings(WestGoing(), RingReduction::kEqualArea);
  EXPECT_EQ(equal.wind_kt, (std::vector<std::int32_t>{64, 50, 34}));
  ASSERT_EQ(equal.waypoints.size(), 3U);
  EXPECT_NEAR(equal.waypoints[0].radii_km[0], std::sqrt(3 * 40.0 * 40.0 / 4), 1e-9);
  EXPECT_NEAR(equal.waypoints[0].radii_km[1], std::sqrt((2 * 1.0e4 + 2 * 3600.0) / 4), 1e-9);
  EXPECT_EQ(equal.waypoints[0].radii_km[2], 200.0);
  EXPECT_EQ(equal.estimated, 0);
  const StormRings largest = ToRings(WestGoing(), RingReduction::kLargest);
  EXPECT_EQ(largest.waypoints[0].radii_km, (std::vector<double>{40.0, 100.0, 200.0}));
  EXPECT_EQ(ToString(RingReduction::kEqualArea), "equal_area");
  EXPECT_EQ(ToString(RingReduction::kLargest), "largest");
}

TEST(ToRings, EstimatesWhatIsNotSaidAndNeverBeyondAWeakerWind) {
  StormTrack track = WestGoing();
  track.fixes[1].rings = {Ring(34, {30, 30, 30, 30})};  // smaller than any estimated radius
  track.fixes[2].rings.clear();
  track.fixes[2].wind_mps.reset();
  track.fixes[2].grade = StormGrade::kUnknown;
  const StormRings storm = ToRings(track, RingReduction::kEqualArea);
  EXPECT_EQ(storm.estimated, 1);
  EXPECT_EQ(storm.silent, 1);
  EXPECT_TRUE(storm.waypoints[1].estimated);
  EXPECT_TRUE(storm.waypoints[2].silent);
  EXPECT_EQ(storm.waypoints[1].radii_km, (std::vector<double>{30.0, 30.0, 30.0}));
  EXPECT_EQ(storm.waypoints[2].radii_km, (std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(ToRings, KeepsTheThirtyKnotsOfTheJma) {
  StormTrack track = WestGoing();
  for (StormFix& fix : track.fixes) {
    fix.rings = {Ring(30, {300, 300, 200, 200}), Ring(50, {80, 80, 80, 80})};
  }
  const StormRings storm = ToRings(track, RingReduction::kLargest);
  EXPECT_EQ(storm.wind_kt, (std::vector<std::int32_t>{50, 30}));
  EXPECT_EQ(storm.waypoints[0].radii_km, (std::vector<double>{80.0, 300.0}));
  EXPECT_EQ(storm.estimated, 0);
}

TEST(BorrowRings, InterpolatesAnotherTrackOfTheSameStorm) {
  StormTrack best;
  best.fixes = {Fix(-1, 124.2, 35.0), Fix(3, 123.4, 35.0), Fix(20, 120.0, 35.0)};
  StormTrack bulletins;
  for (const std::int64_t hours : {0, 6, 20}) {
    StormFix fix = Fix(hours, 124.0, 35.0);
    const double radius = 100.0 + 10.0 * static_cast<double>(hours);
    fix.rings = {Ring(34, {radius, radius, 0, radius})};
    bulletins.fixes.push_back(fix);
  }
  EXPECT_EQ(BorrowRings(bulletins, best), 2);
  EXPECT_TRUE(best.fixes[0].rings.empty()) << "before the first bulletin";
  ASSERT_EQ(best.fixes[1].rings.size(), 1U);
  EXPECT_NEAR(best.fixes[1].rings[0].radius_km[0], 130.0, 1e-9);
  EXPECT_EQ(best.fixes[1].rings[0].radius_km[2], 0.0);
  EXPECT_NEAR(best.fixes[2].rings[0].radius_km[0], 300.0, 1e-9);
}

TEST(ToDisaster, PutsCellsAndStepsInThePlaceOfKilometresAndHours) {
  const StormRings storm = ToRings(WestGoing(), RingReduction::kLargest);
  const GeoFrame frame(kRanch, 1000.0);
  const DisasterSpec disaster =
      ToDisaster(storm, DefaultGradeRisks(), frame, 1000.0, 600.0, kStart + 5 * kHour_s);
  EXPECT_NO_THROW(ValidateDisaster(disaster));
  ASSERT_EQ(disaster.track.size(), 3U);
  EXPECT_FLOAT_EQ(disaster.track[0].step, -30.0F);
  EXPECT_FLOAT_EQ(disaster.track[2].step, 90.0F);
  EXPECT_EQ(disaster.duration, 90);
  EXPECT_NEAR(disaster.track[1].x, 0.0, 1e-3);
  EXPECT_NEAR(disaster.track[0].x, 193.0, 0.1) << "two degrees of longitude at 30 N";
  EXPECT_EQ(disaster.track[0].grade, 3);
  EXPECT_EQ(disaster.track[0].radii, (std::vector<float>{40.0F, 100.0F, 200.0F}));
  EXPECT_EQ(disaster.track[0].risks, DefaultGradeRisks()[2]);
}

TEST(Bulletins, ContinueWithTheNewestForecast) {
  StormTrack track = WestGoing();
  StormForecast old;
  old.issued = kStart;
  old.fixes = {Fix(30, 119.0, 20.0)};
  StormForecast fresh;
  fresh.issued = kStart + 20 * kHour_s;
  fresh.fixes = {Fix(20, 120.0, 30.0), Fix(26, 119.5, 25.0), Fix(44, 118.0, 18.0)};
  track.forecasts = {old, fresh};
  const StormTrack whole = WithForecast(track, NoForecast::kEnd);
  ASSERT_EQ(whole.fixes.size(), 5U);
  EXPECT_EQ(whole.fixes[4].time, kStart + 44 * kHour_s);
}

TEST(Bulletins, ContinueAsTheStormMovesWithoutAForecast) {
  StormTrack track = WestGoing();
  track.fixes.back().heading_deg = 0.0;
  track.fixes.back().speed_kmh = 10.0;
  EXPECT_EQ(WithForecast(track, NoForecast::kEnd).fixes.size(), 3U);
  const StormTrack whole = WithForecast(track, NoForecast::kPersist);
  ASSERT_EQ(whole.fixes.size(), 4U);
  EXPECT_EQ(whole.fixes[3].time, kStart + 44 * kHour_s);
  EXPECT_NEAR(whole.fixes[3].position.latitude, 30.0 + 240.0 / 110.9, 0.01);
  EXPECT_EQ(whole.fixes[3].rings.size(), 3U);
}

TEST(Bulletins, LastFromNowToTheirEnd) {
  StormTrack track = WestGoing();
  track.fixes.back().heading_deg = 0.0;
  track.fixes.back().speed_kmh = 10.0;
  Scenario scenario;
  EXPECT_THROW(ToDisaster(track, scenario, 0, 0), InputError);
  scenario.origin = kRanch;
  scenario.start_time = kStart;
  scenario.step_duration_s = 3600.0;
  const DisasterSpec disaster = ToDisaster(track, scenario, 0, 5);
  EXPECT_EQ(disaster.duration, 39) << "44 hours, 5 are over";
  EXPECT_NO_THROW(ValidateDisaster(disaster));
  try {
    ToDisaster(track, scenario, 0, 1000);
    FAIL() << "long over";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "bulletin: got a storm known until 2021-07-26T02:00:00Z only; no forecast: it is "
                 "assumed to keep its motion, wind and rings until 2021-07-27T02:00:00Z, expected "
                 "one that is known after step 1000 (2021-09-04T22:00:00Z); send a newer bulletin");
  }
}

TEST(Bulletins, AreReportedWithTheirForecast) {
  StormTrack track = WestGoing();
  StormForecast fresh;
  fresh.issued = kStart + 20 * kHour_s;
  fresh.fixes = {Fix(26, 119.5, 25.0), Fix(44, 118.0, 18.0)};
  track.forecasts = {fresh};
  Scenario scenario;
  scenario.origin = kRanch;
  scenario.start_time = kStart;
  scenario.step_duration_s = 3600.0;
  const DisasterSpec disaster = ToDisaster(track, scenario, 0, 5);
  EXPECT_NO_THROW(ValidateDisaster(disaster));
  ASSERT_EQ(disaster.forecasts.size(), 1U);
  EXPECT_EQ(disaster.forecasts[0].step, 20.0F) << "the last recorded position";
  ASSERT_EQ(disaster.forecasts[0].points.size(), 8U) << "at most 3 hours apart";
  const Waypoint& last = disaster.forecasts[0].points.back();
  EXPECT_EQ(last.step, 44.0F);
  EXPECT_EQ(last.x, disaster.track.back().x);
  EXPECT_EQ(last.radii, disaster.track.back().radii);
  track.forecasts.clear();
  EXPECT_TRUE(ToDisaster(track, scenario, 0, 5).forecasts.empty()) << "an assumed motion";
}

TEST(Tracks, BeginOnTheRanchsSideOfTheGlobe) {
  StormTrack track = WestGoing();
  StormFix antipode = track.fixes.front();
  antipode.time -= 6 * kHour_s;
  antipode.position = {-30.0, -58.0};
  const GeoFrame frame(kRanch, 1000.0);
  EXPECT_FALSE(frame.Faces(antipode.position));
  EXPECT_TRUE(frame.Faces(kRanch));
  const auto made = [&frame](const StormTrack& of) {
    return ToDisaster(ToRings(of, RingReduction::kEqualArea), DefaultGradeRisks(), frame, 1000.0,
                      3600.0, kStart);
  };
  const DisasterSpec without = made(track);
  track.fixes.insert(track.fixes.begin(), antipode);
  const DisasterSpec cut = made(track);
  ASSERT_EQ(cut.track.size(), without.track.size());
  EXPECT_EQ(cut.track[0].x, without.track[0].x);
  const auto refused = [&made](const StormTrack& of) -> std::string {
    try {
      made(of);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  StormTrack back = WestGoing();
  back.fixes[1].position = antipode.position;
  EXPECT_NE(refused(back).find("leaves the ranch's side of the globe"), std::string::npos);
  track.fixes.resize(1);
  EXPECT_NE(refused(track).find("on the far side of the globe"), std::string::npos);
}

TEST(Steps, AreBounded) {
  EXPECT_EQ(StepsToCover(3601.0, 3600.0), 2);
  EXPECT_EQ(StepsToCover(-5.0, 1.0), 1);
  try {
    StepsToCover(3.0e8, 0.001);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "duration: got 300000000000 steps, expected at most 10000000; use longer steps");
  }
}

TEST(ClosestApproach, HasTheTimeOfTheNearestPointAndTheDurationOfTheWind) {
  const Passage passage =
      ClosestApproach(ToRings(WestGoing(), RingReduction::kLargest), kRanch, 0.0);
  EXPECT_EQ(passage.nearest_time, kStart + 10 * kHour_s);
  EXPECT_LT(passage.nearest_km, 0.01);
  EXPECT_EQ(passage.worst_wind_kt, 64);
  EXPECT_EQ(passage.first, kStart) << "193 km away, within 200";
  EXPECT_EQ(passage.last, kStart + 20 * kHour_s);
  EXPECT_NEAR(passage.widest_h, 20.0, 1.0e-6) << "from the first to the last time";
  const Passage far =
      ClosestApproach(ToRings(WestGoing(), RingReduction::kLargest), {36.0, 122.0}, 0.0);
  EXPECT_EQ(far.worst_wind_kt, 0);
  EXPECT_EQ(far.widest_h, 0.0);
  EXPECT_NEAR(far.nearest_km, 665.5, 1.0) << "six degrees of latitude";
}

TEST(ClosestApproach, LeavesOutTheHoursBetweenTwoPassages) {
  StormTrack track = WestGoing();
  StormFix back = Fix(30, 122.0, 35.0);
  for (StormFix& fix : track.fixes) fix.rings = {Ring(34, {100, 100, 100, 100})};
  back.rings = track.fixes[0].rings;
  track.fixes.push_back(back);  // at the ranch in hours 10 and 30, 193 km west of it in hour 20
  const Passage passage = ClosestApproach(ToRings(track, RingReduction::kLargest), kRanch, 0.0);
  EXPECT_NEAR(static_cast<double>(passage.first - kStart), 4.8 * kHour_s, 600.0);
  EXPECT_EQ(passage.last, kStart + 30 * kHour_s);
  const double covered_h = 2 * 5.18 + 5.18;  // 100 km take 5.18 h
  EXPECT_NEAR(passage.widest_h, covered_h, 0.5) << "without the 9.6 h of the gap";
}

TEST(ClosestApproach, HasNoDurationIfTheWindCoversOneSample) {
  StormTrack track = WestGoing();
  track.fixes = {track.fixes[1]};
  const Passage passage = ClosestApproach(ToRings(track, RingReduction::kLargest), kRanch, 0.0);
  EXPECT_EQ(passage.first, track.fixes[0].time);
  EXPECT_EQ(passage.last, track.fixes[0].time);
  EXPECT_EQ(passage.worst_wind_kt, 64);
  EXPECT_EQ(passage.widest_h, 0.0);
}

// The shipped scenario was written by hand from these two files.
TEST(RealFiles, GiveTheTrackOfTheShippedScenario) {
  const std::filesystem::path data = SharedData();
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no real files at " << data;
  const StormFile best = LoadStormFile((data / "tracks" / "CH2021BST.txt").string());
  const StormFile bulletins = LoadStormFile((data / "bulletins" / "202106.json").string());
  StormTrack track = FindTrack(best, "In-Fa");
  EXPECT_GT(BorrowRings(FindTrack(bulletins, "In-Fa"), track), 50);
  const StormRings storm = ToRings(track, RingReduction::kEqualArea);
  const StormWaypoint noon = *storm.At(kStart);
  EXPECT_NEAR(noon.radii_km[2], 241.1, 0.1);
  EXPECT_NEAR(noon.radii_km[1], 95.4, 0.1);
  EXPECT_NEAR(noon.radii_km[0], 40.0, 0.1);
  const Passage passage = ClosestApproach(storm, {30.168, 122.698}, 0.0);
  EXPECT_NEAR(passage.nearest_km, 29.0, 1.5);
  EXPECT_NEAR(static_cast<double>(passage.nearest_time - (kStart - 3 * kHour_s)), 0.0, 1800.0);
}

}  // namespace
}  // namespace aquafarm
