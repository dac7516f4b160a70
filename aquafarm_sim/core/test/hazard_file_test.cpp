// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/hazard_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "aquafarm/check.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(AQUAFARM_CORE_DIR) / "test" / "data";

std::string ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

HazardFile Load(const char* name) { return LoadHazardFile((kData / name).string()); }

constexpr std::int64_t kInFaNoon = 1627192800;  // 2021-07-25 06:00 UTC

using Radii = std::array<double, kQuadrantCount>;

void ExpectRadii(const HazardFix& fix, std::int32_t wind_kt, const Radii& expected) {
  const WindRing* ring = fix.Ring(wind_kt);
  ASSERT_NE(ring, nullptr) << wind_kt;
  for (std::size_t q = 0; q < expected.size(); ++q) {
    EXPECT_NEAR(ring->radius_km[q], expected[q], 0.05) << wind_kt << " kt, quadrant " << q;
  }
  EXPECT_FALSE(ring->estimated);
}

Radii NauticalMiles(Radii radii) {
  for (double& radius : radii) radius *= kKmPerNauticalMile;
  return radii;
}

TEST(HazardFormat, IsKnownByItsContent) {
  const std::vector<std::pair<const char*, HazardFormat>> files{
      {"cma.txt", HazardFormat::kCma},
      {"jma.txt", HazardFormat::kJma},
      {"atcf.dat", HazardFormat::kAtcf},
      {"ibtracs.csv", HazardFormat::kIbtracs},
      {"bulletin.json", HazardFormat::kBulletin},
      {"zhejiang.js", HazardFormat::kBulletin},
      {"weather_service.json", HazardFormat::kWeatherService}};
  for (const auto& [name, format] : files) {
    EXPECT_EQ(DetectHazardFormat(ReadFile(kData / name)), format) << name;
    EXPECT_EQ(Load(name).format, format) << name;
  }
  EXPECT_EQ(DetectHazardFormat("name: paper\n"), std::nullopt);
  EXPECT_EQ(ToString(HazardFormat::kIbtracs), "IBTrACS");
  EXPECT_EQ(ToString(HazardFormat::kWeatherService), "weather service track");
}

TEST(Cma, HasTwoMinuteWindsAndItsGrades) {
  const HazardTrack& storm = FindTrack(Load("cma.txt"), "2106");
  EXPECT_EQ(storm.name, "In-fa");
  EXPECT_EQ(storm.agency, "CMA");
  EXPECT_EQ(storm.line, 5);
  ASSERT_EQ(storm.fixes.size(), 3U);
  const HazardFix& fix = storm.fixes[2];
  EXPECT_EQ(fix.time, kInFaNoon);
  EXPECT_DOUBLE_EQ(fix.position.latitude, 30.0);
  EXPECT_DOUBLE_EQ(fix.position.longitude, 122.2);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_EQ(fix.wind_mps, 33.0);
  EXPECT_EQ(fix.averaging_min, 2);
  EXPECT_EQ(fix.pressure_hpa, 970.0);
  EXPECT_TRUE(fix.rings.empty());
  EXPECT_EQ(fix.line, 8);
}

TEST(Cma, TellsMissingWindsFromWeakOnes) {
  const HazardFile file = Load("cma.txt");
  const std::vector<HazardFix>& fixes = FindTrack(file, "Faye(Gloria)").fixes;
  EXPECT_EQ(fixes[0].wind_mps, 12.0);
  EXPECT_EQ(fixes[1].wind_mps, std::nullopt) << "9 is below 10 m/s";
  EXPECT_EQ(fixes[1].wind_below_mps, 10.0);
  EXPECT_EQ(fixes[2].wind_mps, std::nullopt);
  EXPECT_EQ(fixes[2].wind_below_mps, std::nullopt);
  EXPECT_EQ(fixes[2].second_wind_mps, 18.0);
  EXPECT_TRUE(fixes[2].extratropical);
  EXPECT_EQ(fixes[2].grade, StormGrade::kUnknown);
}

TEST(Cma, KnowsStormsByNumberOrElseBySerial) {
  const HazardFile file = Load("cma.txt");
  ASSERT_EQ(file.tracks.size(), 3U);
  EXPECT_EQ(file.tracks[0].id, "7127,7128");
  EXPECT_EQ(file.tracks[2].id, "CMA12");
  EXPECT_EQ(file.tracks[2].name, "");
  EXPECT_NEAR(file.tracks[2].fixes[0].position.longitude, -0.1, 1e-9);
  EXPECT_DOUBLE_EQ(file.tracks[2].fixes[0].position.latitude, -5.0);
}

TEST(Cma, LeavesOutATimeThatIsThereTwiceAndSaysSo) {
  const HazardFile file = ParseHazardFile(ReadFile(kData / "cma.txt"), "year.txt");
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{
                "year.txt:9: time: 2021-07-25T06:00:00Z is there twice, the second is left out"});
}

TEST(Cma, ReadsCrLfAndAByteOrderMark) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : ReadFile(kData / "cma.txt")) {
    if (c == '\n') text += '\r';
    text += c;
  }
  EXPECT_EQ(ParseHazardFile(text, "x").tracks.size(), 3U);
}

TEST(Motion, IsComputedWhereTheSourceHasNone) {
  const HazardTrack storm = FindTrack(Load("cma.txt"), "in-FA");
  // 29.7N 123.0E to 29.9N 122.7E: 22.2 km north, 29.0 km west in 3 h.
  EXPECT_NEAR(*storm.fixes[0].heading_deg, 307.4, 0.3);
  EXPECT_NEAR(*storm.fixes[0].speed_kmh, 12.2, 0.1);
  EXPECT_TRUE(storm.fixes[0].motion_computed);
  EXPECT_EQ(storm.fixes[2].heading_deg, storm.fixes[1].heading_deg) << "the last keeps its course";
}

TEST(Jma, TurnsAnAsideCircleIntoQuadrants) {
  const HazardFile file = Load("jma.txt");
  const HazardTrack& storm = FindTrack(file, "in-fa");
  EXPECT_EQ(storm.id, "2106");
  const HazardFix& fix = storm.fixes[1];
  EXPECT_EQ(fix.time, kInFaNoon);
  EXPECT_NEAR(*fix.wind_mps, 33.44, 0.01);
  EXPECT_EQ(fix.averaging_min, 10);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_TRUE(fix.landfall);
  ExpectRadii(fix, 50, NauticalMiles({80, 80, 80, 80}));
  // 325 nm to the east, 240 nm to the west: a circle of 282.5 nm that lies 42.5 nm to the east.
  ExpectRadii(fix, 30, NauticalMiles({310.95, 310.95, 250.85, 250.85}));
  EXPECT_EQ(fix.Ring(34), nullptr);
}

TEST(Jma, TellsBlankRadiiFromNone) {
  const HazardTrack storm = FindTrack(Load("jma.txt"), "2106");
  EXPECT_TRUE(storm.fixes[0].rings.empty());
  EXPECT_EQ(storm.fixes[0].wind_mps, std::nullopt);
  EXPECT_EQ(storm.fixes[0].grade, StormGrade::kTropicalDepression);
  ExpectRadii(storm.fixes[2], 50, {0, 0, 0, 0});
  EXPECT_TRUE(storm.fixes[2].extratropical);
}

TEST(Jma, HasYearsFrom1951AndLongitudesBeyond180) {
  const HazardFix fix = FindTrack(Load("jma.txt"), "5101").fixes[0];
  EXPECT_EQ(fix.time, -595382400);  // 1951-02-19 00:00 UTC
  EXPECT_NEAR(fix.position.longitude, -179.5, 1e-9);
  EXPECT_EQ(fix.grade, StormGrade::kUnknown);
}

TEST(Atcf, MergesTheRowsOfATime) {
  const HazardTrack storm = FindTrack(Load("atcf.dat"), "NEOGURI");
  EXPECT_EQ(storm.id, "WP082014");
  ASSERT_EQ(storm.fixes.size(), 3U);
  const HazardFix& fix = storm.fixes[1];
  EXPECT_NEAR(*fix.wind_mps, 36.01, 0.01);
  EXPECT_EQ(fix.averaging_min, 1);
  EXPECT_EQ(fix.grade, StormGrade::kTyphoon);
  EXPECT_NEAR(*fix.max_wind_radius_km, 55.56, 0.01);
  ExpectRadii(fix, 34, NauticalMiles({110, 90, 0, 100}));
  // A semicircle about the north-east: half of SE and NW belong to it.
  const double half = std::sqrt((60.0 * 60.0 + 40.0 * 40.0) / 2.0);
  ExpectRadii(fix, 50, NauticalMiles({60, half, 40, half}));
  ExpectRadii(fix, 64, NauticalMiles({20, 20, 20, 20}));
  EXPECT_TRUE(storm.fixes[0].rings.empty());
  EXPECT_TRUE(storm.fixes[2].extratropical);
  EXPECT_EQ(storm.fixes[2].wind_mps, std::nullopt);
  EXPECT_TRUE(storm.fixes[0].motion_computed) << "0 and 0 in the deck";
}

TEST(Atcf, ReadsSouthAndWestAndAQuadrantAboutTheNorth) {
  const HazardFix fix = FindTrack(Load("atcf.dat"), "lusi").fixes[0];
  EXPECT_DOUBLE_EQ(fix.position.latitude, -10.0);
  EXPECT_DOUBLE_EQ(fix.position.longitude, -179.0);
  const auto mean = [](double a, double b) { return std::sqrt((a * a + b * b) / 2.0); };
  ExpectRadii(fix, 34, NauticalMiles({mean(80, 60), mean(60, 40), mean(40, 20), mean(20, 80)}));
  EXPECT_EQ(fix.heading_deg, 270.0);
  EXPECT_NEAR(*fix.speed_kmh, 18.52, 1e-9);
  EXPECT_FALSE(fix.motion_computed);
}

TEST(Ibtracs, TakesTheWindsOfTheAgencyInCharge) {
  const HazardFile file = Load("ibtracs.csv");
  const HazardFix& tokyo = FindTrack(file, "2021198N21140").fixes[0];
  EXPECT_NEAR(*tokyo.wind_mps, 33.44, 0.01);
  EXPECT_EQ(tokyo.averaging_min, 10);
  EXPECT_EQ(tokyo.pressure_hpa, 970.0);
  EXPECT_NEAR(tokyo.position.longitude, -122.2, 1e-9);
  EXPECT_TRUE(tokyo.extratropical);
  const HazardTrack& ialy = FindTrack(file, "Ialy");
  EXPECT_EQ(ialy.agency, "IBTrACS PROVISIONAL");
  EXPECT_NEAR(*ialy.fixes[0].wind_mps, 18.01, 0.01);
  EXPECT_EQ(ialy.fixes[0].averaging_min, 1) << "WMO_WIND is blank";
  EXPECT_FALSE(ialy.fixes[0].interpolated);
  EXPECT_TRUE(ialy.fixes[1].interpolated);
  EXPECT_EQ(ialy.fixes[1].heading_deg, 0.0) << "360";
  EXPECT_TRUE(ialy.fixes[0].rings.empty());
  ExpectRadii(ialy.fixes[1], 34, NauticalMiles({60, 0, 50, 0}));
}

TEST(Bulletin, IsReadFromTheScriptOfZhejiangsWaterOffice) {
  const HazardFile file = Load("zhejiang.js");
  EXPECT_EQ(file.format, HazardFormat::kBulletin);
  EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
  const HazardTrack& storm = file.tracks.at(0);
  EXPECT_EQ(storm.id, "202106");
  EXPECT_EQ(storm.name, "In-Fa");
  EXPECT_TRUE(storm.landfalls.empty()) << "its list names more than landfalls";
  ASSERT_EQ(storm.fixes.size(), 2U);
  const HazardFix& fix = storm.fixes[0];
  EXPECT_EQ(fix.time, 1627171200) << "08:00 in Beijing";
  EXPECT_EQ(fix.grade, StormGrade::kSevereTyphoon);
  EXPECT_EQ(fix.wind_mps, 42.0);
  EXPECT_EQ(fix.speed_kmh, 12.0);
  EXPECT_EQ(fix.heading_deg, 315.0);
  ExpectRadii(fix, 34, {300, 200, 190, 250});
  ExpectRadii(fix, 50, {100, 100, 80, 90});
  ExpectRadii(storm.fixes[1], 34, {280, 280, 280, 280});
  ASSERT_EQ(storm.forecasts.size(), 2U);
  EXPECT_EQ(storm.forecasts[0].agency, "中国");
  EXPECT_EQ(storm.forecasts[0].fixes.size(), 2U);
  EXPECT_EQ(storm.forecasts[1].agency, "日本");
  EXPECT_EQ(storm.forecasts[1].fixes[0].position.latitude, 30.4);
}

TEST(Bulletin, OfZhejiangIsRefusedWithItsLine) {
  const auto refused = [](const std::string& from, const std::string& to) -> std::string {
    std::string text = ReadFile(kData / "zhejiang.js");
    text.replace(text.find(from), from.size(), to);
    try {
      ParseHazardFile(text, "x");
    } catch (const InputError& error) {
      return error.what();
    }
    return "was read";
  };
  EXPECT_EQ(refused("300|200|190|250", "300|200|190"),
            "x:9: [0].points[0].radius7: got '300|200|190', expected four numbers in [0, 3000] as "
            "250|220|200|180");
  EXPECT_EQ(refused("300|200|190|250", "300|-2|190|250|"),
            "x:9: [0].points[0].radius7: got '300|-2|190|250|', expected four numbers in [0, 3000] "
            "as 250|220|200|180");
  EXPECT_EQ(refused("\"30.4\"", "\"95\""),
            "x:16: [0].points[0].forecast[1].forecastpoints[0].lat: got '95', expected a number in "
            "[-90, 90]");
  EXPECT_EQ(refused("radius7\": \"300|200|190|250\"", "r7\": \"300|200|190\""),
            "x:9: [0].points[0].r7: got '300|200|190', expected four numbers in [0, 3000] as "
            "250|220|200|180");
  EXPECT_EQ(refused("radius12\": \"\"", "r12Quad\": {\"ne\": -1}"),
            "x:9: [0].points[0].r12Quad.ne: got -1, expected a number in [0, 3000]");
  EXPECT_EQ(refused("\"29.7\"", "\"95\""),
            "x:7: [0].points[0].lat: got '95', expected a number in [-90, 90]");
  EXPECT_NE(refused("];", "").find(": got no valid JSON: "), std::string::npos);
  EXPECT_EQ(refused("let typhoons =", "typhoons").substr(0, 26), "x:3: got no valid JSON: la");
}

TEST(Bulletin, ReadsBeijingTimeAndQuadrants) {
  const HazardFile file = Load("bulletin.json");
  ASSERT_EQ(file.tracks.size(), 2U);
  const HazardTrack& storm = FindTrack(file, "烟花");
  EXPECT_EQ(storm.name, "In-Fa");
  const HazardFix& fix = storm.fixes[0];
  EXPECT_EQ(fix.time, kInFaNoon - 6 * 3600);
  EXPECT_EQ(fix.grade, StormGrade::kSevereTyphoon);
  EXPECT_EQ(fix.wind_mps, 42.0);
  EXPECT_EQ(fix.heading_deg, 292.5);
  EXPECT_EQ(fix.speed_kmh, 12.0);
  EXPECT_FALSE(fix.motion_computed);
  ExpectRadii(fix, 34, {300, 200, 200, 250});
  EXPECT_EQ(fix.Ring(50), nullptr) << "0 at 42 m/s: it was not said";
  EXPECT_EQ(fix.Ring(64), nullptr);
}

TEST(Bulletin, KnowsBothSpellingsAndWhatIsUnknown) {
  const HazardFile file = ParseHazardFile(ReadFile(kData / "bulletin.json"), "b.json");
  const HazardTrack& storm = FindTrack(file, "202106");
  const HazardFix& bare = storm.fixes[1];
  EXPECT_EQ(bare.wind_mps, std::nullopt);
  EXPECT_EQ(bare.pressure_hpa, std::nullopt);
  EXPECT_EQ(bare.grade, StormGrade::kUnknown);
  ExpectRadii(bare, 34, {200, 200, 200, 200});
  EXPECT_EQ(file.warnings, std::vector<std::string>{"b.json:17: [0].points[1].moveDir: '中' is no "
                                                    "direction known here"});
  const HazardFix& weak = storm.fixes[2];
  EXPECT_EQ(weak.grade, StormGrade::kTropicalStorm) << "by its wind";
  EXPECT_EQ(weak.Ring(34), nullptr) << "18 m/s blow somewhere";
  ExpectRadii(weak, 50, {0, 0, 0, 0});
  EXPECT_EQ(file.tracks[1].name, "");
  EXPECT_EQ(file.tracks[1].local_name, "");
}

TEST(Bulletin, KeepsForecastsAndLandfallsInOrder) {
  const HazardTrack storm = FindTrack(Load("bulletin.json"), "In-Fa");
  ASSERT_EQ(storm.forecasts.size(), 1U);
  EXPECT_EQ(storm.forecasts[0].agency, "中国");
  EXPECT_EQ(storm.forecasts[0].issued, storm.fixes[0].time);
  ASSERT_EQ(storm.forecasts[0].fixes.size(), 2U);
  EXPECT_EQ(storm.forecasts[0].fixes[1].grade, StormGrade::kTropicalStorm);
  ASSERT_EQ(storm.landfalls.size(), 2U);
  EXPECT_EQ(storm.landfalls[0].place, "舟山.普陀");
  EXPECT_EQ(storm.landfalls[1].time - storm.landfalls[0].time, (21 * 60 + 20) * 60);
}

TEST(WeatherService, ReadsTextForNumbersInsideAMarkdownFence) {
  const HazardFile file = Load("weather_service.json");
  EXPECT_TRUE(file.warnings.empty());
  const HazardTrack& storm = file.tracks.at(0);
  ASSERT_EQ(storm.fixes.size(), 3U);
  EXPECT_EQ(storm.fixes[0].grade, StormGrade::kSuperTyphoon);
  EXPECT_EQ(storm.fixes[0].pressure_hpa, std::nullopt);
  EXPECT_EQ(storm.fixes[0].heading_deg, 315.0);
  EXPECT_FALSE(storm.fixes[0].speed_kmh == std::nullopt) << "computed";
  ExpectRadii(storm.fixes[0], 64, {40, 0, 0, 0});
  EXPECT_EQ(storm.fixes[2].time, kInFaNoon);
  ExpectRadii(storm.fixes[2], 34, {300, 200, 200, 250});
  EXPECT_EQ(storm.fixes[2].Ring(50), nullptr);
  ExpectRadii(storm.fixes[1], 64, {0, 0, 0, 0});
  ASSERT_EQ(storm.landfalls.size(), 1U);
  EXPECT_DOUBLE_EQ(storm.landfalls[0].position.longitude, 122.4);
}

TEST(Grades, AreThoseOfTheStandard) {
  EXPECT_EQ(GradeOfWind(10.7), StormGrade::kUnknown);
  EXPECT_EQ(GradeOfWind(10.8), StormGrade::kTropicalDepression);
  EXPECT_EQ(GradeOfWind(17.2), StormGrade::kTropicalStorm);
  EXPECT_EQ(GradeOfWind(24.5), StormGrade::kSevereTropicalStorm);
  EXPECT_EQ(GradeOfWind(32.7), StormGrade::kTyphoon);
  EXPECT_EQ(GradeOfWind(41.5), StormGrade::kSevereTyphoon);
  EXPECT_EQ(GradeOfWind(51.0), StormGrade::kSuperTyphoon);
  EXPECT_EQ(ToString(StormGrade::kSuperTyphoon), "SuperTY");
  EXPECT_EQ(DisasterGrade(StormGrade::kTropicalStorm), 1);
  EXPECT_EQ(DisasterGrade(StormGrade::kSevereTyphoon), 4);
}

TEST(EstimatedRings, FallOffAsHollandsWindAndAreMarked) {
  HazardFix fix;
  fix.position = {30.0, 122.2};
  EXPECT_FALSE(EstimateRing(fix, 34)) << "no wind";
  fix.wind_mps = 38.0;
  fix.pressure_hpa = 965.0;
  for (const std::int32_t wind_kt : {64, 34, 50}) EXPECT_TRUE(EstimateRing(fix, wind_kt));
  ASSERT_EQ(fix.rings.size(), 3U);
  // Rmax = 46.4 exp(-0.589 + 0.507) = 42.7 km; B = 1.00; f = 7.292e-5 /s. At 214 km:
  // a = 0.2, Vc^2 = 1562, sqrt(1562 · 0.2 · e^0.8 + 61) - 7.8 = 19.7 m/s, so that 17.5 is beyond.
  EXPECT_EQ(fix.rings[0].wind_kt, 34) << "the weakest first";
  const double gale = fix.rings[0].radius_km[0];
  EXPECT_GT(gale, 214.0);
  EXPECT_LT(gale, 260.0);
  EXPECT_GT(fix.rings[2].radius_km[0], 42.7);
  EXPECT_GT(fix.rings[1].radius_km[0], fix.rings[2].radius_km[0]);
  EXPECT_TRUE(fix.rings[0].estimated);
  EXPECT_FALSE(EstimateRing(fix, 34)) << "there is one";
}

TEST(EstimatedRings, AreNoneAboveTheStormsOwnWind) {
  HazardFix fix;
  fix.position = {30.0, 122.2};
  fix.wind_mps = 20.0;
  ASSERT_TRUE(EstimateRing(fix, 34));
  ASSERT_TRUE(EstimateRing(fix, 50));
  EXPECT_GT(fix.Ring(34)->radius_km[0], 0.0);
  EXPECT_EQ(fix.Ring(50)->radius_km[0], 0.0);
}

TEST(FindTrack, NamesWhatThereIs) {
  const HazardFile file = Load("cma.txt");
  try {
    FindTrack(file, "Rai");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "storm: got 'Rai', expected one of: 7127,7128 Faye(Gloria), 2106 In-fa, CMA12");
  }
}

TEST(FindTrack, TakesIdsBeforeNamesAndNoEmptyWord) {
  HazardFile file;
  file.tracks.resize(3);
  file.tracks[0].id = "1";
  file.tracks[1].id = "2";
  file.tracks[1].name = "One";
  file.tracks[2].id = "One";
  for (HazardTrack& track : file.tracks) track.fixes.emplace_back();
  EXPECT_EQ(FindTrack(file, "one").id, "One") << "not the storm of that name";
  file.tracks.pop_back();
  EXPECT_EQ(FindTrack(file, "one").id, "2");
  try {
    FindTrack(file, "");
    FAIL() << "took the storm without a name";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "storm: got '', expected one of: 1, 2 One");
  }
}

TEST(Motion, OfZeroWasNotSaid) {
  const auto speeds = [](const std::string& text) {
    return ParseHazardFile(text, "x").tracks[0].fixes;
  };
  const auto bulletin = speeds(R"([{"tfbh": "1", "points": [
    {"time": "2021-07-25T08:00:00", "lat": 30, "lng": 122, "move_speed": 0},
    {"time": "2021-07-25T14:00:00", "lat": 31, "lng": 122, "move_speed": 0},
    {"time": "2021-07-25T20:00:00", "lat": 31, "lng": 122, "move_speed": 0}]}])");
  EXPECT_NEAR(bulletin[0].speed_kmh.value_or(-1.0), 110.9 / 6.0, 0.1);
  EXPECT_EQ(bulletin[1].speed_kmh.value_or(-1.0), 0.0) << "the next is at the same place";
  const auto service = speeds(R"({"code": "200", "track": [
    {"time": "2021-07-25T08:00+08:00", "lat": "30", "lon": "122", "moveSpeed": "0",
     "move360": "360", "windRadius30": null},
    {"time": "2021-07-25T14:00+08:00", "lat": "31", "lon": "122", "moveSpeed": "9"}]})");
  EXPECT_NEAR(service[0].speed_kmh.value_or(-1.0), 110.9 / 6.0, 0.1);
  EXPECT_EQ(service[0].heading_deg.value_or(-1.0), 0.0);
}

struct Refusal {
  const char* name;
  const char* text;
  const char* words;
};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

#define CMA_HEAD "66666 2106   02 0011 2106 0 3 In-fa   20220410\n"
#define CMA_POINT "2021072500 4 297 1230  968      35\n"
#define JMA_HEAD "66666 2106  001 0011 2106 0 6                IN-FA              20220101\n"
#define ATCF_ROW "WP, 08, 2014070312,   , BEST,   0, 109N, 1440E,  30, 1000, TD\n"

const std::vector<Refusal> kRefusals{
    {"Empty", "", "x:1: got an empty file, expected tracks of storms"},
    {"EmptyList", " [] \n", "x:1: got an empty list, expected a list of storms"},
    {"OtherFormat", "P5\n10 10\n", "x:1: got 'P5', expected a CMA or JMA best track, an ATCF"},
    {"HeaderAlone", "66666\n2021\x01", "x:1: got '66666', expected a CMA or JMA best track"},
    {"CmaTruncated", CMA_HEAD CMA_POINT,
     "x:2: got 1 points, expected the 2 points of the header on line 1"},
    {"CmaCountTooHigh", CMA_HEAD CMA_POINT "66666 2107   01 0012 2107 0 3 X   20220410\n",
     "x:3: got 1 points, expected the 2 points of the header on line 1"},
    {"CmaCountTooLow", CMA_HEAD CMA_POINT "2021072506 4 300 1222  970 33\n" CMA_POINT,
     "x:4: got '2021072500', expected a header, 66666 …"},
    {"CmaHeaderCut", "66666 2106 2\n" CMA_POINT, "x:1: got 3 words, expected a header"},
    {"CmaPointCut", CMA_HEAD "2021072500 4 297 1230\n",
     "x:2: got 4 words, expected a point: time, grade, latitude"},
    {"CmaDay", CMA_HEAD "2021023000 4 297 1230  968 35\n",
     "x:2: time: got '2021023000', expected an hour of UTC as YYYYMMDDHH"},
    {"CmaLatitude", CMA_HEAD "2021072500 4 950 1230  968 35\n",
     "x:2: latitude in tenths of a degree: got '950', expected a whole number in [-900, 900]"},
    {"CmaLongitude", CMA_HEAD "2021072500 4 297 4000  968 35\n",
     "longitude in tenths of a degree: got '4000', expected a whole number in [-1800, 3600]"},
    {"CmaGrade", CMA_HEAD "2021072500 7 297 1230  968 35\n",
     "x:2: grade: got 7, expected one of 0 to 6 or 9"},
    {"CmaWord", CMA_HEAD "2021072500 4 297 1230  abc 35\n",
     "x:2: pressure: got 'abc', expected a whole number in [0, 1100]"},
    {"CmaBackwards", CMA_HEAD CMA_POINT "2021072418 4 300 1222  970 33\n",
     "x:3: time: got 2021-07-24T18:00:00Z, expected one after 2021-07-25T00:00:00Z of the point"},
    {"JmaTruncated", "66666 2106  002 0011 2106 0 6\n21072500 002 2 297 1230  998     000\n",
     "x:2: got 1 points, expected the 2 points of the header on line 1"},
    {"JmaCut", JMA_HEAD "21072500 002 2 297\n", "x:2: got a line of 18 columns, expected 36"},
    {"JmaHour", JMA_HEAD "21072524 002 2 297 1230  998     000\n",
     "x:2: time: got '2021072524', expected an hour of UTC"},
    {"JmaGrade", JMA_HEAD "21072500 002 8 297 1230  998     000\n",
     "x:2: grade: got 8, expected one of 2 to 7 or 9"},
    {"JmaRadii", JMA_HEAD "21072500 002 5 297 1230  970     065     90080 0090\n",
     "x:2: shortest radius: got one longer than the longest, of 50 kt"},
    {"AtcfFew", ATCF_ROW "WP, 08, 2014070318,   , BEST\n",
     "x:2: got 5 fields, expected at least 11 of an ATCF row"},
    {"AtcfForecast", "WP, 08, 2014070312, 03, JTWC,   0, 109N, 1440E,  30, 1000, TD\n",
     "x:1: technique: got 'JTWC', expected BEST: a b-deck"},
    {"AtcfLatitude", "WP, 08, 2014070312,   , BEST,   0, 950N, 1440E,  30, 1000, TD\n",
     "x:1: latitude: got '950', expected a whole number in [0, 900]"},
    {"AtcfSide", "WP, 08, 2014070312,   , BEST,   0, 109, 1440E,  30, 1000, TD\n",
     "x:1: latitude: got '109', expected tenths of a degree and N or S"},
    {"AtcfCode",
     "WP, 08, 2014070312,   , BEST,   0, 109N, 1440E,  35, 1000, TS,  34, XYQ, 10, 10, 10, 10\n",
     "x:1: radius code: got 'XYQ', expected AAA, a quadrant as NEQ or a semicircle as NES"},
    {"AtcfBackwards", ATCF_ROW "WP, 08, 2014070306,   , BEST,   0, 102N, 1451E,  30, 1000, TD\n",
     "x:2: time: got 2014-07-03T06:00:00Z, expected one after 2014-07-03T12:00:00Z"},
    {"IbtracsColumn", "SID,NAME,LAT\n", "x:1: got no column ISO_TIME, expected those of IBTrACS"},
    {"BulletinPoints", R"([{"tfbh": "1", "points": []}])",
     "x:1: [0].points: got none, expected at least one"},
    {"BulletinSpan", R"([{"tfbh": "1", "points": [
      {"time": "2019-07-25T14:00:00", "lat": 30, "lng": 1},
      {"time": "2021-07-25T14:00:00", "lat": 30, "lng": 1}]}])",
     "[0].points: got 731 days of one storm, expected at most 366"},
    {"BulletinLatitude",
     "[{\"tfbh\": \"1\", \"points\": [\n{\"time\": \"2021-07-25T14:00:00\",\n\"lat\": 95, "
     "\"lng\": 1}]}]",
     "x:3: [0].points[0].lat: got 95, expected a number in [-90, 90]"},
    {"BulletinNull",
     "[{\"tfbh\": \"1\", \"points\": [\n{\"time\": \"2021-07-25T14:00:00\", \"lat\": \"null\", "
     "\"lng\": 1}]}]",
     "x:2: [0].points[0].lat: got nothing, expected a number in [-90, 90]"},
    {"BulletinTime", R"([{"tfbh": "1", "points": [{"time": "2021-02-30T00:00:00"}]}])",
     "x:1: [0].points[0].time: got '2021-02-30T00:00:00', expected a time as"},
    {"BulletinShape", "[{\"tfbh\": \"1\",\n\"points\": [7]}]",
     "x:2: [0].points[0]: got 7, expected an object"},
    {"BulletinList", R"([{"tfbh": "1", "points": "none"}])",
     "x:1: [0].points: got 'none', expected a list"},
    {"JsonCut", "[{\"tfbh\": \"1\",\n\"points\": [{\"time\"", "x:2: got no valid JSON: "},
    {"JsonNumber", "[{\"tfbh\": \"1\",\n\"points\": 1e999}]",
     "x:2: got '1e999', expected a number that a double can hold"},
    {"ServiceCode", R"({"code": "404", "track": []})", "x:1: code: got '404', expected '200'"},
    {"ServiceEmpty", R"({"code": "200", "track": []})",
     "x:1: points: got none, expected at least one"},
};

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, SayWhereAndWhatWasExpected) {
  try {
    ParseHazardFile(GetParam().text, "x");
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().words), std::string::npos)
        << error.what() << "\nexpected: " << GetParam().words;
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
  }
}

INSTANTIATE_TEST_SUITE_P(All, Refusals, testing::ValuesIn(kRefusals),
                         [](const auto& test) { return test.param.name; });

TEST(Refusals, NameTheUnitsAndRowsOfIbtracs) {
  const auto refused = [](std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    try {
      ParseHazardFile(text, "x");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("was read");
  };
  const std::string text = ReadFile(kData / "ibtracs.csv");
  EXPECT_EQ(refused(text, "kts", "m/s"), "x:2: WMO_WIND: got unit 'm/s', expected 'kts'");
  EXPECT_EQ(refused(text, "-9.30000", "-93"),
            "x:4: LAT: got '-93', expected a number in [-90, 90]");
  EXPECT_EQ(refused(text, "2024-05-16 15:00:00", "2024-05-16 25:00:00"),
            "x:4: ISO_TIME: got '2024-05-16 25:00:00', expected UTC as YYYY-MM-DD HH:MM:SS");
  EXPECT_EQ(refused(text, "IALY,", ""), "x:3: got 28 fields, expected the 29 of row 1");
}

TEST(Refusals, BoundTheDepthOfJson) {
  const auto nested = [](std::size_t depth) -> std::string {
    const std::string text = "[{\"tfbh\": \"]\\\"\",\n\"points\": " + std::string(depth, '[') +
                             std::string(depth, ']') + "}]";
    try {
      ParseHazardFile(text, "x");
    } catch (const InputError& error) {
      return error.what();
    }
    return "was read";
  };
  EXPECT_EQ(nested(100'000),
            "x:2: got JSON nested more deeply than 64 levels, expected a bulletin or a chart");
  EXPECT_EQ(nested(62), "x:2: [0].points[0]: got a list, expected an object");
}

TEST(LoadHazardFile, NamesAFileThatIsNot) {
  try {
    LoadHazardFile("/nowhere/track.txt");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nowhere/track.txt: cannot read: No such file or directory");
  }
  EXPECT_THROW(LoadHazardFile("/tmp"), InputError);
}

// Every cut of every sample is read, or refused with a line; nothing else happens.
TEST(HazardFile, EveryCutOfASampleIsReadOrRefused) {
  for (const char* name : {"cma.txt", "jma.txt", "atcf.dat", "ibtracs.csv", "bulletin.json",
                           "zhejiang.js", "weather_service.json"}) {
    const std::string text = ReadFile(kData / name);
    for (std::size_t size = 0; size < text.size(); ++size) {
      try {
        EXPECT_FALSE(ParseHazardFile(text.substr(0, size), "x").tracks.empty());
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 2), "x:");
      }
    }
  }
}

}  // namespace
}  // namespace aquafarm
