// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/trail.h"

#include <gtest/gtest.h>

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

TEST(Trail, RemembersPlacesOldestFirst) {
  Trail trail;
  for (int i = 0; i < 3; ++i) trail.Update(At(static_cast<std::uint64_t>(i), 5 + i, 3));
  const ShipTrail* way = trail.Find(0);
  ASSERT_NE(way, nullptr);
  ASSERT_EQ(way->places.size(), 3U);
  EXPECT_EQ(way->places.front().x, 5);
  EXPECT_EQ(way->places.back().x, 7);
}

TEST(Trail, RemembersWhereADeviceWasAboard) {
  Trail trail;
  for (int i = 0; i < 4; ++i) {
    auto state = At(static_cast<std::uint64_t>(i), 5 + i, 3);
    state.ships.front().aboard.assign(i >= 2 ? 1 : 0, 0);
    trail.Update(state);
  }
  EXPECT_EQ(trail.Find(0)->loaded, (std::deque<bool>{false, false, true, true}));
}

TEST(Trail, HasALimit) {
  Trail trail;
  for (int i = 0; i < 100; ++i) trail.Update(At(static_cast<std::uint64_t>(i), i % 20, 3));
  EXPECT_LE(trail.Find(0)->places.size(), Trail::kLength);
  EXPECT_EQ(trail.Find(0)->loaded.size(), trail.Find(0)->places.size());
}

TEST(Trail, WithRoomForItIsTheWholeRoute) {
  Trail route(Trail::kWhole);
  for (int i = 0; i < 100; ++i) route.Update(At(static_cast<std::uint64_t>(i), i % 2, 3));
  EXPECT_EQ(route.Find(0)->places.size(), 100U);
}

TEST(Trail, BreaksOffWhereStatesAreMissing) {
  Trail trail;
  trail.Update(At(0, 5, 3));
  trail.Update(At(9, 14, 3));
  EXPECT_EQ(trail.Find(0)->places.size(), 1U);
}

TEST(Trail, RestartsWithAnEpisodeAndAfterAnEarlierStep) {
  Trail trail;
  trail.Update(At(3, 5, 3));
  trail.Update(At(4, 6, 3));
  auto next = At(5, 7, 3);
  ++next.episode;
  trail.Update(next);
  EXPECT_EQ(trail.Find(0)->places.size(), 1U);
  next.step = 1;
  next.ships.front().x = 8;
  trail.Update(next);
  EXPECT_EQ(trail.Find(0)->places.size(), 1U);
}

TEST(Trail, KeepsTheBearingWhileAShipPicksUp) {
  Trail trail;
  trail.Update(At(1, 5, 3));
  const auto picking = At(2, 5, 8);
  trail.Update(picking);
  EXPECT_EQ(ShipBearingDeg(picking.ships.front(), &trail), 90);
  EXPECT_EQ(ShipBearingDeg(picking.ships.front(), nullptr), 0);
}

TEST(Trail, ForgetsAShipOutOfSight) {
  Trail trail;
  auto state = At(1, 5, 3);
  trail.Update(state);
  state.ships.front().visible = false;
  state.step = 2;
  trail.Update(state);
  EXPECT_EQ(trail.Find(0), nullptr);
}

TEST(Trail, ARouteContinuesWhereStatesWereMissedAndATrailStartsAgain) {
  Trail trail;
  Trail route(Trail::kWhole);
  auto state = test::MakeState();
  for (const int x : {1, 2, 3, 12, 13}) {
    state.ships.front().x = x;
    ++state.step;
    trail.Update(state);
    route.Update(state);
  }
  EXPECT_EQ(trail.Find(0)->places.size(), 2U);
  ASSERT_EQ(route.Find(0)->places.size(), 5U);
  EXPECT_TRUE(Trail::IsGap(route.Find(0)->places[2], route.Find(0)->places[3]));
  EXPECT_FALSE(Trail::IsGap(route.Find(0)->places[3], route.Find(0)->places[4]));
  EXPECT_EQ(route.Find(0)->UnbrokenFrom(), 3U);  // a Path cannot contain gaps
  EXPECT_EQ(trail.Find(0)->UnbrokenFrom(), 0U);
}

}  // namespace
}  // namespace aquafarm_viz
