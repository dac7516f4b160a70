// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "aquafarm_viz/scene/trail.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

aquafarm_msgs::FarmState At(std::uint64_t step, int x, std::uint8_t action) {
  auto state = test::MakeState();
  state.step = step;
  state.ships.front().x = x;
  state.ships.front().action = action;
  return state;
}

TEST(Wake, RemembersPlacesOldestFirst) {
  Wake wake;
  for (int i = 0; i < 3; ++i) wake.Update(At(static_cast<std::uint64_t>(i), 5 + i, 3));
  const ShipWake* way = wake.Find(0);
  ASSERT_NE(way, nullptr);
  ASSERT_EQ(way->places.size(), 3U);
  EXPECT_EQ(way->places.front().x, 5);
  EXPECT_EQ(way->places.back().x, 7);
}

TEST(Wake, HasALimit) {
  Wake wake;
  for (int i = 0; i < 100; ++i) wake.Update(At(static_cast<std::uint64_t>(i), i % 20, 3));
  EXPECT_LE(wake.Find(0)->places.size(), Wake::kLength);
}

TEST(Wake, WithRoomForItIsTheWholeRoute) {
  Wake route(Wake::kWhole);
  for (int i = 0; i < 100; ++i) route.Update(At(static_cast<std::uint64_t>(i), i % 2, 3));
  EXPECT_EQ(route.Find(0)->places.size(), 100U);
}

TEST(Wake, BreaksOffWhereStatesAreMissing) {
  Wake wake;
  wake.Update(At(0, 5, 3));
  wake.Update(At(9, 14, 3));
  EXPECT_EQ(wake.Find(0)->places.size(), 1U);
}

TEST(Wake, StartsAnewWithAnEpisodeAndAfterAnEarlierStep) {
  Wake wake;
  wake.Update(At(3, 5, 3));
  wake.Update(At(4, 6, 3));
  auto next = At(5, 7, 3);
  ++next.episode;
  wake.Update(next);
  EXPECT_EQ(wake.Find(0)->places.size(), 1U);
  next.step = 1;
  next.ships.front().x = 8;
  wake.Update(next);
  EXPECT_EQ(wake.Find(0)->places.size(), 1U);
}

TEST(Wake, KeepsTheBearingWhileAShipPicksUp) {
  Wake wake;
  wake.Update(At(1, 5, 3));
  const auto picking = At(2, 5, 8);
  wake.Update(picking);
  EXPECT_EQ(ShipBearingDeg(picking.ships.front(), &wake), 90);
  EXPECT_EQ(ShipBearingDeg(picking.ships.front(), nullptr), 0);
}

TEST(Wake, ForgetsAShipOutOfSight) {
  Wake wake;
  auto state = At(1, 5, 3);
  wake.Update(state);
  state.ships.front().visible = false;
  state.step = 2;
  wake.Update(state);
  EXPECT_EQ(wake.Find(0), nullptr);
}

TEST(Wake, ARouteGoesOnWhereStatesWereMissedAndAWakeBeginsAnew) {
  Wake wake;
  Wake route(Wake::kWhole);
  auto state = test::MakeState();
  for (const int x : {1, 2, 3, 12, 13}) {
    state.ships.front().x = x;
    ++state.step;
    wake.Update(state);
    route.Update(state);
  }
  EXPECT_EQ(wake.Find(0)->places.size(), 2U);
  ASSERT_EQ(route.Find(0)->places.size(), 5U);
  EXPECT_TRUE(Wake::IsGap(route.Find(0)->places[2], route.Find(0)->places[3]));
  EXPECT_FALSE(Wake::IsGap(route.Find(0)->places[3], route.Find(0)->places[4]));
  EXPECT_EQ(route.Find(0)->UnbrokenFrom(), 3U);  // a Path cannot contain gaps
  EXPECT_EQ(wake.Find(0)->UnbrokenFrom(), 0U);
}

}  // namespace
}  // namespace aquafarm_viz
