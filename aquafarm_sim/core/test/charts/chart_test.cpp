// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/charts/chart.h"

#include <gtest/gtest.h>

#include "aquafarm/base/check.h"
#include "aquafarm/charts/coast.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

// Parses rows from the north: # land, o rock, . water.
LandShare Drawn(const std::vector<std::string>& rows) {
  LandShare share(static_cast<Eigen::Index>(rows.size()),
                  static_cast<Eigen::Index>(rows[0].size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t x = 0; x < rows[i].size(); ++x) {
      share(static_cast<Eigen::Index>(rows.size() - 1 - i), static_cast<Eigen::Index>(x)) =
          rows[i][x] == '#'   ? 1.0F
          : rows[i][x] == 'o' ? 0.2F
                              : 0.0F;
    }
  }
  return share;
}

TEST(Terrain, MakesRocksOfALittleLandAndIslandsOfMore) {
  LandShare share = LandShare::Zero(2, 4);
  share(0, 0) = kLandShare;
  share(0, 1) = kRockShare;
  share(0, 2) = 0.04F;
  const Terrain terrain = ToTerrain(share);
  EXPECT_EQ(terrain.land(0, 0), 1);
  EXPECT_EQ(terrain.rocks, (std::vector<Cell>{{1, 0}}));
  EXPECT_EQ(terrain.land.cast<int>().sum(), 1);
  EXPECT_EQ(terrain.WaterCells(), 6);
}

TEST(Terrain, FillsWaterThatNoShipReaches) {
  const Terrain terrain = ToTerrain(Drawn({"......", ".###..", ".#.#..", ".###..", "......"}));
  EXPECT_EQ(terrain.filled, 1);
  EXPECT_EQ(terrain.land(2, 2), 1);
  const Terrain open = ToTerrain(Drawn({"......", ".##...", ".#.#..", ".###..", "......"}));
  EXPECT_EQ(open.filled, 0) << "ships go diagonally";
  EXPECT_THROW(ToTerrain(Drawn({"##", "##"})), InputError);
}

TEST(Islands, CoverTheLandExactly) {
  const Terrain terrain = ToTerrain(Drawn({"###...#", "###..##", "#.....#", ".......", "##.##.."}));
  Grid<std::uint8_t> painted = Grid<std::uint8_t>::Zero(5, 7);
  for (const IslandBlock& block : ToIslands(terrain.land)) {
    auto cells = painted.block(block.south_west.y, block.south_west.x, block.height, block.width);
    EXPECT_FALSE(cells.any()) << "covered twice";
    cells = 1;
  }
  EXPECT_TRUE((painted == terrain.land).all());
}

TEST(Ports, LieAtTheNearestShoreWater) {
  const Terrain terrain = ToTerrain(Drawn({".......", "..##...", "..##...", ".......", "......."}));
  EXPECT_EQ(NearestShore(terrain, {6, 2}, {}), (Cell{4, 2}));
  EXPECT_EQ(NearestShore(terrain, {6, 2}, {{4, 2}}), (Cell{4, 1})) << "from the south";
  EXPECT_EQ(NearestShore(terrain, {2, 2}, {}), (Cell{2, 1})) << "asked for on land";
  const Terrain calm = ToTerrain(Drawn({"...", "..."}));
  try {
    NearestShore(calm, {1, 1}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "port: got (1, 1), expected free water at a shore; the chart has none");
  }
}

TEST(Ports, AreSpreadAlongTheShore) {
  const Terrain terrain =
      ToTerrain(Drawn({"#........", ".........", "....#....", ".........", "........#"}));
  const std::vector<Cell> ports = SpreadPorts(terrain, 3);
  ASSERT_EQ(ports.size(), 3U);
  EXPECT_LE(MovesBetween(ports[0], {4, 2}), 1);
  EXPECT_GE(MovesBetween(ports[0], ports[1]), 3);
  EXPECT_GE(MovesBetween(ports[1], ports[2]), 6);
  EXPECT_EQ(SpreadPorts(terrain, 100).size(), 14U) << "all there are";
  EXPECT_TRUE(SpreadPorts(ToTerrain(Drawn({"..", ".."})), 4).empty());
}

const std::filesystem::path kData = std::filesystem::path(AQUAFARM_CORE_DIR) / "test" / "data";

TEST(Coast, FillsPolygonsAndLeavesTheirLakes) {
  const Coast coast = LoadCoast((kData / "coast.json").string());
  ASSERT_EQ(coast.polygons.size(), 2U);
  EXPECT_EQ(coast.polygons[0].size(), 2U) << "a shore and a lake";
  EXPECT_TRUE(coast.warnings.empty());
  // A cell is 964.6 m wide, which is approximately 0.01 degrees of longitude; 0.01 degrees of
  // latitude are 1108.5 m. The island covers x from 0.43 to 5.43 and y from 0.39 to 6.13.
  const GeoFrame frame({29.9966, 121.9957}, 964.6);
  const LandShare share = ShareOfLand(coast, frame, 12, 8);
  EXPECT_EQ(share(1, 1), 1.0F);
  EXPECT_EQ(share(0, 0), 0.0F) << "the island's corner does not reach the cell's centre";
  EXPECT_NEAR(share(3, 3), 0.1F, 0.1F) << "most of the lake";
  EXPECT_NEAR(share(3, 0), 0.07F, 0.14F);
  EXPECT_EQ(share(1, 7), 0.0F);
  EXPECT_NEAR(share.sum(), (5.0 * 5.0 - 1.0 + 0.5) * 1108.5 / 964.6, 0.8) << "in all";
}

// The projection on the tangent plane would map the far hemisphere onto the ranch, too.
TEST(Coast, OfTheFarSideIsIgnored) {
  const auto land = [](const std::string& ring, GeoPoint origin) {
    const Coast coast = ParseCoast(R"({"type": "Polygon", "coordinates": [)" + ring + "]}", "x");
    return ShareOfLand(coast, GeoFrame(origin, 1000.0), 12, 8).sum();
  };
  EXPECT_EQ(land("[[-60, -33], [-54, -33], [-54, -27], [-60, -27], [-60, -33]]", {30.2, 122.7}),
            0.0F);
  EXPECT_NEAR(land("[[120, 28], [125, 28], [125, 33], [120, 33], [120, 28]]", {30.2, 122.7}), 96.0F,
              1.0e-3F)
      << "around the ranch";
  EXPECT_NEAR(land("[[-180, 0], [-175, 0], [-175, 5], [-180, 5], [-180, 0]]", {2.0, 179.999}),
              91.2F, 1.0e-3F)
      << "behind the date line";
}

TEST(Coast, WarnsOfARingThatCrossesItself) {
  const Coast coast = ParseCoast(
      "{\"type\": \"Polygon\",\n\"coordinates\": [[[0,0],[2,2],[2,0],[0,2],[0,0]]]}", "x");
  EXPECT_EQ(coast.warnings,
            std::vector<std::string>{"x:2: coordinates[0]: the ring crosses itself; an area that "
                                     "the ring encloses an odd number of times is land"});
}

TEST(Coast, WarnsOfARingThatRunsAlongItself) {
  const auto said = [](const std::string& ring) {
    const Coast coast = ParseCoast(
        "{\"type\": \"Feature\", \"geometry\": {\"type\": \"Polygon\",\n\"coordinates\": [" + ring +
            "]}}",
        "x");
    return coast.warnings.empty() ? "" : coast.warnings[0];
  };
  const std::string along =
      "x:2: geometry.coordinates[0]: the ring overlaps itself; an area that the ring encloses an "
      "odd number of times is land";
  EXPECT_EQ(said("[[0,0],[2,0],[2,2],[3,3],[2,2],[0,2],[0,0]]"), along) << "out and back";
  EXPECT_EQ(said("[[0,0],[4,0],[4,1],[4,-1],[4,2],[0,2],[0,0]]"), along) << "upright";
  EXPECT_EQ(said("[[0,0],[3,0],[3,1],[2,1],[2,0],[1,0],[1,2],[0,2],[0,0]]"), along)
      << "in parts of a line";
  EXPECT_EQ(said("[[0,0],[1,0],[2,0],[2,2],[2,2],[0,2],[0,0]]"), "")
      << "a point on a line, and one that is there twice";
  EXPECT_EQ(said("[[0,0],[2,0],[1,1],[2,2],[0,2],[1,1],[0,0]]"), "") << "touched in a point";
}

TEST(Coast, SaysWhenARingHasTooManyLinesToLookThrough) {
  std::string ring;
  for (int i = 0; i < 11'000; ++i) {
    ring += "[" + std::to_string(i % 2) + "," + std::to_string(i / 11'000.0) + "],";
  }
  const auto said = [&ring](const std::string& west) {
    const Coast coast = ParseCoast("{\"type\": \"Polygon\", \"coordinates\": [[" + ring +
                                       "[-1,1]," + west + "[-1,0],[0,0.0]]]}",
                                   "x");
    return coast.warnings.size() == 1 ? coast.warnings[0] : "";
  };
  EXPECT_EQ(
      said("").substr(0, 143),
      "x:1: coordinates[0]: the ring of 11002 lines was not fully checked for crossings, nor are "
      "the rings after it: the limit of 50000000 comparisons");
  EXPECT_EQ(said("[-2,1],[-1,1],").substr(0, 90),
            "x:1: coordinates[0]: the ring of 11004 lines overlaps itself and was not fully "
            "checked for")
      << "out and back before there were too many";
}

TEST(Coast, SpendsItsComparisonsOnTheWholeFile) {
  std::string ring;  // takes 18.7 million comparisons
  for (int i = 0; i < 6'114; ++i) {
    ring += "[" + std::to_string(i % 2) + "," + std::to_string(i / 6'114.0) + "],";
  }
  ring = "[[" + ring + "[-1,1],[-1,0],[0,0.0]]]";
  std::string rings = ring;
  for (int i = 1; i < 12; ++i) rings += ",\n" + ring;
  const Coast coast =
      ParseCoast("{\"type\": \"MultiPolygon\", \"coordinates\": [\n" + rings + "]}", "x");
  EXPECT_EQ(coast.polygons.size(), 12U);
  ASSERT_EQ(coast.warnings.size(), 1U);
  EXPECT_EQ(coast.warnings[0],
            "x:4: coordinates[2][0]: the ring of 6116 lines was not fully checked for crossings, "
            "nor are the rings after it: the limit of 50000000 comparisons per file is reached; "
            "an area that the ring encloses an odd number of times is land");
}

TEST(Coast, RefusesOtherDataThanCoasts) {
  const auto refused = [](const std::string& text) {
    try {
      ParseCoast(text, "x");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("was read");
  };
  const auto polygon = [](const std::string& ring) {
    return "{\"type\": \"Polygon\",\n\"coordinates\": [" + ring + "]}";
  };
  EXPECT_EQ(refused(polygon("[[0,0],[1,0],[1,1],[0,1]]")),
            "x:2: coordinates[0]: got an open ring, expected its last point to equal its first");
  EXPECT_EQ(refused(polygon("[[0,0],[1,0],[0,0]]")),
            "x:2: coordinates[0]: got 3 points, expected a ring of at least 4, the last equal "
            "to the first");
  EXPECT_EQ(refused(polygon("[[0,0],\n[1,95],[1,1],[0,0]]")),
            "x:3: coordinates[0][1]: got '[1,95]', expected [longitude, latitude] in degrees");
  EXPECT_EQ(refused(polygon("[[0,0],[1,\"a\"],[1,1],[0,0]]")),
            "x:2: coordinates[0][1]: got '[1,\"a\"]', expected [longitude, latitude] in degrees");
  EXPECT_EQ(refused("{\"type\": \"FeatureCollection\",\n\"features\": [\n{\"type\": \"Feature\",\n"
                    "\"geometry\": {\"type\":\n\"Polygon\"\n}}]}"),
            "x:4: features[0].geometry.coordinates: got nothing, expected a list");
  EXPECT_EQ(refused("{\"type\": \"Polygon\",\n\"type\": \"Point\"}"),
            "x:2: got the key 'type' twice in an object, expected it once");
  EXPECT_EQ(refused("{\"type\": \"Polygon\"}"), "x:1: coordinates: got nothing, expected a list");
  EXPECT_EQ(refused("{\"type\": \"Ocean\"}"), "x:1: type: got 'Ocean', expected a type of GeoJSON");
  EXPECT_EQ(refused("{\"type\": \"FeatureCollection\", \"features\": []}"),
            "x:1: got no polygon, expected a coast");
  EXPECT_EQ(refused("[1, 2]"), "x:1: got a list, expected an object");
  EXPECT_EQ(refused("{\"type\":\n").substr(0, 19), "x:2: invalid JSON: ");
}

TEST(Coast, OfZhoushanHas217Polygons) {
  const std::filesystem::path path = SharedData() / "coast" / "zhoushan_330900.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no chart at " << path;
  const Coast coast = LoadCoast(path.string());
  EXPECT_EQ(coast.polygons.size(), 217U);
  EXPECT_TRUE(coast.warnings.empty()) << coast.warnings[0];
  // The ranch of zhoushan_infa_2021.yaml, whose islands were placed manually.
  const Terrain terrain =
      ToTerrain(ShareOfLand(coast, GeoFrame({30.105, 122.605}, 1000.0), 20, 14));
  Grid<std::uint8_t> by_hand = Grid<std::uint8_t>::Zero(14, 20);
  const std::vector<std::array<int, 4>> blocks{{4, 10, 1, 2},  {7, 10, 2, 2}, {8, 9, 1, 1},
                                               {10, 10, 1, 2}, {11, 8, 1, 1}, {15, 3, 3, 1}};
  for (const auto& [x, y, width, height] : blocks) by_hand.block(y, x, height, width) = 1;
  const auto differ = (terrain.land != by_hand).count();
  EXPECT_LE(differ, 4) << terrain.land.colwise().reverse().cast<int>();
}

}  // namespace
}  // namespace aquafarm
