// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/reader.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

const fs::path kShipped =
    fs::path(AQUAFARM_CORE_DIR).parent_path() / "scenarios" / "archives" / "zhoushan_cma.txt";

constexpr const char* kText = R"(aquafarm-storms 1
# a comment
storm 2106 2 CMA | In-Fa
202107250600 30 122.2 TY 33 970 34=300,200,200,250 50=100,100,80,100
202107251200 30.1 121.9 STS <10 -
storm WP012020 1 ATCF |
202001010000 -10 -179.5 unknown - 1000
202001010600 -10.125 179.875 TD 12.5 999.5
)";

TEST(Archive, IsReadAndWrittenBackTheSame) {
  const StormFile file = ParseStormFile(kText, "storms.txt");
  EXPECT_TRUE(file.warnings.empty());
  EXPECT_EQ(file.format, TrackFormat::kArchive);
  ASSERT_EQ(file.tracks.size(), 2U);
  const StormTrack& infa = file.tracks[0];
  EXPECT_EQ(infa.id, "2106");
  EXPECT_EQ(infa.name, "In-Fa");
  EXPECT_EQ(infa.agency, "CMA");
  EXPECT_EQ(infa.fixes[0].time, 1627192800);
  EXPECT_EQ(infa.fixes[0].wind_mps, 33.0);
  EXPECT_EQ(infa.fixes[0].averaging_min, 2);
  EXPECT_EQ(infa.fixes[0].grade, StormGrade::kTyphoon);
  EXPECT_EQ(infa.fixes[0].Ring(34)->radius_km, (std::array<double, 4>{300, 200, 200, 250}));
  EXPECT_EQ(infa.fixes[1].wind_below_mps, 10.0);
  EXPECT_FALSE(infa.fixes[1].pressure_hpa);
  EXPECT_EQ(file.tracks[1].fixes[1].position.latitude, -10.125);
  EXPECT_TRUE(file.tracks[1].name.empty());
  EXPECT_EQ(WriteArchive(file.tracks, {"a comment"}), kText);
}

std::string Refused(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  try {
    ParseStormFile(text, "storms.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Archive, RefusesWhatItCannotRead) {
  EXPECT_EQ(Refused(kText, "storms 1", "storms 2"),
            "storms.txt:1: got 'aquafarm-storms 2', expected aquafarm-storms 1; this version reads "
            "no other");
  EXPECT_EQ(
      Refused(kText, "TY", "XX"),
      "storms.txt:4: grade: got 'XX', expected one of unknown, TD, TS, STS, TY, STY, SuperTY");
  EXPECT_EQ(Refused(kText, "=300,200,200,250", "=300,200"),
            "storms.txt:4: ring: got '34=300,200', expected WIND=NE,SE,SW,NW");
  EXPECT_EQ(Refused(kText, "202107250600", "2021072506"),
            "storms.txt:4: time: got '2021072506', expected YYYYMMDDHHMM");
  EXPECT_EQ(Refused(kText, " | In-Fa", ""),
            "storms.txt:3: got 'storm 2106 2 CMA', expected: storm ID AVERAGING_MIN AGENCY | NAME");
}

TEST(ShippedArchive, HasTheFixesOfTheBestTracks) {
  const StormFile archive = LoadStormFile(kShipped.string());
  EXPECT_TRUE(archive.warnings.empty());
  EXPECT_GT(archive.tracks.size(), 100U);
  const fs::path folder = SharedData() / "tracks";
  if (!fs::exists(folder / "cma_archive")) GTEST_SKIP() << "no real files at " << folder;
  std::vector<StormTrack> all;
  for (const char* year : {"cma_archive/CH1997BST.txt", "cma_archive/CH2012BST.txt",
                           "CH2019BST.txt", "CH2021BST.txt"}) {
    const StormFile file = LoadStormFile((folder / year).string());
    all.insert(all.end(), file.tracks.begin(), file.tracks.end());
  }
  int compared = 0;
  for (const StormTrack& track : archive.tracks) {
    const auto same = std::find_if(all.begin(), all.end(), [&track](const StormTrack& other) {
      return other.id == track.id && other.name == track.name;
    });
    if (same == all.end()) continue;
    const StormTrack whole = Archived(*same);
    for (const StormFix& fix : track.fixes) {
      const auto at =
          std::find_if(whole.fixes.begin(), whole.fixes.end(),
                       [&fix](const StormFix& other) { return other.time == fix.time; });
      ASSERT_NE(at, whole.fixes.end()) << track.id;
      EXPECT_EQ(at->position.latitude, fix.position.latitude);
      EXPECT_EQ(at->position.longitude, fix.position.longitude);
      EXPECT_EQ(at->wind_mps, fix.wind_mps);
      EXPECT_EQ(at->wind_below_mps, fix.wind_below_mps);
      EXPECT_EQ(at->pressure_hpa, fix.pressure_hpa);
      EXPECT_EQ(at->grade, fix.grade) << track.id << " " << fix.time;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

TEST(ShippedArchive, IsReadInHalfASecond) {
  double least_s = 1e9;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    LoadStormFile(kShipped.string());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    least_s = std::min(least_s, took.count());
  }
  EXPECT_LE(least_s, 0.5);
}

}  // namespace
}  // namespace aquafarm
