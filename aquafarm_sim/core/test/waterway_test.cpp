// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/waterway.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tiny_farms.h"

namespace aquafarm {
namespace {

// A slow oracle: better and better ways, from cell to cell, until none changes.
Grid<std::int32_t> SlowSteps(const Grid<std::uint8_t>& cells, Cell target) {
  Grid<std::int32_t> steps = Grid<std::int32_t>::Constant(cells.rows(), cells.cols(), kUnreachable);
  steps(target.y, target.x) = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::int32_t y = 0; y < cells.rows(); ++y) {
      for (std::int32_t x = 0; x < cells.cols(); ++x) {
        if ((cells(y, x) & kBlockedBits) != 0) continue;
        for (const Cell move : kMoves) {
          const Cell to{x + move.x, y + move.y};
          if (to.x < 0 || to.y < 0 || to.x >= cells.cols() || to.y >= cells.rows()) continue;
          if (steps(to.y, to.x) + 1 >= steps(y, x)) continue;
          steps(y, x) = steps(to.y, to.x) + 1;
          changed = true;
        }
      }
    }
  }
  return steps;
}

Scenario WithWays(Scenario scenario) {
  scenario.view.waterways = true;
  return scenario;
}

TEST(Waterway, IsChartedForEveryPortAndEveryDeviceThatIsFetched) {
  const Scenario scenario = WithWays(test::CrowdedScenario(2));
  LayoutGenerator generator(scenario);
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    Layout layout;
    generator.Generate(7, episode, layout);
    std::vector<Cell> places = layout.ports;
    for (const PlacedDevice& device : layout.devices) {
      if (!device.self_propelled) places.push_back(device.cell);
    }
    ASSERT_EQ(places.size(), 2U + 4U);
    ASSERT_EQ(layout.ways.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Waterway& way = layout.ways[i];
      EXPECT_TRUE((way.steps == SlowSteps(layout.cells, places[i])).all());
      for (std::int32_t y = 0; y < scenario.height; ++y) {
        for (std::int32_t x = 0; x < scenario.width; ++x) {
          const std::int32_t left = way.steps(y, x);
          const bool leads = left > 0 && left < kUnreachable;
          ASSERT_EQ(way.move(y, x) != kNoMove, leads);
          if (!leads) continue;
          const Cell by = kMoves[way.move(y, x)];
          EXPECT_EQ(way.steps(y + by.y, x + by.x), left - 1);
        }
      }
    }
  }
}

TEST(Waterway, GoesRoundAnIslandAndStraightOnOpenWater) {
  const Farm farm = test::MakeFarm(WithWays(test::TinyScenario()));
  const Waterway& to_port = farm.layout().ways[0];  // at (2, 0), the island west of it
  EXPECT_EQ(to_port.steps(2, 0), 3);
  EXPECT_EQ(to_port.move(2, 0), static_cast<std::uint8_t>(Action::kEast));
  EXPECT_EQ(to_port.steps(4, 2), 4);
  EXPECT_EQ(to_port.move(4, 2), static_cast<std::uint8_t>(Action::kSouth));
  EXPECT_EQ(to_port.steps(0, 0), kUnreachable);
  EXPECT_EQ(to_port.move(0, 2), kNoMove);
}

TEST(Waterway, IsNotChartedUnlessAskedFor) {
  EXPECT_TRUE(test::MakeFarm(test::TinyScenario()).layout().ways.empty());
}

}  // namespace
}  // namespace aquafarm
