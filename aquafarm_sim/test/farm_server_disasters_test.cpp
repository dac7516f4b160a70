// SPDX-License-Identifier: BSD-3-Clause
// Disasters and forecasts set by a request.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "farm_server_fixture.h"

namespace aquafarm_sim {
namespace {

using namespace test;  // NOLINT: the fixture

aquafarm_msgs::SetDisaster::Request Bulletin() {
  aquafarm_msgs::SetDisaster::Request request;
  request.info.grade = 3;
  request.info.radii = {1.0F, 2.0F};
  request.info.risks = {-20.0F, -5.0F};
  request.info.speed = 0.5F;
  request.info.duration = 50;
  request.info.has_start = true;
  request.info.x = 1.0F;
  request.info.y = 3.0F;
  return request;
}

TEST(FarmServerDisasters, ABulletinAddsAndCorrectsADisaster) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 2);
  aquafarm_msgs::SetDisaster call;
  call.request = Bulletin();
  call.request.farm = -1;
  ranch->SetDisaster(call.request, call.response);
  ASSERT_TRUE(call.response.ok) << call.response.message;
  ASSERT_EQ(1U, StateOf(*ranch, 1).disasters.size());
  EXPECT_EQ(call.response.hash, StateOf(*ranch).hash);
  call.request.farm = 0;
  call.request.info.x = 4.0F;
  ranch->SetDisaster(call.request, call.response);
  EXPECT_TRUE(call.response.ok) << call.response.message;
  EXPECT_FLOAT_EQ(4.0F, StateOf(*ranch, 0).disasters[0].x);
  EXPECT_FLOAT_EQ(1.0F, StateOf(*ranch, 1).disasters[0].x);
}

aquafarm_msgs::SetDisaster::Request Forecast() {
  aquafarm_msgs::SetDisaster::Request request;
  request.farm = -1;
  request.forecast_only = true;
  request.forecasts.resize(1);
  request.forecasts[0].points.resize(1);
  request.forecasts[0].points[0].step = 20.0F;
  request.forecasts[0].points[0].x = 9.0F;
  return request;
}

TEST(FarmServerDisasters, AForecastChangesWhatShipsObserveAndNotTheDisaster) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 2);
  aquafarm_msgs::SetDisaster call;
  call.request = Bulletin();
  call.request.farm = -1;
  ranch->SetDisaster(call.request, call.response);
  const auto before = StateOf(*ranch).disasters[0];
  call.request = Forecast();
  ranch->SetDisaster(call.request, call.response);
  ASSERT_TRUE(call.response.ok) << call.response.message;
  EXPECT_EQ(before.x, StateOf(*ranch).disasters[0].x);
  EXPECT_EQ(before.motion_x, StateOf(*ranch).disasters[0].motion_x);
  ranch->Inspect([](const ServerView& view) {
    for (std::int32_t i = 0; i < 2; ++i) {
      aquafarm::View seen;
      aquafarm::Observe(view.batch.farm(i), 0, seen);
      EXPECT_FLOAT_EQ(seen.disasters[0].belief.dx, 8.0F / 20.0F) << "from 1 to 9 in 20 steps";
    }
  });
  const std::uint64_t hash = StateOf(*ranch).hash;
  const auto refused = [&](const aquafarm_msgs::SetDisaster::Request& request) {
    ranch->SetDisaster(request, call.response);
    EXPECT_FALSE(call.response.ok);
    EXPECT_EQ(hash, StateOf(*ranch).hash);
    return call.response.message;
  };
  call.request = Forecast();
  call.request.forecasts.clear();
  EXPECT_EQ("forecasts: got 0, expected exactly one: forecast_only is set", refused(call.request));
  call.request = Forecast();
  call.request.id = 1;
  EXPECT_EQ(
      "disaster: got 1, expected one of the 1 disasters of this episode; add it without "
      "forecast_only",
      refused(call.request));
  call.request = Forecast();
  call.request.forecasts[0].points.resize(1000000);
  EXPECT_EQ("forecasts[0].points: got 1000000 entries, expected at most 10000",
            refused(call.request));
}

TEST(FarmServerDisasters, HostileBulletinsChangeNothing) {
  const auto ranch = MakeRanch(aquafarm::test::TinyScenario(), 2);
  const std::uint64_t hash = StateOf(*ranch).hash;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<aquafarm_msgs::SetDisaster::Request> hostile(15, Bulletin());
  hostile[0].info.x = nan;
  hostile[1].info.radii = {1.0F, nan};
  hostile[2].info.risks = {-20.0F, infinity};
  hostile[3].info.speed = nan;
  hostile[4].info.radii.assign(1000000, 1.0F);
  hostile[5].info.track.resize(1000000);
  hostile[6].info.radii = {2.0F, 1.0F};
  hostile[7].info.risks = {-20.0F};
  hostile[8].info.turn_probability = 1.5F;
  hostile[9].id = 7;
  hostile[10].id = -1;
  hostile[11].farm = 2;
  hostile[12].info.grade = 9;
  hostile[13].info.has_heading = true;
  hostile[13].info.heading_deg = 360;
  hostile[14].info.duration = 0;
  for (std::size_t i = 0; i < hostile.size(); ++i) {
    aquafarm_msgs::SetDisaster::Response response;
    ranch->SetDisaster(hostile[i], response);
    EXPECT_FALSE(response.ok) << i;
    EXPECT_EQ(i == 11 ? Outcome::UNKNOWN_FARM : Outcome::BAD_VALUE, response.code)
        << i << ' ' << response.message;
    EXPECT_EQ(hash, StateOf(*ranch).hash) << i;
  }
}

TEST(FarmServerDisasters, ABulletinForAllFarmsIsTakenByAllOrNone) {
  const auto ranch = MakeRanch(aquafarm::test::CrowdedScenario(1, 0), 2);
  aquafarm_msgs::SetDisaster call;
  call.request.farm = 0;
  call.request.id = 2;
  call.request.info.grade = 3;
  call.request.info.radii = {2.0F};
  call.request.info.risks = {-10.0F};
  call.request.info.has_start = true;
  call.request.info.duration = 100;
  ranch->SetDisaster(call.request, call.response);
  ASSERT_TRUE(call.response.ok) << call.response.message;
  const std::uint64_t before = StateOf(*ranch).hash;
  call.request.farm = -1;
  call.request.info.has_start = false;
  call.request.info.speed = 1.0F;
  ranch->SetDisaster(call.request, call.response);
  EXPECT_FALSE(call.response.ok);
  EXPECT_EQ(StateOf(*ranch).hash, before) << "farm 0 has one to replace, farm 1 has not";
}

}  // namespace
}  // namespace aquafarm_sim
