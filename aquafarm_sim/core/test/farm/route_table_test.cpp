// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/route_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tiny_farms.h"

namespace aquafarm {
namespace {

// Slow oracle: relaxes the distances from cell to cell until nothing changes.
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
  scenario.view.routes = true;
  return scenario;
}

RouteEntry RouteFrom(const Layout& layout, Cell cell, std::size_t place) {
  const auto index =
      static_cast<std::size_t>(LinearIndex(cell, static_cast<std::int32_t>(layout.cells.cols())));
  return layout.routes[index * layout.route_count() + place];
}

TEST(RouteTable, IsChartedForEveryPortAndEveryDeviceThatIsFetched) {
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
    ASSERT_EQ(layout.route_count(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Grid<std::int32_t> steps = SlowSteps(layout.cells, places[i]);
      for (std::int32_t y = 0; y < scenario.height; ++y) {
        for (std::int32_t x = 0; x < scenario.width; ++x) {
          const RouteEntry route = RouteFrom(layout, {x, y}, i);
          ASSERT_EQ(route.steps, steps(y, x));
          const bool leads = route.steps > 0 && route.steps < kUnreachable;
          ASSERT_EQ(route.east != 0 || route.north != 0, leads);
          if (!leads) continue;
          ASSERT_EQ(steps(y + route.north, x + route.east), route.steps - 1);
        }
      }
    }
  }
}

TEST(RouteTable, GoesRoundAnIslandAndStraightOnOpenWater) {
  const Farm farm = test::MakeFarm(WithWays(test::TinyScenario()));
  const auto to_port = [&](Cell cell) { return RouteFrom(farm.layout(), cell, 0); };
  EXPECT_EQ(to_port({0, 2}).steps, 3);  // the port is at (2, 0), the island west of it
  EXPECT_EQ(to_port({0, 2}).east, 1);
  EXPECT_EQ(to_port({0, 2}).north, 0);
  EXPECT_EQ(to_port({2, 4}).steps, 4);
  EXPECT_EQ(to_port({2, 4}).east, 0);
  EXPECT_EQ(to_port({2, 4}).north, -1);
  EXPECT_EQ(to_port({0, 0}).steps, kUnreachable);
  EXPECT_EQ(to_port({2, 0}).north, 0);
}

TEST(RouteTable, IsNotChartedUnlessAskedFor) {
  EXPECT_TRUE(test::MakeFarm(test::TinyScenario()).layout().routes.empty());
}

}  // namespace
}  // namespace aquafarm
