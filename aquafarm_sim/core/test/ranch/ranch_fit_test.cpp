// SPDX-License-Identifier: BSD-3-Clause
// Inputs of a ranch that do not fit together are named in the message. Longitudes that differ by
// 360 degrees are equal.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "ranch_request.h"
#include "write_sea.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

class RanchFit : public testing::Test {
 protected:
  ~RanchFit() override { fs::remove(path_); }

  // An open ranch of 5 x 5 cells of 10 km.
  static RanchRequest At(GeoPoint center) {
    RanchRequest request;
    request.center = center;
    request.width = request.height = 5;
    request.cell_size_m = 10000.0;
    return request;
  }
  RanchRequest WithGrid(GeoPoint center, const std::string& west) {
    std::ofstream(path_) << "ncols 4\nnrows 4\nxllcorner " << west
                         << "\nyllcorner 19\ncellsize 0.5\n"
                            "-9 -9 -9 -9\n-9 -9 50 -9\n-9 -9 -9 -9\n-9 -9 -9 -9\n";
    RanchRequest request = At(center);
    request.chart = path_.string();
    request.ports = 1;
    return request;
  }
  RanchRequest WithCoast(GeoPoint center, const std::string& ring) {
    std::ofstream(path_) << R"({"type": "Polygon", "coordinates": [)" << ring << "]}";
    RanchRequest request = At(center);
    request.chart = path_.string();
    request.ports = 1;
    return request;
  }

  const fs::path path_{fs::temp_directory_path() / ("fit." + std::to_string(getpid()))};
};

TEST_F(RanchFit, AGridFromZeroTo360IsReadWestOfGreenwich) {
  const std::string from_zero = BuildRanch(WithGrid({20.0, -156.5}, "202.5")).yaml;
  EXPECT_NE(from_zero.find("islands:"), std::string::npos);
  const std::string from_west = BuildRanch(WithGrid({20.0, -156.5}, "-157.5")).yaml;
  EXPECT_EQ(from_zero, from_west);
}

TEST_F(RanchFit, AGridElsewhereIsRefusedWithBothPlaces) {
  EXPECT_EQ(Refused(WithGrid({10.0, -156.5}, "202.5")),
            path_.string() +
                ": got latitude 19.000 to 21.000, longitude -157.500 to -155.500, expected an area "
                "with the ranch at latitude 9.774 to 10.226, longitude -156.728 to -156.272; check "
                "--center, or leave out --chart for open sea");
}

TEST_F(RanchFit, AGridOfAPartOfTheRanchIsNamed) {
  EXPECT_TRUE(
      Says(BuildRanch(WithGrid({20.0, -155.6}, "202.5")).warnings,
           path_.string() + ": 5 of 25 cells of the ranch lie outside the grid and become land"));
  EXPECT_TRUE(BuildRanch(WithGrid({20.0, -156.5}, "202.5")).warnings.empty());
}

TEST_F(RanchFit, ACoastElsewhereIsRefusedWithBothPlaces) {
  const std::string ring = "[[121, 29], [122, 29], [122, 30], [121, 29]]";
  EXPECT_EQ(Refused(WithCoast({10.0, 150.0}, ring)),
            path_.string() +
                ": got latitude 29.000 to 30.000, longitude 121.000 to 122.000, expected an area "
                "with the ranch at latitude 9.774 to 10.226, longitude 149.772 to 150.228; check "
                "--center, or leave out --chart for open sea");
  EXPECT_NE(BuildRanch(WithCoast({29.5, 122.0}, ring)).yaml.find("islands:"), std::string::npos);
}

TEST_F(RanchFit, ACoastFromZeroTo360IsReadWestOfGreenwich) {
  const std::string ring =
      "[[203.4, 20.0], [203.6, 20.0], [203.6, 20.1], [203.4, 20.1], [203.4, 20.0]]";
  EXPECT_NE(BuildRanch(WithCoast({20.0, -156.5}, ring)).yaml.find("islands:"), std::string::npos);
}

TEST_F(RanchFit, AFieldYearsFromTheStartIsNamed) {
  WriteSea(path_.string(), "t", {29.0, 31.0}, {121.0, 123.0}, {20.0F, 20.0F, 20.0F, 20.0F});
  RanchRequest request = At({30.0, 122.0});
  request.sea = {{"warmth", path_.string(), "t"}};
  EXPECT_TRUE(BuildRanch(request).warnings.empty());
  request.start = kMidnight;
  EXPECT_TRUE(BuildRanch(request).warnings.empty()) << "a field without time";
  const auto warnings = [&](double time_h) {
    WriteSea(path_.string(), "t", {29.0, 31.0}, {121.0, 123.0}, {20.0F, 20.0F, 20.0F, 20.0F}, 0,
             time_h);
    return BuildRanch(request).warnings;
  };
  constexpr double kMidnight_h = static_cast<double>(kMidnight) / 3600.0;
  EXPECT_EQ(warnings(kMidnight_h - 2000.0 * 24.0),
            std::vector<std::string>{
                path_.string() +
                ": t: got 2016-02-02T00:00:00Z as the time nearest to the start, expected one "
                "within 2 days of 2021-07-25T00:00:00Z; it is 2000 days off: check --start"});
  EXPECT_TRUE(warnings(kMidnight_h + 40.0).empty());
}

TEST_F(RanchFit, AFieldElsewhereIsRefusedWithBothPlaces) {
  WriteSea(path_.string(), "t", {29.0, 31.0}, {121.0, 123.0}, {20.0F, 20.0F, 20.0F, 20.0F});
  RanchRequest request = At({10.0, 150.0});
  request.sea = {{"warmth", path_.string(), "t"}};
  EXPECT_EQ(Refused(request),
            path_.string() +
                ": t: got latitude 29.000 to 31.000, longitude 121.000 to 123.000, expected an "
                "area with the ranch at latitude 9.774 to 10.226, longitude 149.772 to 150.228; "
                "check --center, or use another file with --sea");
}

TEST_F(RanchFit, APortOutsideTheRanchIsNamed) {
  RanchRequest request = Request();
  request.port_places = {{31.0, 122.05}};
  EXPECT_TRUE(Says(BuildRanch(request).warnings,
                   "port: got 31.0000,122.0500, expected a place in the ranch at latitude "));
  request.port_places = {{30.03, 122.05}};  // the middle, which is land
  EXPECT_FALSE(
      Says(BuildRanch(request).warnings, "port: got 30.0300,122.0500, expected a place in the"));
}

}  // namespace
}  // namespace aquafarm
