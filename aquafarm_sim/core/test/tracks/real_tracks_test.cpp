// SPDX-License-Identifier: BSD-3-Clause
// Tests the readers with published files; skipped if the files are missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "aquafarm/charts/coast.h"
#include "aquafarm/charts/map_file.h"
#include "aquafarm/sea/sea_field.h"
#include "aquafarm/storms/notices.h"
#include "aquafarm/tracks/reader.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

class RealFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(SharedData())) GTEST_SKIP() << "no real files at " << SharedData();
  }
  static StormFile Load(const char* path) {
    StormFile file = LoadStormFile((SharedData() / path).string());
    EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
    return file;
  }
  static std::size_t Fixes(const StormFile& file) {
    std::size_t count = 0;
    for (const StormTrack& track : file.tracks) count += track.fixes.size();
    return count;
  }
};

// Three archives contain one storm at the same hour, 2021-07-25 06:00 UTC.
constexpr std::int64_t kInFaNoon = 1627192800;
void ExpectAt(const StormFix& fix, double latitude, double longitude, double pressure_hpa) {
  EXPECT_DOUBLE_EQ(fix.position.latitude, latitude);
  EXPECT_DOUBLE_EQ(fix.position.longitude, longitude);
  EXPECT_EQ(fix.pressure_hpa, pressure_hpa);
}

TEST_F(RealFiles, OfCmaHaveEveryStorm) {
  const StormFile year = Load("tracks/CH2021BST.txt");
  EXPECT_EQ(year.tracks.size(), 26U);
  EXPECT_EQ(Fixes(year), 926U);
  const StormFix fix = At(FindTrack(year, "IN-FA"), kInFaNoon);
  ExpectAt(fix, 30.0, 122.2, 970.0);
  EXPECT_EQ(fix.wind_mps, 33.0);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  const StormFile other = Load("tracks/CH2019BST.txt");
  EXPECT_EQ(other.tracks.size(), 33U);
  EXPECT_EQ(Fixes(other), 1003U);
}

TEST_F(RealFiles, OfCmaWithABlankNameHaveEveryStorm) {
  const fs::path path = SharedData() / "tracks" / "cma_archive" / "CH1997BST.txt";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const StormFile year = LoadStormFile(path.string());
  EXPECT_EQ(year.tracks.size(), 30U);
  EXPECT_EQ(year.warnings.at(0), path.string() +
                                     ":849: name: got nothing, expected a name or (nameless); the "
                                     "storm is 9725 and has no name");
}

TEST_F(RealFiles, OfCmaTakeAtMostTwentyMillisecondsAYear) {
  double least_ms = 1e9;
  for (int i = 0; i < 10; ++i) {  // the fastest of some runs: other processes use the machine, too
    const auto start = std::chrono::steady_clock::now();
    Load("tracks/CH2021BST.txt");
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    least_ms = std::min(least_ms, took.count());
  }
  EXPECT_LE(least_ms, 20.0);
}

TEST_F(RealFiles, OfJmaHave169StormsAnd6154Points) {
  const StormFile file = Load("tracks/bst_all_2015-2021.txt");
  EXPECT_EQ(file.tracks.size(), 169U);
  EXPECT_EQ(Fixes(file), 6154U);
  const StormFix fix = At(FindTrack(file, "2106"), kInFaNoon);
  ExpectAt(fix, 30.0, 122.5, 970.0);
  EXPECT_NEAR(*fix.wind_mps, 65 * kMpsPerKnot, 1e-9);
  ASSERT_EQ(fix.rings.size(), 2U);
  EXPECT_NEAR(fix.Ring(50)->radius_km[0], 80 * kKmPerNauticalMile, 1e-9);
  EXPECT_NEAR(fix.Ring(50)->radius_km[2], 80 * kKmPerNauticalMile, 1e-9);
  // 325 nm to the east, 240 nm to the west.
  EXPECT_GT(fix.Ring(30)->radius_km[kNorthEastQuadrant], 300 * kKmPerNauticalMile);
  EXPECT_LT(fix.Ring(30)->radius_km[kNorthWestQuadrant], 260 * kKmPerNauticalMile);
  std::size_t blank = 0;
  std::size_t east = 0;
  for (const StormTrack& track : file.tracks) {
    for (const StormFix& each : track.fixes) {
      blank += each.rings.empty() ? 1 : 0;
      east += each.position.longitude < 0.0 ? 1 : 0;
    }
  }
  EXPECT_EQ(blank, 2355U);
  EXPECT_EQ(east, 22U);
}

TEST_F(RealFiles, OfBulletinsAgreeWithTheBestTrack) {
  const StormTrack storm = FindTrack(Load("bulletins/202106.json"), "In-Fa");
  EXPECT_EQ(storm.fixes.size(), 203U);
  EXPECT_EQ(storm.landfalls.size(), 2U);
  const StormFix fix = At(storm, kInFaNoon);
  ExpectAt(fix, 30.0, 122.2, 965.0);
  EXPECT_EQ(fix.wind_mps, 38.0);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_EQ(fix.heading_deg, 315.0);
  EXPECT_EQ(fix.speed_kmh, 12.0);
  using Radii = std::array<double, kQuadrantCount>;
  EXPECT_EQ(fix.Ring(34)->radius_km, (Radii{300, 200, 200, 250}));
  EXPECT_EQ(fix.Ring(50)->radius_km, (Radii{100, 100, 80, 100}));
  EXPECT_EQ(fix.Ring(64)->radius_km, (Radii{40, 40, 40, 40}));
  EXPECT_EQ(Load("bulletins/201909.json").tracks[0].fixes.size(), 158U);
  const StormTrack old = Load("bulletins/194906.json").tracks[0];
  EXPECT_EQ(old.fixes.size(), 33U);
  EXPECT_EQ(old.name, "Gloria");
}

TEST_F(RealFiles, OfOtherSourcesAreReadToTheEnd) {
  const StormTrack neoguri = FindTrack(Load("tracks/bwp082014.dat"), "Neoguri");
  EXPECT_EQ(neoguri.fixes.size(), 35U);
  EXPECT_EQ(neoguri.id, "WP082014");
  EXPECT_EQ(FindTrack(Load("tracks/bwp162014.dat"), "FUNG-WONG").fixes.size(), 27U);
  const StormFile active = Load("tracks/ibtracs.ACTIVE.list.v04r00.csv");
  ASSERT_EQ(active.tracks.size(), 3U);
  EXPECT_EQ(FindTrack(active, "IALY").fixes.size(), 49U);
  EXPECT_LT(FindTrack(active, "IALY").fixes[0].position.latitude, 0.0);
  EXPECT_EQ(FindTrack(active, "EWINIAR").fixes.size(), 27U);
  EXPECT_EQ(FindTrack(active, "REMAL").fixes.size(), 19U);
  const StormTrack ewiniar = Load("bulletins/qweather_getStormTrack.json").tracks[0];
  ASSERT_EQ(ewiniar.fixes.size(), 4U);
  EXPECT_EQ(ewiniar.fixes[3].grade, StormGrade::kSevereTropicalStorm);
  EXPECT_EQ(ewiniar.fixes[3].heading_deg, 45.0);
}

TEST_F(RealFiles, AreAllRead) {
  int read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(SharedData())) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().string();
    const std::string folder = entry.path().parent_path().filename().string();
    const std::string extension = entry.path().extension().string();
    if (folder == "tracks") {
      EXPECT_FALSE(LoadStormFile(path).tracks.empty()) << path;
    } else if (folder == "bulletins") {
      const std::string name = entry.path().filename().string();
      const bool notices = name.find("Warning") != std::string::npos || name.substr(0, 2) == "zs";
      EXPECT_FALSE(notices ? LoadNotices(path).notices.empty() : LoadStormFile(path).tracks.empty())
          << path;
    } else if (folder == "coast") {
      EXPECT_FALSE(LoadCoast(path).polygons.empty()) << path;
    } else if (folder == "ocean") {
      const GeoFrame frame({24.6, 57.6}, 2000.0);
      EXPECT_FALSE(LoadSeaField(path, {"so", {}, 0.0}, frame, 5, 5).latitude.empty()) << path;
    } else if (folder == "maps" && extension == ".yaml") {
      EXPECT_GT(LoadMap(path).occupancy.size(), 0) << path;
    } else if (folder == "maps") {
      EXPECT_TRUE(extension == ".pgm" || extension == ".png" || extension == ".bmp")
          << path << " is read with its YAML file";
    } else {
      continue;  // a file about the folder itself
    }
    ++read;
  }
  EXPECT_GE(read, 19);
}

}  // namespace
}  // namespace aquafarm
