// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/map_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "aquafarm/ascii_grid.h"
#include "aquafarm/check.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

class MapFiles : public testing::Test {
 protected:
  MapFiles() : folder_(fs::temp_directory_path() / ("map_file_test." + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~MapFiles() override { fs::remove_all(folder_); }

  void Write(const char* name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  std::string Path(const char* name) const { return (folder_ / name).string(); }
  /// Writes m.yaml with more lines and reads it.
  MapFile Load(const std::string& more = "") const {
    Write("m.yaml", "image: m.pgm\nresolution: 200\norigin: [1, 2, 0]\nnegate: " +
                        std::string(more.find("light") == std::string::npos ? "0" : "1") +
                        "\noccupied_thresh: 0.65\nfree_thresh: 0.2\n" + more);
    return LoadMap(Path("m.yaml"));
  }
  std::string Refused(const std::string& more = "") const {
    try {
      Load(more);
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.substr(folder_.string().size() + 1);
    }
    return "was read";
  }

  const fs::path folder_;
};

std::vector<int> Values(const Grid<std::int8_t>& grid) {
  return {grid.data(), grid.data() + grid.size()};
}

// Grey 0, 128, 255 and 100: occupied 1, 0.498, 0, 0.608.
const std::string kPicture = std::string("P5\n# a comment\n2 2 255\n") + '\0' + "\x80\xff\x64";

TEST_F(MapFiles, TurnThePictureSouthUp) {
  Write("m.pgm", kPicture);
  const MapFile map = Load();
  EXPECT_EQ(Values(map.occupancy), (std::vector<int>{0, -1, 100, -1})) << "the last row is south";
  EXPECT_EQ(map.cell_size_m, 200.0);
  EXPECT_EQ(map.origin, (std::array<double, 3>{1.0, 2.0, 0.0}));
  const LandShare share = ShareOfLand(map);
  EXPECT_EQ(share(0, 0), 0.0F);
  EXPECT_EQ(share(0, 1), 1.0F) << "unknown";
}

TEST_F(MapFiles, KnowEveryMode) {
  Write("m.pgm", kPicture);
  EXPECT_EQ(Values(Load("mode: trinary\n").occupancy), (std::vector<int>{0, -1, 100, -1}));
  // 1 + 98 (0.498 - 0.2) / 0.45 = 65.9; 1 + 98 (0.608 - 0.2) / 0.45 = 89.8
  EXPECT_EQ(Values(Load("mode: scale\n").occupancy), (std::vector<int>{0, 89, 100, 65}));
  EXPECT_EQ(Values(Load("mode: raw\n").occupancy), (std::vector<int>{-1, 100, 0, -1}));
  EXPECT_EQ(Values(Load("# light is occupied\n").occupancy), (std::vector<int>{100, -1, 0, -1}));
}

TEST_F(MapFiles, ReadPlainAndDeepPgm) {
  Write("m.pgm", "P2 2 2 # words\n15\n0 8 15\n6\n");
  EXPECT_EQ(Values(Load().occupancy), (std::vector<int>{0, -1, 100, -1}));
  Write("m.pgm", std::string("P5 2 1 65535\n") + '\xff' + '\xff' + '\0' + '\0');
  EXPECT_EQ(Values(Load().occupancy), (std::vector<int>{0, 100}));
}

TEST_F(MapFiles, RefusePicturesThatAreNot) {
  Write("m.pgm", "P5\n65536 65536\n255\n1234");
  EXPECT_EQ(Refused(), "m.pgm:2: width: got '65536', expected a whole number in [1, 16384]");
  Write("m.pgm", "P5\n16384 16384\n255\n1234");
  EXPECT_EQ(Refused(), "m.pgm:3: got 4 bytes of pixels, expected 16384 x 16384 of 1 byte");
  Write("m.pgm", "P2\n16384 16384\n255\n1 2");
  EXPECT_EQ(Refused().substr(0, 17), "m.pgm:3: got 2 by");
  Write("m.pgm", "P2\n2 2\n255\n1 2 300 4\n");
  EXPECT_EQ(Refused(), "m.pgm:4: pixel: got '300', expected a whole number in [0, 255]");
  Write("m.pgm", "P5\n2 2");
  EXPECT_EQ(Refused(), "m.pgm:2: greatest value: got '', expected a whole number in [1, 65535]");
  Write("m.pgm", "GIF89a");
  EXPECT_EQ(Refused().substr(0, 48), "m.pgm:1: got no picture that can be read (unknow");
  fs::remove(folder_ / "m.pgm");
  EXPECT_EQ(Refused(), "m.pgm: cannot read: No such file or directory");
}

TEST_F(MapFiles, RefuseWrongKeys) {
  Write("m.pgm", kPicture);
  EXPECT_EQ(Refused("mode: tertiary\n").substr(0, 53),
            "m.yaml:7: mode: got 'tertiary', expected one of trina");
  EXPECT_EQ(Refused("height: 3\n").substr(0, 41), "m.yaml:7: height: unknown key 'height'; a");
  Write("m.yaml", "image: m.pgm\nresolution: 0\n");
  EXPECT_THROW(LoadMap(Path("m.yaml")), InputError);
  Write("m.yaml",
        "image: m.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.2\n"
        "free_thresh: 0.65\n");
  try {
    LoadMap(Path("m.yaml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find(":6: free_thresh: got 0.65, expected less than occupied_thresh = 0.2"),
              std::string::npos);
  }
}

TEST_F(MapFiles, OfATurnedMapGiveNoRanch) {
  MapFile map;
  map.origin[2] = 1.0;
  map.occupancy = Grid<std::int8_t>::Zero(2, 2);
  try {
    ShareOfLand(map);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "chart: origin[2]: got a yaw of 1, expected 0: a ranch's grid points north");
  }
}

TEST_F(MapFiles, AreWrittenAndReadBack) {
  Scenario scenario;
  scenario.width = 5;
  scenario.height = 3;
  scenario.cell_size_m = 200.0;
  scenario.islands = {{{4, 0}, 1, 1}, {{1, 2}, 1, 1}};
  scenario.rocks.cells = {{1, 1}};
  scenario.ports.count = scenario.devices.count = 1;
  const MapFile map = ToMap(scenario);
  EXPECT_EQ(map.occupancy.cast<int>().sum(), 300);
  EXPECT_EQ(map.occupancy(2, 1), 100);
  SaveMap(map, Path("out.yaml"));
  const MapFile back = LoadMap(Path("out.yaml"));
  EXPECT_EQ(Values(back.occupancy), Values(map.occupancy));
  EXPECT_EQ(back.occupancy(1, 1), 100) << "a rock";
  EXPECT_EQ(back.origin, (std::array<double, 3>{-100.0, -100.0, 0.0}));
  EXPECT_EQ(back.cell_size_m, 200.0);
  EXPECT_FALSE(fs::exists(folder_ / "out.yaml.part"));
  EXPECT_THROW(SaveMap(map, Path("nowhere/out.yaml")), InputError);
}

TEST(RealMaps, AreReadAsMapServerReadsThem) {
  const fs::path maps = SharedData() / "maps";
  if (!fs::exists(maps)) GTEST_SKIP() << "no maps at " << maps;
  const MapFile ten = LoadMap((maps / "TenByTen.yaml").string());
  EXPECT_EQ(ten.occupancy.rows(), 10);
  EXPECT_EQ(ten.cell_size_m, 1.0);
  // Greys of 0, 26 and 51 are occupied, 179 (0.298) unknown, 255 free.
  EXPECT_TRUE((ten.occupancy == 100 || ten.occupancy == -1 || ten.occupancy == 0).all());
  EXPECT_TRUE((ten.occupancy == -1).any());
  const MapFile png = LoadMap((maps / "testmap.yaml").string());
  EXPECT_EQ(png.origin, (std::array<double, 3>{2.0, 3.0, 1.0}));
  EXPECT_TRUE((png.occupancy == 100 || png.occupancy == 0).all());
  EXPECT_TRUE((png.occupancy == 100).any() && (png.occupancy == 0).any());
  // The same picture as BMP.
  const fs::path yaml = fs::temp_directory_path() / ("bmp." + std::to_string(getpid()) + ".yaml");
  std::ofstream(yaml) << "image: " << (maps / "testmap.bmp").string()
                      << "\nresolution: 0.1\norigin: [2, 3, 1]\nnegate: 0\n"
                         "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  EXPECT_EQ(Values(LoadMap(yaml.string()).occupancy), Values(png.occupancy));
  fs::remove(yaml);
}

const std::string kGrid =
    "ncols 3\nnrows 2\nxllcorner 122.0\nyllcorner 30.0\ncellsize 0.01\nNODATA_value -9999\n"
    "1 -2 3\n-9999 -5\n-6\n";

TEST(AsciiGrids, HaveTheirRowsFromTheNorth) {
  const AsciiGrid grid = ParseAsciiGrid(kGrid, "x");
  EXPECT_EQ(grid.value(1, 0), 1.0F);
  EXPECT_TRUE(std::isnan(grid.value(0, 0)));
  EXPECT_EQ(grid.value(0, 2), -6.0F);
  EXPECT_NEAR(grid.west, 122.005, 1e-9);
  EXPECT_TRUE(grid.IsGeographic());
  const LandShare share = ShareOfLand(grid, 0.0F);
  EXPECT_EQ(share(1, 0), 1.0F);
  EXPECT_EQ(share(0, 0), 1.0F) << "no data";
  EXPECT_EQ(share(0, 1), 0.0F);
  // On a ranch whose cells are the grid's, begun at the centre of its south-west value.
  const LandShare placed = ShareOfLand(grid, GeoFrame({30.005, 122.005}, 964.6), 3, 1, 0.0F);
  EXPECT_EQ(placed(0, 0), 1.0F);
  EXPECT_LT(placed(0, 1), 0.3F);
}

TEST(AsciiGrids, MayHaveTheirWordsBehind) {
  const AsciiGrid grid = ParseAsciiGrid(
      "2 ncols\n1 nrows\n10.0 xlower\n20.0 ylower\n200.0 cellsize\n-9999 nodata_value\n1\n-1\n",
      "x");
  EXPECT_FALSE(grid.IsGeographic());
  EXPECT_EQ(grid.west, 10.0) << "of the first value, not of its corner";
  EXPECT_EQ(grid.south, 20.0);
  EXPECT_EQ(grid.value(0, 1), -1.0F);
}

TEST(AsciiGrids, AreRefusedWithTheirLine) {
  const auto refused = [](const std::string& from, const std::string& to) {
    std::string text = kGrid;
    text.replace(text.find(from), from.size(), to);
    try {
      ParseAsciiGrid(text, "x");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("was read");
  };
  EXPECT_EQ(refused("-5\n-6\n", "-5\n"), "x:8: got 5 values, expected the 6 of the header");
  EXPECT_EQ(refused("-6\n", "-6 7\n"), "x:9: got more than the 6 values of the header");
  EXPECT_EQ(refused("-5", "five"),
            "x:8: value: got 'five', expected a number in [-1000000000, 1000000000]");
  EXPECT_EQ(refused("ncols 3", "ncols 16384").substr(0, 15), "x:7: got 103 by");
  EXPECT_EQ(refused("ncols 3\n", "").substr(0, 23), "x:6: NCOLS: got nothing");
  EXPECT_EQ(refused(kGrid, "").substr(0, 23), "x:1: NCOLS: got nothing");
}

}  // namespace
}  // namespace aquafarm
