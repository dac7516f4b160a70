// SPDX-License-Identifier: BSD-3-Clause
// Conversions of storm bulletins, rings by quadrants, forecasts and sea layers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/reader.h"
#include "aquafarm_sim/convert/conversions.h"
#include "aquafarm_sim/convert/observation.h"
#include "farm_server_fixture.h"

namespace aquafarm_sim {
namespace {

using aquafarm::Farm;
using aquafarm::Scenario;
using aquafarm_msgs::StormFix;

constexpr std::uint32_t kStart = 1627084800;  // 2021-07-24 00:00 UTC

/// A scenario off Zhoushan: cells of 1 km, steps of ten minutes, one disaster with its own risks.
Scenario Placed() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.origin = aquafarm::GeoPoint{30.2, 122.7};
  scenario.start_time = kStart;
  scenario.step_duration_s = 600.0;
  aquafarm::DisasterSpec storm = aquafarm::test::StillDisaster(50, 50, {1, 2, 3}, {-20, -10, -5});
  storm.track = {{0, 50, 50, 3, storm.radii, {-19, -9, -6}, {}}};
  storm.risks = {-19, -9, -6};
  storm.grade_risks = {{-14, -8, -5}, {-16, -9, -5}, {-19, -9, -6}, {-20, -12, -7}};
  scenario.disasters = {storm};
  return scenario;
}

/// A typhoon one degree to the south that moves north; its fixes cover twelve hours.
aquafarm_msgs::Storm North() {
  aquafarm_msgs::Storm storm;
  storm.name = "IN-FA";
  StormFix fix;
  fix.stamp = ros::Time(kStart, 0);
  fix.latitude_deg = 29.2;
  fix.longitude_deg = 122.7;
  fix.wind_mps = 38.0F;
  fix.pressure_hpa = 965.0F;
  for (const int wind_kt : {64, 34, 50}) {
    aquafarm_msgs::StormRing ring;
    ring.wind_kt = wind_kt;
    for (int q = 0; q < 4; ++q) {
      ring.radius_km[static_cast<std::size_t>(q)] = static_cast<float>(400 - 5 * wind_kt - 20 * q);
    }
    fix.rings.push_back(ring);
  }
  storm.fixes = {fix};
  fix.stamp = ros::Time(kStart + 12 * 3600, 0);
  fix.latitude_deg = 30.2;
  storm.forecast = {fix};
  return storm;
}

aquafarm_msgs::SetDisaster::Response Notify(FarmServer& ranch, const aquafarm_msgs::Storm& storm,
                                            std::int32_t id = 0) {
  aquafarm_msgs::SetDisaster call;
  call.request.farm = -1;
  call.request.id = id;
  call.request.storm = storm;
  ranch.SetDisaster(call.request, call.response);
  return call.response;
}

TEST(Storms, BecomeDisastersOfTheRunningEpisode) {
  const auto ranch = test::MakeRanch(Placed(), 2);
  const auto answer = Notify(*ranch, North());
  ASSERT_TRUE(answer.ok) << answer.message;
  const auto disaster = test::StateOf(*ranch, 1).disasters[0];
  EXPECT_EQ(disaster.grade, 3) << "of 38 m/s";
  EXPECT_NEAR(disaster.y, -110.85, 0.1) << "a degree in cells";
  EXPECT_EQ(disaster.steps_left, 72) << "twelve hours";
  EXPECT_NEAR(disaster.motion_y, 110.85 / 72.0, 0.01);
  EXPECT_EQ(disaster.risks, (std::vector<float>{-19, -9, -6})) << "by the scenario's own table";
  // Circles of the same area as quadrants of 230, 210, 190, 170 km.
  EXPECT_NEAR(disaster.radii[2], std::sqrt((230. * 230 + 210. * 210 + 190. * 190 + 170. * 170) / 4),
              0.01);
  EXPECT_TRUE(disaster.quadrants.empty());
}

TEST(Storms, StayByQuadrantsWhereTheScenarioIs) {
  Scenario scenario = Placed();
  auto& storm = scenario.disasters[0];
  for (const float radius : storm.radii) storm.quadrants.push_back({radius, radius, 0, 0});
  storm.quadrants[1][2] = storm.quadrants[2][2] = 1.0F;
  storm.track[0].quadrants = storm.quadrants;
  const auto ranch = test::MakeRanch(scenario);
  const auto answer = Notify(*ranch, North());
  ASSERT_TRUE(answer.ok) << answer.message;
  const auto disaster = test::StateOf(*ranch).disasters[0];
  ASSERT_EQ(disaster.quadrants.size(), 12U);
  EXPECT_FLOAT_EQ(disaster.quadrants[8], 230.0F);
  EXPECT_FLOAT_EQ(disaster.quadrants[11], 170.0F);
  EXPECT_FLOAT_EQ(disaster.radii[2], 230.0F);
}

TEST(Storms, MayComeOnTop) {
  const auto ranch = test::MakeRanch(Placed());
  ASSERT_TRUE(Notify(*ranch, North(), 1).ok);
  EXPECT_EQ(test::StateOf(*ranch).disasters[1].risks, (std::vector<float>{-19, -9, -6}))
      << "with the table of the disaster that has one";
}

// The farms of one ranch are at different steps, because each starts its next episode on its own.
TEST(Storms, ReachTheFarmsForWhichTheyAreNotOver) {
  Scenario scenario = Placed();
  scenario.step_limit = 1000;
  const auto ranch = test::MakeRanch(scenario, 3);
  const auto play_to = [&](const std::array<int, 3>& steps) {
    aquafarm::FarmBatch batch(std::make_shared<const Scenario>(scenario), 3);
    batch.Reset(5, 0, {});
    for (std::int32_t i = 0; i < 3; ++i) {
      for (int step = 0; step < steps[static_cast<std::size_t>(i)]; ++step) {
        aquafarm::test::StepOne(batch.farm(i), aquafarm::Action::kHold);
      }
    }
    const std::string bytes = batch.Save();
    aquafarm_msgs::LoadState load;
    load.request.data.assign(bytes.begin(), bytes.end());
    ranch->LoadState(load.request, load.response);
    ASSERT_TRUE(load.response.ok) << load.response.message;
  };
  play_to({30, 80, 10});
  const std::uint64_t over = test::StateOf(*ranch, 1).hash;
  const auto answer = Notify(*ranch, North());
  ASSERT_TRUE(answer.ok) << answer.message;
  EXPECT_EQ(test::StateOf(*ranch, 0).disasters[0].steps_left, 42);
  EXPECT_EQ(test::StateOf(*ranch, 1).hash, over) << "72 steps are over there";
  EXPECT_EQ(test::StateOf(*ranch, 2).disasters[0].steps_left, 62);
  play_to({72, 80, 73});
  const auto late = Notify(*ranch, North());
  EXPECT_FALSE(late.ok);
  EXPECT_EQ(late.message,
            "bulletin: got a storm recorded until 2021-07-24T00:00:00Z, then forecast until "
            "2021-07-24T12:00:00Z (issued 2021-07-24T00:00:00Z), expected one that is known after "
            "step 72 (2021-07-24T12:00:00Z); send a newer bulletin");
}

TEST(Storms, ThatAreWrongChangeNothing) {
  const auto ranch = test::MakeRanch(Placed());
  const std::uint64_t before = test::StateOf(*ranch).hash;
  const auto refused = [&](const auto& change) {
    aquafarm_msgs::Storm storm = North();
    change(storm);
    const auto answer = Notify(*ranch, storm);
    EXPECT_FALSE(answer.ok);
    EXPECT_EQ(answer.code, aquafarm_msgs::Outcome::BAD_VALUE);
    EXPECT_EQ(test::StateOf(*ranch).hash, before);
    return answer.message;
  };
  EXPECT_EQ(refused([](auto& s) { s.fixes[0].latitude_deg = 95.0; }),
            "storm.fixes[0].latitude_deg: got 95, expected a number in [-90, 90]");
  EXPECT_EQ(refused([](auto& s) { s.fixes[0].longitude_deg = std::nan(""); }),
            "storm.fixes[0].longitude_deg: got nan, expected a number in [-180, 180]");
  EXPECT_EQ(refused([](auto& s) { s.fixes[0].grade = 7; }),
            "storm.fixes[0].grade: got 7, expected a number in [0, 6]");
  EXPECT_EQ(refused([](auto& s) { s.fixes[0].rings[0].radius_km[3] = -1.0F; }),
            "storm.fixes[0].rings[0].radius_km[3]: got -1, expected a number in [0, 5000]");
  EXPECT_EQ(refused([](auto& s) { s.forecast[0].stamp = s.fixes[0].stamp; }),
            "storm.forecast[0].stamp: got 1627084800, expected a time after 1627084800");
  EXPECT_EQ(refused([](auto& s) { s.fixes[0].rings[1].wind_kt = 64; }),
            "storm.fixes[0].rings[1].wind_kt: got 64 twice, expected one ring per wind");
  EXPECT_EQ(refused([](auto& s) { s.fixes[0].max_wind_radius_km = -1.0F; }),
            "storm.fixes[0].max_wind_radius_km: got -1, expected a number in [0, 5000]");
  EXPECT_EQ(refused([](auto& s) { s.fixes.clear(); }),
            "storm.fixes: got none, expected at least one position");
  EXPECT_EQ(refused([](auto& s) {
              s.fixes.clear();
              s.forecast.clear();
            }),
            "storm.fixes: got none, expected at least one position")
      << "it has a name";
  EXPECT_EQ(refused([](auto& s) { s.fixes.resize(100000, s.fixes[0]); }),
            "storm.fixes: got 100000 entries, expected at most 10000");
  EXPECT_EQ(refused([](auto& s) {
              s.fixes[0].stamp.sec -= 100 * 3600;
              s.forecast.clear();
            }),
            "bulletin: got a storm known until 2021-07-19T20:00:00Z only; no forecast: it is "
            "assumed to keep its motion, wind and rings until 2021-07-20T20:00:00Z, expected one "
            "that is known after step 0 (2021-07-24T00:00:00Z); send a newer bulletin");
  const auto nowhere = test::MakeRanch(aquafarm::test::TinyScenario());
  EXPECT_EQ(Notify(*nowhere, North()).message,
            "bulletin: needs a ranch with grid.origin and time.start");
}

TEST(Storms, AreTheSameThereAndBack) {
  const aquafarm::StormTrack track = FromMsg(North());
  EXPECT_EQ(track.fixes[0].rings[0].wind_kt, 34) << "the weakest first";
  const aquafarm_msgs::Storm again = ToMsg(track);
  EXPECT_EQ(again.name, "IN-FA");
  ASSERT_EQ(again.forecast.size(), 1U);
  EXPECT_EQ(again.forecast[0].stamp.sec, kStart + 12 * 3600);
  EXPECT_FLOAT_EQ(again.fixes[0].wind_mps, 38.0F);
  EXPECT_EQ(ToMsg(FromMsg(again)), again);
}

// Compares numbers that a message stores in single precision.
void ExpectNear(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], 1e-5F * (1.0F + std::abs(b[i])));
}

void ExpectTheSameThroughAMessage(const aquafarm::StormTrack& track) {
  Scenario scenario = Placed();
  scenario.origin = track.fixes[0].position;
  scenario.start_time = track.fixes[0].time;
  const auto direct = aquafarm::ToDisaster(track, scenario, 0, 0);
  const auto through = aquafarm::ToDisaster(FromMsg(ToMsg(track)), scenario, 0, 0);
  EXPECT_EQ(through.duration, direct.duration);
  ASSERT_EQ(through.track.size(), direct.track.size());
  for (std::size_t i = 0; i < direct.track.size(); ++i) {
    const aquafarm::Waypoint& a = through.track[i];
    const aquafarm::Waypoint& b = direct.track[i];
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.grade, b.grade);
    EXPECT_EQ(a.risks, b.risks);
    ExpectNear({a.x, a.y}, {b.x, b.y});
    ExpectNear(a.radii, b.radii);
  }
}

TEST(Storms, MakeTheSameDisasterThroughAMessage) {
  const aquafarm::StormFile file = aquafarm::LoadStormFile(AQUAFARM_CORE_DIR "/test/data/atcf.dat");
  ASSERT_TRUE(file.tracks[0].fixes[0].max_wind_radius_km);
  ASSERT_EQ(file.tracks[0].fixes[0].averaging_min, 1) << "selects the estimate of radii";
  for (aquafarm::StormTrack track : file.tracks) {
    ExpectTheSameThroughAMessage(track);
    for (aquafarm::StormFix& fix : track.fixes) fix.rings.clear();  // all rings are then estimated
    ExpectTheSameThroughAMessage(track);
  }
}

TEST(Observations, HaveQuadrantsAndForecastsAsInProcess) {
  for (const auto mode : {aquafarm::ViewMode::kFull, aquafarm::ViewMode::kPartial}) {
    Scenario scenario = Placed();
    auto& storm = scenario.disasters[0];
    storm.quadrants = {{1, 1, 1, 0}, {4, 3, 2, 1}, {9, 5, 5, 5}};
    storm.radii = {1, 4, 9};
    storm.track = {{-10, -3, 2, 3, storm.radii, storm.risks, storm.quadrants},
                   {500, 40, 30, 3, storm.radii, storm.risks, storm.quadrants}};
    scenario.view.mode = mode;
    scenario.view.bulletin_period = 4;
    scenario.view.sensor_radius = 0.0F;
    scenario.view.forecast_error_km = {69, 121, 175};
    Farm farm = aquafarm::test::MakeFarm(scenario);
    aquafarm::test::RandomSteps(farm, 7, 1);
    aquafarm::View view;
    Observe(farm, 0, view);
    aquafarm_msgs::FarmState message;
    ToMsg(farm, view, {}, message);
    aquafarm::View through_ros;
    FromMsg(message, farm.scenario(), farm.layout(), through_ros);
    const aquafarm::Encoder encoder(farm.scenario());
    const auto count = static_cast<std::size_t>(encoder.feature_count());
    std::vector<float> a(count), b(count);
    encoder.Features(view, a.data());
    encoder.Features(through_ros, b.data());
    EXPECT_EQ(a, b);
    std::vector<std::uint8_t> p(encoder.planes_size()), q(encoder.planes_size());
    encoder.Planes(view, p.data());
    encoder.Planes(through_ros, q.data());
    EXPECT_EQ(p, q);
    EXPECT_NE(message.disasters[0].motion_x, farm.disasters()[0].dx) << "it is a forecast";
    EXPECT_EQ(message.disasters[0].quadrants.size(), 12U);
  }
}

TEST(Seas, AreGridsToLookAtAndNumbersWithUnits) {
  const Scenario scenario = aquafarm::test::TinyScenario();
  aquafarm::SeaLayer layer{"warmth", "degC", {}};
  for (int i = 0; i < 25; ++i) layer.values.push_back(20.0F + 0.5F * static_cast<float>(i));
  layer.values[7] = std::numeric_limits<float>::quiet_NaN();
  nav_msgs::OccupancyGrid grid;
  SeaToMsg(layer, scenario, {}, grid);
  EXPECT_EQ(grid.data[0], 0);
  EXPECT_EQ(grid.data[7], -1);
  EXPECT_EQ(grid.data[12], 50);
  EXPECT_EQ(grid.data[24], 100);
  EXPECT_EQ(grid.info.width, 5U);
  const std_msgs::Float32MultiArray values = SeaToMsg(layer, scenario);
  ASSERT_EQ(values.layout.dim.size(), 3U);
  EXPECT_EQ(values.layout.dim[0].label, "warmth [degC]");
  EXPECT_EQ(values.layout.dim[1].size, 5U);
  EXPECT_EQ(values.layout.dim[2].label, "x");
  EXPECT_EQ(values.data[24], 32.0F);
  layer.values.assign(25, 3.0F);
  SeaToMsg(layer, scenario, {}, grid);
  EXPECT_EQ(grid.data[24], 0) << "a flat sea";
}

}  // namespace
}  // namespace aquafarm_sim
