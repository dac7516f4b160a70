// SPDX-License-Identifier: BSD-3-Clause
// The storm of a ranch: its track, its radii and the forecasts of its bulletins.
#include "ranch/ranch_storm.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/tracks/reader.h"
#include "ranch_request.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

TEST(Ranch, GivesItsAgentsTheForecastsOfTheBulletins) {
  RanchRequest request = Request();
  request.forecasts = (kData / "bulletin.json").string();
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(Says(ranch.decided, "forecasts: 1 from bulletin.json, the first of 2021-07-25T00"));
  const DisasterSpec& storm = ranch.scenario.disasters[0];
  ASSERT_EQ(storm.forecasts.size(), 1U);
  ASSERT_EQ(storm.forecasts[0].points.size(), 2U);
  const auto step = [&](std::int64_t time) {
    return static_cast<double>(time - *ranch.scenario.start_time) / ranch.scenario.step_duration_s;
  };
  EXPECT_NEAR(storm.forecasts[0].step, step(kMidnight), 1e-2) << "08:00 in Beijing";
  EXPECT_NEAR(storm.forecasts[0].points[0].step, step(kMidnight + 12 * kHour_s), 1e-2);
  const GeoFrame frame(*ranch.scenario.origin, ranch.scenario.cell_size_m);
  EXPECT_NEAR(storm.forecasts[0].points[1].x, frame.ToGrid({30.6, 121.2})[0], 1e-2);
  EXPECT_NEAR(storm.forecasts[0].points[1].y, frame.ToGrid({30.6, 121.2})[1], 1e-2);
  request.forecasts = request.track;
  EXPECT_NE(Refused(request).find(
                "forecasts: got no forecast points of the storm between 2021-07-25T00:"),
            std::string::npos)
      << Refused(request);
}

TEST(Ranch, TakesTheForecastOfTheAgencyNamedFirst) {
  RanchRequest request = Request();
  request.forecasts = (kData / "zhejiang.js").string();
  const Scenario scenario = BuildRanch(request).scenario;
  const std::vector<IssuedForecast>& told = scenario.disasters[0].forecasts;
  ASSERT_EQ(told.size(), 1U);
  ASSERT_EQ(told[0].points.size(), 1U) << "the first point is that of the issue";
  const GeoFrame frame(*scenario.origin, scenario.cell_size_m);
  EXPECT_NEAR(told[0].points[0].x, frame.ToGrid({30.1, 122.0})[0], 1e-2);
  EXPECT_NEAR(told[0].points[0].y, frame.ToGrid({30.1, 122.0})[1], 1e-2);
}

// The ranch with bulletins of In-Fa. Each pair contains two hours of 25 July of `year`, UTC: the
// time of issue and the time of its only forecast point.
BuiltRanch WithBulletins(RanchRequest request, int year,
                         const std::vector<std::array<int, 2>>& bulletins) {
  const auto time = [year](int hour) {
    char text[40];
    std::snprintf(text, sizeof(text), "%d-07-%02dT%02d:00:00Z", year, 25 + (hour < 0 ? -1 : 0),
                  (hour + 24) % 24);
    return std::string(text);
  };
  const fs::path path = fs::temp_directory_path() / ("said." + std::to_string(getpid()) + ".json");
  std::string text;
  for (const auto& [issued, point] : bulletins) {
    text += (text.empty() ? "" : ",") + std::string(R"({"time": ")") + time(issued) +
            R"(", "lat": 29.7, "lng": 123.0, "speed": 35, "forecast": [{"sets": "x", "points": [)" +
            R"({"time": ")" + time(point) + R"(", "lat": 30, "lng": 122, "speed": 30}]}]})";
  }
  std::ofstream(path) << R"([{"tfbh": "1", "ename": "In-Fa", "points": [)" << text << "]}]";
  request.forecasts = path.string();
  return BuildRanch(request);
}

TEST(Ranch, TakesTheNewestForecastByItsStartAndThoseIssuedInTime) {
  RanchRequest request = Request();
  request.start = kMidnight + 2 * kHour_s;
  const BuiltRanch ranch = WithBulletins(request, 2021, {{-6, 20}, {0, 20}, {4, 22}, {6, 23}});
  ASSERT_EQ(ranch.warnings.size(), 2U);
  EXPECT_NE(ranch.warnings[0].find("occurs twice"), std::string::npos);
  EXPECT_NE(ranch.warnings[1].find("34 kt are still over the ranch"), std::string::npos);
  const std::vector<IssuedForecast>& told = ranch.scenario.disasters[0].forecasts;
  ASSERT_EQ(told.size(), 2U) << "the storm is over at 06:00";
  EXPECT_NEAR(told[0].step, -2.0 * kHour_s / ranch.scenario.step_duration_s, 1e-2);
  EXPECT_NEAR(told[1].step, 2.0 * kHour_s / ranch.scenario.step_duration_s, 1e-2);
}

TEST(Ranch, LeavesOutAForecastThatEndsBeforeItsStart) {
  RanchRequest request = Request();
  request.start = kMidnight + 2 * kHour_s;
  const BuiltRanch ranch = WithBulletins(request, 2021, {{-6, 20}, {0, 2}, {4, 22}});
  EXPECT_TRUE(Says(ranch.warnings,
                   "forecasts: the forecast of 2021-07-25T00:00:00Z ends at 2021-07-25T02:00:00Z, "
                   "not after the start, and is ignored"));
  EXPECT_EQ(ranch.scenario.disasters[0].forecasts.size(), 1U);
  try {
    WithBulletins(request, 2021, {{-6, 20}, {0, 1}});
    FAIL() << "accepted forecasts that no agent receives";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 100),
              "forecasts: got no forecast points of the storm between 2021-07-25T02:00:00Z and "
              "2021-07-25T06:00:00Z");
  }
}

TEST(Ranch, TakesNothingFromAStormOfAnotherYearByTheSameName) {
  try {
    WithBulletins(Request(), 2015, {{0, 20}, {4, 22}});
    FAIL() << "was made with the forecasts of another storm";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "forecasts: got In-Fa from 2015-07-25T00:00:00Z to 2015-07-25T04:00:00Z, expected "
                 "the storm from 2021-07-25T00:00:00Z to 2021-07-25T06:00:00Z");
  }
}

TEST(Ranch, HasTheStormAsItsFileSays) {
  const BuiltRanch ranch = BuildRanch(Request());
  ASSERT_EQ(ranch.scenario.disasters.size(), 1U);
  const DisasterSpec& storm = ranch.scenario.disasters[0];
  ASSERT_EQ(storm.track.size(), 3U);
  EXPECT_EQ(ranch.scenario.start_time, kMidnight) << "the track's first fix";
  EXPECT_EQ(storm.track[2].step, 6.0F * 3600.0F / 243.0F) << "500 m at 4 knots take 243 s";
  EXPECT_EQ(storm.track[0].grade, 3);
  EXPECT_EQ(storm.track[0].risks, DefaultGradeRisks()[2]);
  EXPECT_EQ(storm.duration, 89) << "to the last fix";
  EXPECT_TRUE(Says(ranch.decided, "In-fa (2106), CMA best track cma.txt, 3 fixes, 2-minute winds"));
  EXPECT_TRUE(Says(ranch.decided, "radii of 3 fixes estimated; radii of 0 fixes unknown"));
  EXPECT_TRUE(Says(ranch.decided, "34 kt over the ranch for 6."));
  EXPECT_TRUE(Says(ranch.warnings, "cma.txt:9: time: 2021-07-25T06:00:00Z occurs twice"));
  Farm farm(std::make_shared<const Scenario>(ranch.scenario));
  farm.Reset(1, 0);
  EXPECT_LT(RiskAt(farm.disasters(), {12, 10}), 0.0F);
}

TEST(PassageReport, StatesHoursOnlyIfTheyAreKnown) {
  StormRings storm;
  storm.wind_kt = {34};
  StormKnowledge knowledge;
  knowledge.recorded_until = knowledge.known_until = kMidnight + 24 * kHour_s;
  Passage passage;
  passage.worst_wind_kt = 34;
  passage.first = passage.last = kMidnight;
  EXPECT_TRUE(Says(internal::Report(storm, passage, knowledge).lines,
                   "34 kt over the ranch at 2021-07-25T00:00:00Z; strongest ring 34 kt"));
  passage.last += 5 * kHour_s;  // two samples with a gap between them
  EXPECT_TRUE(Says(internal::Report(storm, passage, knowledge).lines,
                   "34 kt over the ranch from 2021-07-25T00:00:00Z to 2021-07-25T05:00:00Z; "));
  passage.widest_h = 2.0;
  EXPECT_TRUE(Says(internal::Report(storm, passage, knowledge).lines,
                   "34 kt over the ranch for 2.0 h, from 2021-07-25T00:00:00Z to "));
}

TEST(Ranch, RefusesAFixFarAwayWithItsLine) {
  const fs::path path = fs::temp_directory_path() / ("far." + std::to_string(getpid()) + ".txt");
  RanchRequest request = Request();
  request.track = path.string();
  std::ofstream(path) << "66666 2106   02 0011 2106 0 3 In-fa   20220410\n"
                         "2021072500 4 297 1230  968      35\n"
                         "2021072506 4 300  122  970      33\n";
  EXPECT_EQ(Refused(request),
            path.string() +
                ":3: 2021-07-25T06:00:00Z: got latitude 30, longitude 12.2, expected a "
                "place within 60 degrees of the ranch");
  std::ofstream(path) << R"([{"tfbh": "1", "ename": "In-fa", "points": [
    {"time": "2021-07-25T14:00:00", "lat": 30, "lng": 122.2, "speed": 30}]}])";
  EXPECT_EQ(Refused(request), path.string() +
                                  ": 2021-07-25T06:00:00Z: got only one point of "
                                  "In-fa, expected at least two, which define its "
                                  "motion");
  fs::remove(path);
}

TEST(Ranch, SaysThatRadiiAreEstimatedWhereQuadrantsAreBlank) {
  RanchRequest request = Request();
  request.track = (kData / "ibtracs.csv").string();
  request.storm = "IALY";
  request.chart.clear();
  request.center = GeoPoint{-9.0, 50.0};
  EXPECT_TRUE(Says(BuildRanch(request).decided,
                   "radii of 2 fixes estimated, where quadrants are blank; radii of 0 fixes "
                   "unknown"));
}

TEST(Ranch, BorrowsRadiiAndHasItsOwnStart) {
  RanchRequest request = Request();
  request.radii = (kData / "bulletin.json").string();
  request.storm = "2106";
  request.start = kMidnight + kHour_s;
  request.step_s = 60.0;
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(Says(ranch.decided, "radii of 3 fixes from bulletin.json"));
  EXPECT_EQ(ranch.scenario.start_time, kMidnight + kHour_s);
  EXPECT_EQ(ranch.scenario.step_duration_s, 60.0);
  EXPECT_FLOAT_EQ(ranch.scenario.disasters[0].track[0].step, -60.0F);
}

TEST(SameStorm, IsNotFoundByTheIdOfTracksWithoutAnId) {
  StormTrack bravo;
  bravo.id = kUnknownStormId;
  bravo.name = "BRAVO";
  bravo.fixes.resize(1);
  StormFile file;
  file.tracks.push_back(bravo);
  EXPECT_EQ(internal::SameStorm("radii", file, bravo).name, "BRAVO");
  file.tracks[0].name = "ALPHA";
  EXPECT_THROW(internal::SameStorm("radii", file, bravo), InputError);
}

TEST(Ranch, BorrowsRadiiOfNoOtherStorm) {
  RanchRequest request = Request();
  const fs::path path = fs::temp_directory_path() / ("radii." + std::to_string(getpid()) + ".json");
  const auto with = [&](const std::string& name, const std::string& id) {
    std::ifstream file(kData / "bulletin.json");
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    text.replace(text.find("In-Fa"), 5, name);
    text.replace(text.find("202106"), 6, id);
    std::ofstream(path) << text;
    request.radii = path.string();
    return request;
  };
  EXPECT_EQ(Refused(with("Lekima", "201909")).substr(0, 29), "radii: storm: got 'In-fa', ex");
  const std::string id = FindTrack(LoadStormFile(request.track), request.storm).id;
  EXPECT_TRUE(Says(BuildRanch(with("Lekima", id)).decided, "radii of 3 fixes from")) << "by its id";
  EXPECT_TRUE(Says(BuildRanch(with("IN-FA", "202106")).decided, "radii of 3 fixes from"));
  fs::remove(path);
}

TEST(Ranch, KeepsQuadrantsWhereAskedTo) {
  RanchRequest request = Request();
  request.radii = (kData / "bulletin.json").string();
  request.reduction = RingReduction::kQuadrants;
  const BuiltRanch ranch = BuildRanch(request);
  const DisasterSpec& storm = ranch.scenario.disasters[0];
  ASSERT_EQ(storm.quadrants.size(), 3U);
  const QuadrantRadii& gale = storm.track[0].quadrants[2];
  EXPECT_GT(gale[0], gale[1]) << "farther to the north-east than to the south-east";
  EXPECT_NE(ranch.yaml.find("quadrants_km: [["), std::string::npos);
}

TEST(Ranch, IsNotLedAstrayByAName) {
  const fs::path path = fs::temp_directory_path() / ("evil." + std::to_string(getpid()) + ".json");
  std::ofstream(path) << R"([{"tfbh": "1", "ename": "X\nships: {count: 9} # \"", "points": [
    {"time": "2021-07-25T08:00:00", "lat": 30, "lng": 122, "speed": 30},
    {"time": "2021-07-25T20:00:00", "lat": 30.1, "lng": 122, "speed": 30}]}])";
  RanchRequest request = Request();
  request.track = path.string();
  request.storm.clear();
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_EQ(ranch.scenario.ships.count, 1);
  EXPECT_NE(ranch.scenario.description.find("X?ships: {count: 9} # \""), std::string::npos);
  fs::remove(path);
}

}  // namespace
}  // namespace aquafarm
