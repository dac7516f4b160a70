// SPDX-License-Identifier: BSD-3-Clause
// A wrong value does not lose a storm: the value or its point is left out with one warning.
#include <gtest/gtest.h>

#include <algorithm>

#include "storm_samples.h"

namespace aquafarm {
namespace {

struct Typo {
  const char* name;
  const char* point;  // the second of three points
  const char* warning;
};
void PrintTo(const Typo& typo, std::ostream* out) { *out << typo.name; }

std::string PointAt(const std::string& day_hour, const std::string& rest) {
  return "{\"time\": \"2021-07-" + day_hour + ":00:00\", " + rest + "}";
}
const std::string kGood = R"("lat": 30, "lng": 122, "speed": 35, "pressure": 965, "radius7": 200)";

std::string Bulletin(const std::string& second, const std::string& more = "") {
  return "[{\"tfbh\": \"202106\", \"ename\": \"In-Fa\"" + more + ", \"points\": [\n" +
         PointAt("25T08", kGood) + ",\n" + second + ",\n" + PointAt("25T20", kGood) + "]}]";
}

const std::vector<Typo> kFields{
    {"Pressure", R"("lat": 30, "lng": 122, "pressure": 50)",
     "pressure: got 50 hPa, expected [800, 1100], or 0 where it is not known; the value is "
     "ignored"},
    {"PressureOfWords", R"("lat": 30, "lng": 122, "pressure": "9b5")",
     "pressure: got '9b5', expected a number in [0, 1100]; the value is ignored"},
    {"Radius", R"("lat": 30, "lng": 122, "radius7": 3380)",
     "radius7: got 3380, expected a number in [0, 3000]; the value is ignored"},
    {"RadiusAsAList", R"("lat": 30, "lng": 122, "radius7": [1])",
     "radius7: got a list, expected a number in [0, 3000]; the value is ignored"},
    {"Quadrants", R"("lat": 30, "lng": 122, "radius7_quad": [1])",
     "radius7_quad: got no object, expected radii such as {\"ne\": 250, …}; the value is ignored"},
    {"Wind", R"("lat": 30, "lng": 122, "speed": 380)",
     "speed: got 380, expected a number in [0, 150]; the value is ignored"},
    {"TwoSigns", R"("lat": 30, "lng": 122, "move_speed": "+-5")",
     "move_speed: got '+-5', expected a number in [0, 300]; the value is ignored"},
    {"Infinity", R"("lat": 30, "lng": 122, "speed": "inf")",
     "speed: got 'inf', expected a number in [0, 150]; the value is ignored"},
    {"Direction", R"("lat": 30, "lng": 122, "move_dir": ["W"])",
     "move_dir: got a list, expected a text; the value is ignored"},
    {"Speed", R"("lat": 30, "lng": 122, "move_speed": -1)",
     "move_speed: got -1, expected a number in [0, 300]; the value is ignored"},
    {"Grade", R"("lat": 30, "lng": 122, "strong": {})",
     "strong: got an object, expected a text; the value is ignored"},
    {"Forecast", R"("lat": 30, "lng": 122, "forecast": "none")",
     "forecast: got 'none', expected a list; the value is ignored"},
};

class Typos : public testing::TestWithParam<Typo> {};

TEST_P(Typos, InAFieldLeaveThePointAndTheStorm) {
  const std::string text = Bulletin(PointAt("25T14", GetParam().point));
  const StormFile file = ParseStormFile(text, "x");
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{std::string("x:3: [0].points[1].") + GetParam().warning});
  EXPECT_EQ(file.tracks.at(0).fixes.size(), 3U);
}

INSTANTIATE_TEST_SUITE_P(All, Typos, testing::ValuesIn(kFields),
                         [](const auto& test) { return test.param.name; });

TEST(Typos, OfARadiusLeaveTheRingUnknownAndNotZero) {
  const StormFix fix =
      ParseStormFile(Bulletin(PointAt("25T14", R"("lat": 30, "lng": 122, "speed": 35,
      "radius7": 3380)")),
                     "x")
          .tracks.at(0)
          .fixes[1];
  EXPECT_EQ(fix.Ring(34), nullptr);
  EXPECT_EQ(fix.wind_mps, 35.0);
}

TEST(Typos, OfATimeOrAPositionLeaveOutThePoint) {
  for (const auto& [point, words] : std::vector<std::pair<std::string, std::string>>{
           {PointAt("25T14", R"("lat": 300, "lng": 122)"),
            "lat: got 300, expected a number in [-90, 90]"},
           {PointAt("25T14", R"("lng": 122)"), "lat: got nothing, expected a number in [-90, 90]"},
           {PointAt("25T14", R"("lat": 30, "lng": "12z")"),
            "lng: got '12z', expected a number in [-180, 360]"},
           {PointAt("32T14", R"("lat": 30, "lng": 122)"),
            "time: got '2021-07-32T14:00:00', expected a time such as 2021-07-25T14:00:00"}}) {
    const StormFile file = ParseStormFile(Bulletin(point), "x");
    EXPECT_EQ(file.warnings,
              std::vector<std::string>{"x:3: [0].points[1]." + words + "; the point is left out"});
    EXPECT_EQ(file.tracks.at(0).fixes.size(), 2U);
  }
}

TEST(Typos, InMostPointsRefuseTheStorm) {
  const std::string bad = PointAt("25T14", R"("lat": 300, "lng": 122)");
  EXPECT_EQ(Refusal(Bulletin(bad + ",\n" + bad + ",\n" + bad)),
            "x:3: [0].points[1].lat: got 300, expected a number in [-90, 90]");
}

TEST(Typos, InATimeDoNotLoseThePointsBehindIt) {
  const auto at = [](const std::string& time) {
    return "{\"time\": \"" + time + ":00:00\", " + kGood + "}";
  };
  const auto kept = [&](const std::vector<std::string>& times, const std::string& warning) {
    std::string points;
    for (const std::string& time : times) points += (points.empty() ? "" : ",\n") + at(time);
    const StormFile file =
        ParseStormFile("[{\"tfbh\": \"1\",\n\"points\": [\n" + points + "]}]", "x");
    EXPECT_EQ(file.warnings, std::vector<std::string>{warning});
    return file.tracks.at(0).fixes;
  };
  const std::string left_out = "; the point is left out";
  EXPECT_EQ(kept({"2021-07-25T08", "2022-07-25T14", "2021-07-25T20", "2021-07-26T02"},
                 "x:1: [0].time: got 2022-07-25T06:00:00Z, expected a time in the order of the "
                 "other points" +
                     left_out)
                .size(),
            3U);
  EXPECT_EQ(kept({"2021-07-25T08", "2021-07-25T14", "2020-07-25T20", "2021-07-26T02"},
                 "x:1: [0].time: got 2020-07-25T12:00:00Z, expected a time in the order of the "
                 "other points" +
                     left_out)
                .size(),
            3U);
  const auto last = kept({"2021-07-25T08", "2021-07-25T14", "2021-07-25T20", "2031-07-26T02"},
                         "x:1: [0].time: got 2031-07-25T18:00:00Z, expected at most 30 days from "
                         "the other points" +
                             left_out);
  ASSERT_EQ(last.size(), 3U);
  EXPECT_EQ(last.back().time, kInFaNoon + 6 * 3600);
}

TEST(Typos, OfAKindHaveOneWarningAFile) {
  const std::string bad = R"(, "lat": 30, "lng": 122, "pressure": 100, "move_dir": "up"})";
  std::string points;
  for (int hour = 10; hour < 19; ++hour) {
    points += (points.empty() ? "" : ",\n") + std::string("{\"time\": \"2021-07-25T") +
              std::to_string(hour) + ":00:00\"" + bad;
  }
  EXPECT_EQ(Warnings(Bulletin(points)),
            "x:3: [0].points[1].pressure: got 100 hPa, expected [800, 1100], or 0 where it is not "
            "known; the value is ignored (and 8 more of this kind in the file)\n"
            "x:3: [0].points[1].move_dir: 'up' is not a known direction (and 8 more of this kind "
            "in the file)\n");
}

TEST(Typos, InALandfallOrANameLeaveTheStorm) {
  const std::string point = PointAt("25T14", kGood);
  const std::string swapped = R"(, "land": [{"land_time": "2021-07-25T12:30:00", "lat": 122.4,
    "lng": 30.0}, {"land_time": "2021-07-26T12:30:00", "lat": 30.4, "lng": 122.0}])";
  const StormFile file = ParseStormFile(Bulletin(point, swapped), "x");
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{"x:1: [0].land[0].lat: got 122.4, expected a number in [-90, "
                                     "90]; the landfall is left out"});
  EXPECT_EQ(file.tracks.at(0).landfalls.size(), 1U);
  EXPECT_EQ(Warnings(Bulletin(point, R"(, "name": ["In-Fa"])")),
            "x:1: [0].name: got a list, expected a text; the value is ignored\n");
}

TEST(Bulletin, ReadsLandfallsThatNameTheirTimeAsPointsDo) {
  const std::string land = R"(, "land": [{"time": "2021-07-25T12:30:00", "lat": 30.0, "lng": 122.4,
    "position": "Putuo"}, {"lat": 30.0, "lng": 122.4}, {"lat": 30.0, "lng": 122.4}])";
  const StormFile file = ParseStormFile(Bulletin(PointAt("25T14", kGood), land), "x");
  ASSERT_EQ(file.tracks.at(0).landfalls.size(), 1U);
  EXPECT_EQ(file.tracks[0].landfalls[0].time, kInFaNoon - 90 * 60);
  EXPECT_EQ(file.tracks[0].landfalls[0].place, "Putuo");
  EXPECT_EQ(
      file.warnings,
      std::vector<std::string>{
          "x:2: [0].land[1].land_time: got nothing, expected a time such as 2021-07-25T14:00:00; "
          "the landfall is left out (and 1 more of this kind in the file)"});
}

TEST(Cma, OneWrongValueLeavesTheStorm) {
  const std::string text = Sample("cma.txt");
  const auto warned = [&](const std::string& from, const std::string& to) {
    const std::string all = Warnings(With(text, from, to));
    return all.substr(0, all.find('\n'));
  };
  const std::string ignored = "; the value is ignored";
  const std::string in_fa = "2021072503 4 299 1227  968      35";
  EXPECT_EQ(
      warned(in_fa, "2021072503 4 299 1227   97      35"),
      "x:7: pressure: got 97 hPa, expected [800, 1100], or 0 where it is not known" + ignored);
  EXPECT_EQ(warned(in_fa, "2021072503 4 299 1227  abc      35"),
            "x:7: pressure: got 'abc', expected a whole number in [0, 1100]" + ignored);
  EXPECT_EQ(warned(in_fa, "2021072503 7 299 1227  968      35"),
            "x:7: grade: got 7, expected one of 0 to 6 or 9" + ignored);
  EXPECT_EQ(warned(in_fa, "2021072503 4 299 1227  968     350"),
            "x:7: wind: got '350', expected a whole number in [0, 150]" + ignored);
  EXPECT_EQ(warned(in_fa, "2021072503 4 999 1227  968      35"),
            "x:7: latitude in tenths of a degree: got '999', expected a whole number in [-900, "
            "900]; the point is left out");
  const std::string nameless = With(text, "In-fa ", "      ");
  EXPECT_EQ(Warnings(nameless).substr(0, 89),
            "x:5: name: got nothing, expected a name or (nameless); the storm is 2106 and has no "
            "name\n");
  EXPECT_EQ(ParseStormFile(nameless, "x").tracks.size(), 3U);
  EXPECT_EQ(ParseStormFile(nameless, "x").tracks[1].fixes.size(), 3U);
}

TEST(Cma, WarningsOfAStormLeaveTheLinesOfTheNext) {
  std::string text = With(Sample("cma.txt"), "2021072503 4 299 1227", "2021072503 4 299 1627");
  text = With(text, "2021080100 0 -50 3599 1004", "2021080100 0 -50 3599   4");
  EXPECT_EQ(Warnings(text).substr(0, 57),
            "x:9: time: 2021-07-25T06:00:00Z occurs twice; the second ");
  EXPECT_NE(Warnings(text).find("x:7: points: got 1273 km/h from 2021-07-25T00:00:00Z to "
                                "2021-07-25T03:00:00Z"),
            std::string::npos)
      << Warnings(text);
  EXPECT_NE(Warnings(text).find("x:11: pressure: got 4 hPa"), std::string::npos) << Warnings(text);
}

TEST(Jma, OneWrongValueLeavesTheStorm) {
  const std::string text = Sample("jma.txt");
  const std::string point = "21072506 002 5 300 1225 970 ";
  EXPECT_EQ(Warnings(With(text, point, "21072506 002 8 300 1225 970 ")),
            "x:3: grade: got 8, expected one of 2 to 7 or 9; the value is ignored\n");
  EXPECT_EQ(
      Warnings(With(text, "90080 0080", "90080 0090")),
      "x:3: shortest radius: got 90, expected at most the longest radius, 80, of 50 kt; the radii "
      "are ignored\n");
  EXPECT_EQ(Warnings(With(text, point, "21072506 002 5 990 1225 970 ")),
            "x:3: latitude in tenths of a degree: got '990', expected a whole number in [-900, "
            "900]; the point is left out\n");
}

TEST(Atcf, OneWrongValueLeavesTheStorm) {
  const std::string text = Sample("atcf.dat");
  EXPECT_EQ(Warnings(With(text, "NEQ,  110,", "XYQ,  110,")),
            "x:2: radius code: got 'XYQ', expected AAA, a quadrant such as NEQ or a semicircle "
            "such as NES; "
            "the radii are ignored\n");
  EXPECT_EQ(
      Warnings(With(text, "NEQ,  110,", "NEQ, 9110,")),
      "x:2: radius: got '9110', expected a whole number in [0, 1500]; the value is ignored\n");
}

TEST(Jumps, ThatNoStormMakesAreNamedWithTheirTimes) {
  const auto said = [](double longitude, const char* hour) {
    return Warnings(Bulletin(PointAt(hour, "\"lat\": 30, \"lng\": " + std::to_string(longitude))));
  };
  EXPECT_EQ(said(124.0, "25T14"), "") << "32 km/h";
  EXPECT_EQ(said(131.0, "25T14"), "") << "144 km/h";
  EXPECT_EQ(said(135.0, "25T14"),
            "x:1: [0].points: got 209 km/h from 2021-07-25T00:00:00Z to 2021-07-25T06:00:00Z, "
            "expected at most 150; check the positions of both times (and 1 more of this kind in "
            "the file)\n");
  EXPECT_EQ(said(122.1, "25T19"), "") << "a rounded position does not count as a jump";
}

}  // namespace
}  // namespace aquafarm
