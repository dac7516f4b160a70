// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/charts/map_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "aquafarm/base/check.h"
#include "aquafarm/charts/ascii_grid.h"

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
  static std::string Sample(const std::string& name) {
    std::ifstream file(fs::path(AQUAFARM_CORE_DIR) / "test/data" / name, std::ios::binary);
    EXPECT_TRUE(file.is_open()) << name;
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string Path(const char* name) const { return (folder_ / name).string(); }
  /// Writes m.yaml with additional lines and reads it.
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

// Grey values 0, 128, 255 and 100. Their occupied fractions are 1, 0.498, 0 and 0.608.
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

// Occupancy of a grey value in each mode of map_server, computed manually. The occupied fraction is
// (255 - grey) / 255, or grey / 255 with negate. The occupancy is 100 above 0.65, 0 below 0.2 and
// 1 + 98 (occupied - 0.2) / 0.45 between them.
struct Expected {
  int grey;
  int trinary, scale, raw;
  int trinary_negated, scale_negated, raw_negated;
};
constexpr std::array<Expected, 9> kExpected{{
    {0, 100, 100, 0, 0, 0, -1},
    {51, 100, 100, 51, -1, 1, -1},   // 0.8; negated 0.2: 1 + 0
    {89, 100, 100, 89, -1, 33, -1},  // 0.65098; 0.34902: 1 + 32.456
    {90, -1, 98, 90, -1, 34, -1},    // 0.64706: 1 + 97.359; 0.35294: 1 + 33.31
    {128, -1, 65, -1, -1, 66, -1},   // 0.49804: 1 + 64.906; 0.50196: 1 + 65.76
    {155, -1, 42, -1, -1, 89, 100},  // 0.39216: 1 + 41.848; 0.60784: 1 + 88.819
    {165, -1, 34, -1, -1, 98, 90},   // 0.35294: 1 + 33.31; 0.64706: 1 + 97.359
    {205, 0, 0, -1, 100, 100, 50},   // 0.19608; 0.80392
    {255, 0, 0, -1, 100, 100, 0},
}};

TEST_F(MapFiles, AreWhatMapServerMakesOfEveryGrey) {
  std::string picture = "P5 9 1 255\n";
  for (const Expected& one : kExpected) picture += static_cast<char>(one.grey);
  Write("m.pgm", picture);
  const auto all = [](auto member) {
    std::vector<int> values;
    for (const Expected& one : kExpected) values.push_back(one.*member);
    return values;
  };
  EXPECT_EQ(Values(Load("mode: trinary\n").occupancy), all(&Expected::trinary));
  EXPECT_EQ(Values(Load("mode: scale\n").occupancy), all(&Expected::scale));
  EXPECT_EQ(Values(Load("mode: raw\n").occupancy), all(&Expected::raw));
  EXPECT_EQ(Values(Load("mode: trinary # light\n").occupancy), all(&Expected::trinary_negated));
  EXPECT_EQ(Values(Load("mode: scale # light\n").occupancy), all(&Expected::scale_negated));
  EXPECT_EQ(Values(Load("mode: raw # light\n").occupancy), all(&Expected::raw_negated));
}

TEST_F(MapFiles, AreUnknownWhereAScaledPictureIsSeenThrough) {
  // A PNG of 4 x 1 pixels with grey and alpha: 0, 128 and 255 opaque, then 128 with alpha 100.
  static const char kBytes[] =
      "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00"
      "\x00\x04\x00\x00\x00\x01\x08\x04\x00\x00\x00\x53\x35\xc7\x46\x00\x00\x00"
      "\x11\x49\x44\x41\x54\x78\x9c\x63\x60\xf8\xdf\xf0\xff\xff\xff\x86\x14\x00"
      "\x17\x5a\x05\x61\xc0\xe5\x9b\x17\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42"
      "\x60\x82";
  Write("m.pgm", std::string(kBytes, sizeof(kBytes) - 1));
  EXPECT_EQ(Values(Load("mode: scale\n").occupancy), (std::vector<int>{100, 65, 0, -1}));
  EXPECT_EQ(Values(Load("mode: trinary\n").occupancy), (std::vector<int>{100, -1, 0, -1}));
  EXPECT_EQ(Values(Load("mode: raw\n").occupancy), (std::vector<int>{0, -1, -1, -1}));
}

TEST_F(MapFiles, ReadPngOfOneBitPerPixel) {
  // The upper half of 1024 x 1024 pixels is black. The file has 404 bytes: 2595 pixels per byte.
  Write("m.pgm", Sample("one_bit.png"));
  const MapFile map = Load();
  ASSERT_EQ(map.occupancy.rows(), 1024);
  ASSERT_EQ(map.occupancy.cols(), 1024);
  EXPECT_TRUE((map.occupancy.topRows(512) == 0).all()) << "row 0 is south";
  EXPECT_TRUE((map.occupancy.bottomRows(512) == 100).all());
}

TEST_F(MapFiles, ReadPlainAndDeepPgm) {
  Write("m.pgm", "P2 2 2 # words\n15\n0 8 15\n6\n");
  EXPECT_EQ(Values(Load().occupancy), (std::vector<int>{0, -1, 100, -1}));
  Write("m.pgm", std::string("P5 2 1 65535\n") + '\xff' + '\xff' + '\0' + '\0');
  EXPECT_EQ(Values(Load().occupancy), (std::vector<int>{0, 100}));
}

TEST_F(MapFiles, MayHaveLinesOfDos) {
  Write("m.pgm", std::string("P5\r\n2 2\r\n255\r\n") + '\0' + "\xff\xff" + '\0');
  EXPECT_EQ(Values(Load().occupancy), (std::vector<int>{0, 100, 100, 0})) << "from the south";
  // With a line end of one byte, the first pixel may have the value of a line feed.
  Write("m.pgm", std::string("P5 2 1 255\n") + "\n" + '\0');
  EXPECT_EQ(Values(Load().occupancy), (std::vector<int>{100, 100}));
}

TEST_F(MapFiles, RefusePicturesThatAreNot) {
  Write("m.pgm", std::string("P5 2 1 255\n") + "abcde");
  EXPECT_EQ(Refused(), "m.pgm:1: got 5 bytes of pixels, expected 2");
  Write("m.pgm", std::string("P5 2 1 9\n") + '\1' + '\x0b');
  EXPECT_EQ(Refused(), "m.pgm:1: pixel: got 11, expected one from 0 to 9");
  Write("m.pgm", "P2 2 1 255\n1 2 3\n");
  EXPECT_EQ(Refused(), "m.pgm:2: got more pixels than the stated size has");
  Write("m.pgm", "P5\n65536 65536\n255\n1234");
  EXPECT_EQ(Refused(), "m.pgm:2: width: got '65536', expected a whole number in [1, 16384]");
  Write("m.pgm", "P5\n16384 16384\n255\n1234");
  EXPECT_EQ(Refused(), "m.pgm:3: got 4 bytes of pixels, expected 16384 x 16384 of 1 byte");
  Write("m.pgm", "P2\n16384 16384\n255\n1 2");
  EXPECT_EQ(Refused().substr(0, 17), "m.pgm:3: got 2 by");
  Write("m.pgm", "P2\n2 2\n255\n1 2 300 4\n");
  EXPECT_EQ(Refused(), "m.pgm:4: pixel: got '300', expected a whole number in [0, 255]");
  Write("m.pgm", "P2\n2 2\n255\n1 2 three 4\n");
  EXPECT_EQ(Refused(), "m.pgm:4: pixel: got 'three', expected a whole number in [0, 255]");
  Write("m.pgm", "P5\n2 2");
  EXPECT_EQ(Refused(),
            "m.pgm:2: max value (maxval): got '', expected a whole number in [1, 65535]");
  Write("m.pgm", "GIF89a");
  EXPECT_EQ(Refused().substr(0, 40), "m.pgm:1: got an unreadable image (unknow");
  // The fuzz test found these: a chunk that states 1.9 GB in a file of 75 bytes, and one without
  // pixels.
  Write("m.pgm", Sample("found_length_of_chunk.png"));
  EXPECT_EQ(Refused(),
            "m.pgm:1: got a chunk of 1929379858 bytes, expected at most the 30 that the "
            "file still has; is it cut off?");
  Write("m.pgm", Sample("found_empty_pixels.png"));
  EXPECT_EQ(Refused(), "m.pgm:1: got an empty first chunk of pixels (IDAT)");
  fs::remove(folder_ / "m.pgm");
  EXPECT_EQ(Refused(), "m.pgm: cannot read: No such file or directory");
  ASSERT_EQ(mkfifo(Path("m.pgm").c_str(), 0600), 0);
  EXPECT_EQ(Refused(), "m.pgm: cannot read: not a regular file") << "a pipe is not waited for";
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
                 "origin[2]: got a yaw of 1, expected 0: a ranch's grid points north");
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

std::string Bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(RealMaps, AreReadAsMapServerReadsThem) {
  const fs::path maps = fs::path(AQUAFARM_CORE_DIR) / "test" / "data" / "real";
  const MapFile ten = LoadMap((maps / "TenByTen.yaml").string());
  EXPECT_EQ(ten.occupancy.rows(), 10);
  EXPECT_EQ(ten.cell_size_m, 1.0);
  // Grey values 0, 26 and 51 are occupied, 179 (0.298) is unknown, 255 is free.
  const std::string pgm = Bytes(maps / "TenByTen.pgm");
  ASSERT_EQ(pgm.compare(0, 2, "P5"), 0);
  for (int i = 0; i < 100; ++i) {
    const int grey =
        static_cast<unsigned char>(pgm[pgm.size() - 100 + static_cast<std::size_t>(i)]);
    const int expected = grey <= 51 ? 100 : grey == 179 ? -1 : grey == 255 ? 0 : 77;
    EXPECT_EQ(ten.occupancy(9 - i / 10, i % 10), expected) << i << " from the top";
  }
  const MapFile png = LoadMap((maps / "testmap.yaml").string());
  EXPECT_EQ(png.origin, (std::array<double, 3>{2.0, 3.0, 1.0}));
  EXPECT_TRUE((png.occupancy == 100 || png.occupancy == 0).all());
  EXPECT_TRUE((png.occupancy == 100).any() && (png.occupancy == 0).any());
  // The same image as BMP.
  const fs::path yaml = fs::temp_directory_path() / ("bmp." + std::to_string(getpid()) + ".yaml");
  std::ofstream(yaml) << "image: " << (maps / "testmap.bmp").string()
                      << "\nresolution: 0.1\norigin: [2, 3, 1]\nnegate: 0\n"
                         "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  const MapFile bmp = LoadMap(yaml.string());
  EXPECT_EQ(Values(bmp.occupancy), Values(png.occupancy));
  // A pixel of the BMP has bytes for blue, green and red. Rows start in the south and are padded to
  // four bytes.
  const std::string bytes = Bytes(maps / "testmap.bmp");
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const std::size_t start = at(10) + 256U * at(11);
  ASSERT_EQ(at(28), 24) << "bits a pixel";
  for (std::size_t y = 0; y < 10; ++y) {
    for (std::size_t x = 0; x < 10; ++x) {
      const std::size_t pixel = start + y * 32 + 3 * x;
      const int grey = (at(pixel) + at(pixel + 1) + at(pixel + 2)) / 3;
      EXPECT_EQ(bmp.occupancy(static_cast<int>(y), static_cast<int>(x)), grey < 128 ? 100 : 0)
          << x << ", " << y;
    }
  }
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
  // A ranch whose cells have the size of the grid's and start at its south-west value.
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
  EXPECT_EQ(refused("-5\n-6\n", "-5\n"),
            "x:8: got 5 values, expected the 6 that the header states");
  EXPECT_EQ(refused("-6\n", "-6 7\n"), "x:9: got more values than the 6 that the header states");
  EXPECT_EQ(refused("-5", "five"),
            "x:8: value: got 'five', expected a number in [-1000000000, 1000000000]");
  EXPECT_EQ(refused("ncols 3", "ncols 16384").substr(0, 15), "x:7: got 103 by");
  EXPECT_EQ(refused("ncols 3\n", "").substr(0, 23), "x:6: NCOLS: got nothing");
  EXPECT_EQ(refused(kGrid, "").substr(0, 23), "x:1: NCOLS: got nothing");
  EXPECT_EQ(refused("cellsize", "cellsise").substr(0, 39),
            "x:5: 'cellsise': unknown key, expected ");
  EXPECT_EQ(refused("nrows 2", "ncols 2"), "x:2: NCOLS: got the key twice, expected it once");
  EXPECT_EQ(refused("ncols 3", "ncols 3.9"), "x:1: NCOLS: got 3.9, expected a whole number");
  EXPECT_EQ(refused("ncols 3", "ncols 0"), "x:1: NCOLS: got 0, expected a number in [1, 16384]");
  EXPECT_EQ(refused("cellsize 0.01", "cellsize -1"),
            "x:5: CELLSIZE: got -1, expected a number in [1e-06, 1000000]");
  EXPECT_EQ(refused("cellsize", "xllcenter 122\ncellsize"),
            "x:5: XLLCENTER: appears together with XLLCORNER, expected one");
  const std::string number = "expected a number in [-1000000000, 1000000000]";
  EXPECT_EQ(refused("1 -2 3", "1 nan 3"), "x:7: value: got 'nan', " + number);
  EXPECT_EQ(refused("1 -2 3", "null -2 3"), "x:7: value: got 'null', " + number);
}

TEST(AsciiGrids, OfOneHugeLineAreRefused) {
  const std::string line(std::size_t{16 << 20} + 1, ' ');
  try {
    ParseAsciiGrid("ncols 2\n" + line, "x");
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "x:2: got a line of 16777217 bytes, expected at most 16777216: a row of the grid in "
        "each line");
  }
}

TEST(AsciiGrids, InDegreesLieOnTheGlobe) {
  const auto read = [](const std::string& from, const std::string& to) {
    std::string text = kGrid;
    text.replace(text.find(from), from.size(), to);
    try {
      return ParseAsciiGrid(text, "x").IsGeographic() ? "in degrees" : "in metres";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string latitude = ", expected degrees in [-90, 90], because CELLSIZE is below 1";
  const std::string longitude = ", expected degrees in [-360, 360], because CELLSIZE is below 1";
  const std::vector<std::array<std::string, 3>> cases{
      {"yllcorner 30.0", "yllcorner 89.98", "in degrees"},
      {"yllcorner 30.0", "yllcorner 89.99", "in degrees"},  // the last node lies on the pole
      {"yllcorner 30.0", "yllcorner -90.005", "in degrees"},
      {"yllcorner 30.0", "yllcorner 95",
       "x:4: YLLCORNER: got 95, so that the cells reach from 95.005 to 95.015" + latitude},
      {"yllcorner 30.0", "yllcorner -90.5",
       "x:4: YLLCORNER: got -90.5, so that the cells reach from -90.495 to -90.485" + latitude},
      {"yllcorner 30.0", "yllcenter 91",
       "x:4: YLLCENTER: got 91, so that the cells reach from 91 to 91.01" + latitude},
      {"yllcorner 30.0", "yllcorner 3400000", "in metres"},
      {"xllcorner 122.0", "xllcorner -180", "in degrees"},
      {"xllcorner 122.0", "xllcorner 361",
       "x:3: XLLCORNER: got 361, so that the cells reach from 361.005 to 361.025" + longitude},
      {"cellsize 0.01", "cellsize 1", "in metres"},
  };
  for (const auto& [from, to, words] : cases) EXPECT_EQ(read(from, to), words) << to;
}

}  // namespace
}  // namespace aquafarm
