// SPDX-License-Identifier: BSD-3-Clause
// A storm whose recorded points end before it arrives is never reported as harmless.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "aquafarm/scenario/scenario_yaml.h"
#include "ranch_request.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

const std::string kForecast =
    R"(, "forecast": [{"sets": "中国", "points": [
  {"time": "2021-07-25T08:00:00", "lat": 29.0, "lng": 124.0, "speed": 40, "pressure": 960},
  {"time": "2021-07-25T20:00:00", "lat": 30.2, "lng": 122.0, "speed": 38, "radius7": 260,
   "radius10": 120, "radius12": 60},
  {"time": "2021-07-26T20:00:00", "lat": 34.0, "lng": 118.0, "speed": 28},
  {"time": "2021-07-27T08:00:00", "lat": 36.0, "lng": 117.0, "speed": 18}]}])";

class ForecastRanch : public testing::Test {
 protected:
  ForecastRanch() { request_.track.clear(); }
  ~ForecastRanch() override { fs::remove(path_); }

  // Three recorded points, 700 km or more south-east of the ranch, each with a radius of 300 km.
  BuiltRanch Make(const std::string& forecast,
                  const std::string& wind = "\"speed\": 42, \"radius7\": 300") {
    const auto point = [&](const char* time, double latitude, double longitude) {
      return std::string("{\"time\": \"2021-07-") + time +
             ":00:00\", \"lat\": " + std::to_string(latitude) +
             ", \"lng\": " + std::to_string(longitude) + ", " + wind;
    };
    std::ofstream(path_) << "[{\"tfbh\": \"202106\", \"ename\": \"In-fa\", \"points\": [\n"
                         << point("24T08", 24.6, 128.6) << "},\n"
                         << point("24T14", 25.4, 127.8) << "},\n"
                         << point("24T20", 26.2, 127.0) << forecast << "}]}]";
    request_.track = path_.string();
    return BuildRanch(request_);
  }

  RanchRequest request_{Request()};
  const fs::path path_{fs::temp_directory_path() / ("end." + std::to_string(getpid()) + ".json")};
};

TEST_F(ForecastRanch, FollowsTheForecastWhereTheRecordEnds) {
  const BuiltRanch ranch = Make(kForecast);
  EXPECT_TRUE(Says(ranch.decided,
                   "storm: recorded until 2021-07-24T12:00:00Z, then forecast until "
                   "2021-07-27T00:00:00Z (issued 2021-07-24T12:00:00Z by 中国)"));
  EXPECT_TRUE(Says(ranch.decided, "nearest: 13 km at 2021-07-25T11:10:00Z, by the forecast"));
  EXPECT_TRUE(Says(ranch.decided, "34 kt over the ranch for "));
  EXPECT_TRUE(Says(ranch.decided, "; all of it by the forecast"));
  EXPECT_FALSE(Says(ranch.decided, "never"));
  const DisasterSpec& storm = ranch.scenario.disasters.at(0);
  EXPECT_GT(storm.track.size(), 3U);
  EXPECT_NE(ranch.yaml.find("# forecast\n"), std::string::npos) << "with radii";
  EXPECT_NE(ranch.yaml.find("# forecast, radii estimated\n"), std::string::npos);
  EXPECT_NE(ranch.scenario.description.find("recorded until 2021-07-24T12:00:00Z, then forecast"),
            std::string::npos)
      << "kept where comments are lost";
  EXPECT_EQ(ParseScenario(ranch.yaml, "x").disasters[0].track.size(), storm.track.size());
}

TEST_F(ForecastRanch, SeparatesTheRecordedPartOfAPassage) {
  const BuiltRanch ranch = Make(
      R"(}, {"time": "2021-07-25T02:00:00", "lat": 28, "lng": 124.5, "speed": 42, "radius7": 400)" +
      kForecast);
  EXPECT_TRUE(Says(ranch.decided, "; by the forecast after 2021-07-24T18:00:00Z"));
}

TEST_F(ForecastRanch, GivesTheSameFilesForecastsToItsAgents) {
  request_.forecasts = path_.string();
  const BuiltRanch ranch = Make(kForecast);
  EXPECT_TRUE(Says(ranch.decided, "forecasts: 1 from "));
  EXPECT_EQ(ranch.scenario.disasters.at(0).forecasts.size(), 1U);
}

TEST_F(ForecastRanch, NeverStatesAnAllClearWithoutAForecast) {
  const BuiltRanch ranch = Make("");
  EXPECT_TRUE(Says(ranch.decided,
                   "34 kt do not reach the ranch from 2021-07-24T00:00:00Z to "
                   "2021-07-24T12:00:00Z; the storm is known until 2021-07-24T12:00:00Z only"));
  EXPECT_TRUE(Says(ranch.decided, ", its last known position: it may come nearer after that"));
  EXPECT_FALSE(Says(ranch.decided, "never"));
  EXPECT_FALSE(Says(ranch.decided, "over after"));
  EXPECT_TRUE(Says(ranch.decided, " known for "));
  EXPECT_EQ(ranch.scenario.step_limit, ranch.scenario.disasters.at(0).duration)
      << "no calm steps after the last known one";
}

TEST_F(ForecastRanch, TakesNoForecastOlderThanADay) {
  const BuiltRanch ranch =
      Make(kForecast + R"(}, {"time": "2021-07-25T20:01:00", "lat": 27, "lng": 126, "speed": 42)");
  EXPECT_TRUE(Says(ranch.decided, "known until 2021-07-25T12:01:00Z only"));
}

TEST_F(ForecastRanch, SaysThatAStormIsStillOverItAtTheEnd) {
  const BuiltRanch ranch =
      Make(R"(}, {"time": "2021-07-25T08:00:00", "lat": 29.9, "lng": 122.3, "speed": 42)");
  EXPECT_TRUE(Says(ranch.decided, "; still over it at the last known time"));
  EXPECT_TRUE(Says(ranch.warnings,
                   "storm: 34 kt are still over the ranch at 2021-07-25T00:00:00Z, the last known "
                   "time: what follows is unknown, not calm; give a newer bulletin"));
  EXPECT_EQ(ranch.scenario.step_limit, ranch.scenario.disasters.at(0).duration);
}

TEST_F(ForecastRanch, SaysThatWindAndRadiiAreUnknown) {
  const BuiltRanch ranch = Make("", "\"speed\": null");
  EXPECT_TRUE(Says(ranch.decided,
                   "34 kt: unknown whether they reach the ranch, as neither wind nor radii are "
                   "known from 2021-07-24T00:00:00Z to 2021-07-24T12:00:00Z while the storm is "
                   "within 1110 km; the storm is known until"));
  const BuiltRanch partly =
      Make(R"(}, {"time": "2021-07-25T08:00:00", "lat": 29.9, "lng": 122.3, "speed": 42)",
           "\"speed\": null");
  EXPECT_TRUE(Says(partly.warnings, "storm: neither wind nor radii are known from"));
}

TEST_F(ForecastRanch, KeepsTheLastWindWhereAForecastHasNone) {
  const BuiltRanch ranch = Make(
      R"(, "forecast": [{"points": [{"time": "2021-07-25T20:00:00", "lat": 30.2, "lng": 122.0}]}])");
  EXPECT_TRUE(Says(ranch.decided, "34 kt over the ranch for "));
  // 300 km are 600 cells of 500 m. The estimated radius increases to the north, and the storm keeps
  // its size relative to it.
  EXPECT_NEAR(ranch.scenario.disasters.at(0).track.back().radii.back(), 623.0F, 1.0F);
}

TEST_F(ForecastRanch, HoldsTheLargerRadiiWhereTheWindIsUnknownBetweenTwoPoints) {
  const BuiltRanch ranch = Make(
      R"(, "forecast": [{"points": [{"time": "2021-07-25T20:00:00", "lat": 30.2, "lng": 122.0,
          "radius7": 100}]}])");
  EXPECT_TRUE(
      Says(ranch.warnings,
           "storm: stretches of the track in which the wind cannot be interpolated: 1; they "
           "have the larger radii of both ends; give a track with a wind at each point"));
  const std::vector<Waypoint>& track = ranch.scenario.disasters.at(0).track;
  EXPECT_EQ(track.back().radii.back(), 200.0F) << "100 km";
  EXPECT_EQ(track[track.size() - 2].radii.back(), 600.0F) << "300 km";
}

TEST_F(ForecastRanch, EstimatesFromTheGradeWhereTheWindIsUnknown) {
  const BuiltRanch ranch = Make(kForecast, "\"strong\": \"台风(TY)\"");
  EXPECT_TRUE(Says(ranch.decided, "radii of 0 fixes unknown"));
  EXPECT_GT(ranch.scenario.disasters.at(0).track[0].radii.back(), 200.0F) << "of 32.7 m/s";
}

TEST_F(ForecastRanch, MayHaveOneRecordedPoint) {
  std::ofstream(path_) << R"([{"tfbh": "1", "ename": "In-fa", "points": [{"time":
    "2021-07-24T20:00:00", "lat": 26.2, "lng": 127, "speed": 42)"
                       << kForecast << "}]}]";
  request_.track = path_.string();
  EXPECT_TRUE(Says(BuildRanch(request_).decided, "34 kt over the ranch for "));
}

TEST_F(ForecastRanch, NamesAStormThatIsFarAwayAndAStartBeforeIt) {
  request_.center = GeoPoint{10.0, 150.0};
  request_.chart.clear();
  EXPECT_TRUE(Says(Make("").warnings,
                   "storm: its known track from 2021-07-24T00:00:00Z to 2021-07-24T12:00:00Z comes "
                   "no nearer than "));
  EXPECT_TRUE(Says(Make("").warnings, " km to the ranch, expected within 500 km; check --center"));
  request_ = Request();
  request_.start = kMidnight - 48 * kHour_s;
  EXPECT_TRUE(Says(Make(kForecast).warnings,
                   "start: got 2021-07-23T00:00:00Z, expected at least 2021-07-24T00:00:00Z, the "
                   "time of the storm's first known position; the storm stays there until then"));
}

// A bulletin that ends before the storm arrives.
TEST_F(ForecastRanch, HoldsForARealBulletinCutBeforeTheStormCame) {
  const fs::path real = SharedData() / "bulletins" / "202106.json";
  if (!fs::exists(real)) GTEST_SKIP() << "no real files at " << SharedData();
  std::ifstream file(real);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t cut = text.find("\"2021-07-24T08:00:00\"");
  ASSERT_NE(cut, std::string::npos);
  text = text.substr(0, text.rfind("},", text.rfind('{', cut)) + 1) + "]}]";
  std::ofstream(path_) << text;
  request_.track = path_.string();
  const BuiltRanch ranch = BuildRanch(request_);
  EXPECT_TRUE(Says(ranch.decided, "; the storm is known until 2021-07-23T"));
  EXPECT_FALSE(Says(ranch.decided, "never"));
}

}  // namespace
}  // namespace aquafarm
