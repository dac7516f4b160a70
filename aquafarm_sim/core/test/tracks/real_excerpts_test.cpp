// SPDX-License-Identifier: BSD-3-Clause
// The readers of tracks on the published excerpts in test/data/real, which every clone has.
#include <gtest/gtest.h>

#include <algorithm>

#include "storm_samples.h"

namespace aquafarm {
namespace {

const std::filesystem::path kReal = kData / "real";

StormFile LoadReal(const char* name) {
  StormFile file = LoadStormFile((kReal / name).string());
  EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
  return file;
}

TEST(RealExcerpts, OfJmaHaveEachPointAndItsRings) {
  const StormFile file = LoadReal("jma_in_fa_2021.txt");
  ASSERT_EQ(file.tracks.size(), 1U);
  const StormTrack& storm = FindTrack(file, "IN-FA");
  EXPECT_EQ(storm.id, "2106");
  EXPECT_EQ(storm.fixes.size(), 81U) << "as many as the header line states";
  const StormFix& fix = At(storm, kInFaNoon);
  EXPECT_DOUBLE_EQ(fix.position.latitude, 30.0);
  EXPECT_DOUBLE_EQ(fix.position.longitude, 122.5);
  EXPECT_EQ(fix.pressure_hpa, 970.0);
  EXPECT_NEAR(*fix.wind_mps, 65 * kMpsPerKnot, 1e-9);
  EXPECT_EQ(fix.averaging_min, 10);
  ExpectRadii(fix, 50, NauticalMiles({80, 80, 80, 80}));
  EXPECT_GT(fix.Ring(30)->radius_km[kNorthEastQuadrant], 300 * kKmPerNauticalMile);
  EXPECT_LT(fix.Ring(30)->radius_km[kNorthWestQuadrant], 260 * kKmPerNauticalMile);
  EXPECT_TRUE(storm.fixes.front().rings.empty()) << "a depression has no radii";
}

TEST(RealExcerpts, OfAnAtcfDeckMixShortRowsAndLongOnes) {
  const StormFile file = LoadReal("atcf_fung_wong_2014.dat");
  const StormTrack& storm = FindTrack(file, "FUNG-WONG");
  EXPECT_EQ(storm.id, "WP162014");
  ASSERT_EQ(storm.fixes.size(), 27U);
  EXPECT_DOUBLE_EQ(storm.fixes.front().position.latitude, 13.6);
  EXPECT_DOUBLE_EQ(storm.fixes.back().position.longitude, 123.8);
  EXPECT_NEAR(*storm.fixes.front().wind_mps, 20 * kMpsPerKnot, 1e-9);
  EXPECT_EQ(storm.fixes.front().averaging_min, 1);
  EXPECT_EQ(storm.fixes.back().pressure_hpa, 1007.0);
}

TEST(RealExcerpts, OfIbtracsHave163Columns) {
  const StormFile file = LoadReal("ibtracs_2024.csv");
  ASSERT_EQ(file.tracks.size(), 2U);
  const StormTrack& ialy = FindTrack(file, "IALY");
  ASSERT_EQ(ialy.fixes.size(), 6U);
  EXPECT_DOUBLE_EQ(ialy.fixes[0].position.latitude, -9.1);
  EXPECT_DOUBLE_EQ(ialy.fixes[0].position.longitude, 52.5);
  EXPECT_NEAR(*ialy.fixes[0].wind_mps, 35 * kMpsPerKnot, 1e-9) << "USA_WIND: WMO_WIND is blank";
  EXPECT_FALSE(ialy.fixes[0].interpolated);
  EXPECT_TRUE(ialy.fixes[1].interpolated) << "IFLAG is P";
  EXPECT_EQ(FindTrack(file, "EWINIAR").fixes.size(), 6U);
}

TEST(RealExcerpts, CutAtAnyLineAreReadOrRefusedInOneLine) {
  for (const char* name : {"jma_in_fa_2021.txt", "atcf_fung_wong_2014.dat", "ibtracs_2024.csv"}) {
    const std::string whole = Sample(std::string("real/") + name);
    int read = 0;
    int refused = 0;
    for (std::size_t end = whole.find('\n'); end != std::string::npos;
         end = whole.find('\n', end + 1)) {
      const std::string what = Refusal(whole.substr(0, end + 1));
      (what == "was read" ? read : refused) += 1;
      EXPECT_EQ(what.find('\n'), std::string::npos) << name << ": " << what;
    }
    EXPECT_GT(read, 0) << name;
    EXPECT_EQ(read + refused, std::count(whole.begin(), whole.end(), '\n')) << name;
  }
}

}  // namespace
}  // namespace aquafarm
