// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/validate.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

// Slow oracle: spreads from cell to cell until nothing changes.
bool WaterConnects(const Layout& layout, const std::vector<Cell>& cells) {
  const auto height = static_cast<std::int32_t>(layout.cells.rows());
  const auto width = static_cast<std::int32_t>(layout.cells.cols());
  Grid<bool> wet = Grid<bool>::Constant(height, width, false);
  wet(cells[0].y, cells[0].x) = true;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::int32_t y = 0; y < height; ++y) {
      for (std::int32_t x = 0; x < width; ++x) {
        if (wet(y, x) || (layout.bits({x, y}) & kBlockedBits) != 0) continue;
        for (const Cell move : kMoves) {
          const Cell from{x - move.x, y - move.y};
          if (from.x < 0 || from.x >= width || from.y < 0 || from.y >= height) continue;
          if (!wet(from.y, from.x)) continue;
          wet(y, x) = changed = true;
          break;
        }
      }
    }
  }
  return std::all_of(cells.begin(), cells.end(), [&](Cell cell) { return wet(cell.y, cell.x); });
}

bool HasNeighbour(const Layout& layout, Cell cell, std::uint8_t bits) {
  return std::any_of(kMoves.begin(), kMoves.end(), [&](Cell move) {
    const Cell to{cell.x + move.x, cell.y + move.y};
    return to.x >= 0 && to.x < layout.cells.cols() && to.y >= 0 && to.y < layout.cells.rows() &&
           (layout.bits(to) & bits) != 0;
  });
}

void ExpectValid(const Scenario& scenario, const Layout& layout) {
  const auto rocks = static_cast<std::int32_t>(layout.rocks.size());
  ASSERT_GE(rocks, scenario.rocks.count.min);
  ASSERT_LE(rocks, scenario.rocks.count.max);
  ASSERT_EQ(static_cast<std::int32_t>(layout.ports.size()), scenario.ports.count);
  ASSERT_EQ(static_cast<std::int32_t>(layout.devices.size()), scenario.devices.Total());
  std::vector<Cell> reachable = layout.ports;
  for (const PlacedDevice& device : layout.devices) {
    reachable.push_back(device.cell);
    ASSERT_EQ(layout.bits(device.cell), kDeviceSiteBit);
    ASSERT_GE(device.value, scenario.devices.value.min);
    ASSERT_LE(device.value, scenario.devices.value.max);
  }
  for (const Cell port : layout.ports) {
    ASSERT_EQ(layout.bits(port), kPortBit);
    ASSERT_TRUE(scenario.islands.empty() || HasNeighbour(layout, port, kIslandBit));
  }
  for (const Cell rock : layout.rocks) {
    ASSERT_EQ(layout.bits(rock), kRockBit);
    ASSERT_GE(layout.crash_reward(rock.y, rock.x), scenario.rocks.reward.min);
    ASSERT_LE(layout.crash_reward(rock.y, rock.x), scenario.rocks.reward.max);
  }
  ASSERT_TRUE(WaterConnects(layout, reachable));
}

// Checks that counts from the grid equal those of the lists, and that the planes are consistent.
void ExpectConsistent(const Scenario& scenario, const Layout& layout) {
  std::size_t rocks = 0;
  std::size_t ports = 0;
  std::size_t sites = 0;
  for (std::int32_t y = 0; y < scenario.height; ++y) {
    for (std::int32_t x = 0; x < scenario.width; ++x) {
      const std::uint8_t bits = layout.bits({x, y});
      rocks += (bits & kRockBit) != 0;
      ports += (bits & kPortBit) != 0;
      sites += (bits & kDeviceSiteBit) != 0;
      const float reward = layout.crash_reward(y, x);
      ASSERT_EQ(reward < 0.0F, (bits & kBlockedBits) != 0);
      ASSERT_TRUE((bits & kIslandBit) == 0 || reward == scenario.rewards.island_crash);
      ASSERT_NEAR(layout.obstacle(y, x), 255.0F * std::min(1.0F, -reward / 20.0F), 0.5F);
    }
  }
  ASSERT_EQ(rocks, layout.rocks.size());
  ASSERT_EQ(ports, layout.ports.size());
  ASSERT_EQ(sites, layout.devices.size());
}

bool Same(const Layout& a, const Layout& b) {
  return (a.cells == b.cells).all() && (a.crash_reward == b.crash_reward).all() &&
         std::equal(a.devices.begin(), a.devices.end(), b.devices.begin(), b.devices.end(),
                    [](const PlacedDevice& p, const PlacedDevice& q) {
                      return p.cell == q.cell && p.value == q.value && p.kind == q.kind;
                    });
}

Scenario FarmOf(DevicePlacement placement, bool island) {
  Scenario scenario;
  scenario.layout = LayoutMode::kPerEpisode;
  scenario.devices.placement = placement;
  scenario.devices.count = 7;
  if (island) scenario.islands = {{{9, 10}, 6, 3}, {{11, 13}, 3, 2}};
  return scenario;
}

class Placements : public testing::TestWithParam<DevicePlacement> {};

TEST_P(Placements, AThousandEpisodesAreValid) {
  for (const bool island : {true, false}) {
    const Scenario scenario = FarmOf(GetParam(), island);
    ValidateScenario(scenario);
    LayoutGenerator generator(scenario);
    Layout layout;
    for (std::uint64_t episode = 0; episode < 1000; ++episode) {
      SCOPED_TRACE("seed 7, episode " + std::to_string(episode));
      generator.Generate(7, episode, layout);
      ExpectValid(scenario, layout);
      if (episode % 50 == 0) ExpectConsistent(scenario, layout);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST_P(Placements, ACrowdedFarmIsStillConnected) {
  Scenario scenario = FarmOf(GetParam(), true);
  scenario.rocks.count = {150, 220};
  LayoutGenerator generator(scenario);
  Layout layout;
  for (std::uint64_t episode = 0; episode < 200; ++episode) {
    SCOPED_TRACE("seed 8, episode " + std::to_string(episode));
    generator.Generate(8, episode, layout);
    ExpectValid(scenario, layout);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST_P(Placements, AMillionCellsTakeMilliseconds) {
  Scenario scenario = FarmOf(GetParam(), true);
  scenario.width = scenario.height = 1000;
  scenario.rocks.count = {10000, 20000};
  LayoutGenerator generator(scenario);
  Layout layout;
  generator.Generate(1, 0, layout);
  const auto start = std::chrono::steady_clock::now();
  generator.Generate(1, 1, layout);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 1.0) << "about 0.01 s in an optimised build";
}

INSTANTIATE_TEST_SUITE_P(All, Placements,
                         testing::Values(DevicePlacement::kUniform, DevicePlacement::kLinear,
                                         DevicePlacement::kRandom),
                         [](const auto& test) { return std::string(ToString(test.param)); });

TEST(Layout, IsAFunctionOfSeedAndEpisode) {
  const Scenario scenario = FarmOf(DevicePlacement::kRandom, true);
  LayoutGenerator first(scenario);
  LayoutGenerator second(scenario);
  Layout a;
  Layout b;
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    first.Generate(5, episode, a);
    second.Generate(5, 19 - episode, b);
    second.Generate(5, episode, b);
    ASSERT_TRUE(Same(a, b));
  }
  second.Generate(6, 19, b);
  EXPECT_FALSE(Same(a, b));
  second.Generate(5, 18, b);
  EXPECT_FALSE(Same(a, b));
}

TEST(FixedLayout, DependsOnItsOwnSeedAlone) {
  Scenario scenario = FarmOf(DevicePlacement::kUniform, true);
  scenario.layout = LayoutMode::kFixed;
  scenario.layout_seed = 3;
  LayoutGenerator generator(scenario);
  Layout a;
  Layout b;
  generator.Generate(1, 2, a);
  generator.Generate(9, 8, b);
  EXPECT_TRUE(Same(a, b));
  scenario.layout_seed = 4;
  generator.Generate(1, 2, b);
  EXPECT_FALSE(Same(a, b));
}

TEST(Layout, KeepsItsMemory) {
  const Scenario scenario = FarmOf(DevicePlacement::kLinear, true);
  LayoutGenerator generator(scenario);
  Layout layout;
  generator.Generate(1, 0, layout);
  const void* cells = layout.cells.data();
  const void* rocks = layout.rocks.data();
  const void* devices = layout.devices.data();
  for (std::uint64_t episode = 1; episode < 100; ++episode) generator.Generate(1, episode, layout);
  EXPECT_EQ(layout.cells.data(), cells);
  EXPECT_EQ(layout.rocks.data(), rocks);
  EXPECT_EQ(layout.devices.data(), devices);
}

TEST(Layout, MoreRocksLeavePortsAndDevicesWhereTheyAre) {
  Scenario few = FarmOf(DevicePlacement::kRandom, true);
  few.rocks.count = {1, 1};
  Scenario many = few;
  many.rocks.count = {9, 9};
  Layout a;
  Layout b;
  LayoutGenerator(few).Generate(1, 0, a);
  LayoutGenerator(many).Generate(1, 0, b);
  EXPECT_EQ(a.ports, b.ports);
  EXPECT_EQ(a.devices[3].cell, b.devices[3].cell);
  EXPECT_EQ(a.devices[3].value, b.devices[3].value);
}

TEST(ExplicitLayout, IsWhatTheScenarioSays) {
  Scenario scenario = test::TinyScenario();
  scenario.devices.sites.push_back({{4, 4}, DeviceKind::kBreedingRelease, std::nullopt, true});
  Layout layout;
  LayoutGenerator(scenario).Generate(1, 0, layout);
  EXPECT_EQ(layout.bits({0, 1}), kIslandBit);
  EXPECT_EQ(layout.bits({3, 3}), kRockBit);
  EXPECT_EQ(layout.crash_reward(3, 3), -4.0F);
  EXPECT_EQ(layout.bits({2, 0}), kPortBit);
  EXPECT_EQ(layout.bits({2, 2}), kDeviceSiteBit);
  EXPECT_EQ(layout.devices[0].value, 80.0F);
  EXPECT_GE(layout.devices[1].value, 50.0F);
  EXPECT_TRUE(layout.devices[1].self_propelled);
  EXPECT_EQ(layout.devices[1].kind, DeviceKind::kBreedingRelease);
  ExpectConsistent(scenario, layout);
}

TEST(Devices, TakeTheirKindsInTurnAndTheLastDriveThemselves) {
  Scenario scenario = FarmOf(DevicePlacement::kRandom, false);
  scenario.devices.kinds = {DeviceKind::kMonitoring, DeviceKind::kDeepWaterBreeding};
  scenario.devices.self_propelled = 2;
  Layout layout;
  LayoutGenerator(scenario).Generate(1, 0, layout);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(layout.devices[i].kind, scenario.devices.kinds[i % 2]);
    EXPECT_EQ(layout.devices[i].self_propelled, i >= 5);
  }
}

TEST(UniformDevices, KeepApart) {
  Scenario scenario = FarmOf(DevicePlacement::kUniform, false);
  scenario.devices.count = 9;
  LayoutGenerator generator(scenario);
  Layout layout;
  for (std::uint64_t episode = 0; episode < 50; ++episode) {
    generator.Generate(1, episode, layout);
    for (std::size_t i = 0; i < 9; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_GE(MovesBetween(layout.devices[i].cell, layout.devices[j].cell), 3);
      }
    }
  }
}

TEST(LinearDevices, StandInStraightRowsOnOpenWater) {
  Scenario scenario = FarmOf(DevicePlacement::kLinear, false);
  scenario.devices.count = 16;
  LayoutGenerator generator(scenario);
  Layout layout;
  for (std::uint64_t episode = 0; episode < 50; ++episode) {
    generator.Generate(1, episode, layout);
    std::set<std::int32_t> xs;
    std::set<std::int32_t> ys;
    for (const PlacedDevice& device : layout.devices) {
      xs.insert(device.cell.x);
      ys.insert(device.cell.y);
    }
    // A port on the edge of the map may displace one device from its row.
    ASSERT_LE(std::min(xs.size(), ys.size()), 3U);
  }
}

std::string MessageOf(const Scenario& scenario) {
  try {
    Layout layout;
    LayoutGenerator(scenario).Generate(1, 0, layout);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CrowdedLayout, NamesTheParameterToChange) {
  Scenario rocks = FarmOf(DevicePlacement::kRandom, false);
  rocks.rocks.count = {560, 560};
  EXPECT_EQ(MessageOf(rocks).find("layout.rocks.count: too crowded: no layout of 25 x 25 cells"),
            0U)
      << MessageOf(rocks);

  Scenario ports = FarmOf(DevicePlacement::kRandom, false);
  ports.islands = {{{0, 0}, 1, 1}};
  EXPECT_EQ(MessageOf(ports).find("layout.ports.count: "), 0U) << MessageOf(ports);

  Scenario devices = FarmOf(DevicePlacement::kUniform, false);
  devices.width = devices.height = 3;
  devices.rocks.count = {0, 0};
  EXPECT_EQ(MessageOf(devices).find("layout.devices.count: "), 0U) << MessageOf(devices);

  Scenario islands = test::TinyScenario();
  islands.islands = {{{0, 1}, 5, 1}};
  islands.rocks.cells = {{4, 4}};
  EXPECT_EQ(MessageOf(islands).find("layout.islands: "), 0U) << MessageOf(islands);

  Scenario wall = test::TinyScenario();
  wall.islands.clear();
  wall.rocks.cells = {{0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}};
  EXPECT_EQ(MessageOf(wall).find("layout.rocks.cells: "), 0U) << MessageOf(wall);
}

}  // namespace
}  // namespace aquafarm
