// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/disaster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/base/check.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::StillDisaster;

Disaster Spawned(const DisasterSpec& spec, std::uint64_t episode = 0) {
  return SpawnDisaster(spec, 0, 1, episode, 25, 25);
}

void Move(Disaster& disaster, int step) {
  MoveDisaster(disaster, nullptr, {1, 0, RngStream::kDisasterTurn, 0}, step, 25, 25);
}

TEST(HeadingVector, IsTheCompass) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const auto direction = HeadingVector(degrees);
    const double radians = degrees * M_PI / 180.0;
    EXPECT_NEAR(direction[0], std::sin(radians), 1e-7) << degrees;
    EXPECT_NEAR(direction[1], std::cos(radians), 1e-7) << degrees;
  }
  EXPECT_EQ(HeadingVector(90)[0], 1.0F);
  EXPECT_THROW(HeadingVector(360), LogicError);
}

TEST(Risk, IsThatOfTheSmallestRingReachedInclusive) {
  const Disaster disaster = Spawned(StillDisaster(10, 10, {2, 5}, {-20, -5}));
  EXPECT_EQ(RiskOf(disaster, 10, 10), -20.0F);
  EXPECT_EQ(RiskOf(disaster, 12, 10), -20.0F);  // distance 2: on the ring
  EXPECT_EQ(RiskOf(disaster, 12, 11), -5.0F);
  EXPECT_EQ(RiskOf(disaster, 13, 14), -5.0F);  // distance 5 (3-4-5 triangle): on the ring
  EXPECT_EQ(RiskOf(disaster, 14, 14), 0.0F);
}

TEST(Risk, OfSeveralDisastersIsTheWorst) {
  const std::vector<Disaster> disasters{Spawned(StillDisaster(10, 10, {3}, {-6})),
                                        Spawned(StillDisaster(11, 10, {3}, {-9}))};
  EXPECT_EQ(RiskAt(disasters, {10, 10}), -9.0F);
  EXPECT_EQ(RiskAt(disasters, {7, 10}), -6.0F);
  EXPECT_EQ(RiskAt(disasters, {14, 10}), -9.0F);
}

TEST(Risk, OfNoDisasterIsZero) { EXPECT_EQ(RiskAt({}, {3, 3}), 0.0F); }

TEST(Risk, GridAgreesWithLookUps) {
  const std::vector<Disaster> disasters{Spawned(DisasterSpec{}, 3), Spawned(DisasterSpec{}, 4)};
  Grid<float> risk(25, 25);
  FillRisk(Scenario{}, disasters, risk);
  for (int y = 0; y < 25; ++y) {
    for (int x = 0; x < 25; ++x) EXPECT_EQ(risk(y, x), RiskAt(disasters, {x, y}));
  }
}

TEST(Spawn, IsUniformOnTheEnlargedMap) {
  DisasterSpec spec;  // largest radius 6
  int outside = 0;
  for (std::uint64_t episode = 0; episode < 2000; ++episode) {
    const Disaster disaster = Spawned(spec, episode);
    EXPECT_GE(disaster.x, -6.5F);
    EXPECT_LE(disaster.x, 30.5F);
    EXPECT_GE(disaster.y, -6.5F);
    EXPECT_LE(disaster.y, 30.5F);
    const bool inside =
        disaster.x >= -0.5F && disaster.x <= 24.5F && disaster.y >= -0.5F && disaster.y <= 24.5F;
    outside += inside ? 0 : 1;
  }
  EXPECT_NEAR(outside / 2000.0, 1.0 - 625.0 / (37.0 * 37.0), 0.05);
}

TEST(Motion, SlowDisastersCrossACellFromTimeToTime) {
  DisasterSpec spec = StillDisaster(5, 5, {2}, {-5});
  spec.speed = 0.25F;
  spec.heading_deg = 90;
  Disaster disaster = Spawned(spec);
  for (int step = 1; step <= 4; ++step) Move(disaster, step);
  EXPECT_EQ(disaster.x, 6.0F);
  EXPECT_EQ(disaster.y, 5.0F);
}

TEST(Motion, TurnsBy45DegreesAsOftenAsAsked) {
  DisasterSpec spec;
  spec.turn_probability = 0.25F;
  spec.border = Border::kLeave;
  spec.duration = 10000;
  Disaster disaster = Spawned(spec);
  int turns = 0;
  int right = 0;
  for (int step = 1; step <= 8000; ++step) {
    const int before = disaster.heading_deg;
    Move(disaster, step);
    if (disaster.heading_deg == before) continue;
    ++turns;
    const int by = (disaster.heading_deg - before + 360) % 360;
    EXPECT_TRUE(by == 45 || by == 315) << by;
    right += by == 45 ? 1 : 0;
  }
  EXPECT_NEAR(turns / 8000.0, 0.25, 0.02);
  EXPECT_NEAR(right / static_cast<double>(turns), 0.5, 0.05);
}

TEST(Motion, ReflectsAtTheEnlargedBorder) {
  DisasterSpec spec = StillDisaster(26.0F, 10.0F, {2}, {-5});  // border at 24.5 + 2
  spec.speed = 1.0F;
  spec.heading_deg = 45;
  Disaster disaster = Spawned(spec);
  Move(disaster, 1);
  EXPECT_EQ(disaster.heading_deg, 315);
  EXPECT_LE(disaster.x, 26.5F);
  const float x = disaster.x;
  Move(disaster, 2);
  EXPECT_LT(disaster.x, x);
  EXPECT_GT(disaster.y, 10.0F);
}

TEST(Motion, OfOneSetFarOutsideComesInWithoutAJump) {
  DisasterSpec spec = StillDisaster(-300, 12, {2}, {-20});
  spec.speed = 1.5F;
  spec.heading_deg = 90;
  Disaster inwards = Spawned(spec);
  for (int step = 1; step <= 4; ++step) {
    Move(inwards, step);
    EXPECT_EQ(inwards.x, -300.0F + 1.5F * static_cast<float>(step));
    EXPECT_EQ(inwards.heading_deg, 90);
  }
  for (int step = 5; step <= 205; ++step) Move(inwards, step);
  EXPECT_EQ(inwards.x, -300.0F + 1.5F * 205.0F) << "on the map";
  spec.heading_deg = 270;
  Disaster away = Spawned(spec);
  Move(away, 1);
  EXPECT_EQ(away.x, -300.0F) << "turned";
  EXPECT_EQ(away.heading_deg, 90);
  Move(away, 2);
  EXPECT_EQ(away.x, -298.5F);
}

TEST(Motion, WrapsOrLeavesWhenAsked) {
  DisasterSpec spec = StillDisaster(26.0F, 10.0F, {2}, {-5});
  spec.speed = 1.0F;
  spec.heading_deg = 90;
  spec.border = Border::kWrap;
  Disaster wrapping = Spawned(spec);
  Move(wrapping, 1);
  EXPECT_EQ(wrapping.x, 27.0F - 29.0F);
  spec.border = Border::kLeave;
  Disaster leaving = Spawned(spec);
  Move(leaving, 1);
  EXPECT_EQ(leaving.x, 27.0F);
}

TEST(Motion, NeverLeavesTheEnlargedMapByDefault) {
  for (Border border : {Border::kReflect, Border::kWrap}) {
    DisasterSpec spec;
    spec.speed = 3.7F;
    spec.turn_probability = 0.5F;
    spec.border = border;
    spec.duration = 100000;
    Disaster disaster = Spawned(spec, 9);
    for (int step = 1; step <= 20000; ++step) {
      Move(disaster, step);
      ASSERT_GE(disaster.x, -6.5F);
      ASSERT_LE(disaster.x, 30.5F);
      ASSERT_GE(disaster.y, -6.5F);
      ASSERT_LE(disaster.y, 30.5F);
    }
  }
}

TEST(Motion, GrowsAndEnds) {
  DisasterSpec spec = StillDisaster(5, 5, {1, 2}, {-10, -5});
  spec.radius_growth = 0.5F;
  spec.duration = 2;
  Disaster disaster = Spawned(spec);
  Move(disaster, 1);
  EXPECT_EQ(disaster.radius[1], 2.5F);
  EXPECT_EQ(RiskOf(disaster, 7.5F, 5), -5.0F);
  Move(disaster, 2);
  EXPECT_FALSE(disaster.active());
  EXPECT_EQ(RiskOf(disaster, 5, 5), 0.0F);
}

TEST(Track, IsInterpolatedBetweenWaypoints) {
  DisasterSpec spec;
  spec.radii = {1, 2};
  spec.risks = {-20, -5};
  spec.duration = 100;
  spec.track = {{-10, 0, 0, 2, {1, 2}, {-20, -5}},
                {10, 20, 0, 3, {3, 4}, {-20, -5}},
                {20, 20, 10, 4, {0, 4}, {-10, -5}}};
  Disaster disaster = Spawned(spec);
  EXPECT_EQ(disaster.x, 10.0F);
  EXPECT_EQ(disaster.radius[0], 2.0F);
  EXPECT_EQ(disaster.grade, 2);
  EXPECT_EQ(disaster.heading_deg, 90);
  EXPECT_EQ(disaster.speed, 1.0F);
  const auto track = std::make_shared<const std::vector<Waypoint>>(spec.track);
  const StreamKey key{1, 0, RngStream::kDisasterTurn, 0};
  for (int step = 1; step <= 15; ++step) MoveDisaster(disaster, track, key, step, 25, 25);
  EXPECT_EQ(disaster.x, 20.0F);
  EXPECT_EQ(disaster.y, 5.0F);
  EXPECT_EQ(disaster.grade, 3);
  EXPECT_EQ(disaster.heading_deg, 0);
  EXPECT_EQ(disaster.radius[0], 1.5F);
  EXPECT_EQ(disaster.risk[0], -15.0F);
  for (int step = 16; step <= 30; ++step) MoveDisaster(disaster, track, key, step, 25, 25);
  EXPECT_EQ(disaster.y, 10.0F);
  EXPECT_EQ(RiskOf(disaster, 20, 10), -5.0F) << "a ring of radius 0 is absent";
}

}  // namespace
}  // namespace aquafarm
