// SPDX-License-Identifier: BSD-3-Clause
// Tracks in JSON: bulletins, Zhejiang's list, a weather service's answer.
#include <gtest/gtest.h>

#include "storm_samples.h"

namespace aquafarm {
namespace {

TEST(Bulletin, IsReadFromTheScriptOfZhejiangsWaterOffice) {
  const StormFile file = Load("zhejiang.js");
  EXPECT_EQ(file.format, TrackFormat::kBulletin);
  EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
  const StormTrack& storm = file.tracks.at(0);
  EXPECT_EQ(storm.id, "202106");
  EXPECT_EQ(storm.name, "In-Fa");
  EXPECT_TRUE(storm.landfalls.empty()) << "its list names more than landfalls";
  ASSERT_EQ(storm.fixes.size(), 2U);
  const StormFix& fix = storm.fixes[0];
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
  const auto refused = [](const std::string& from, const std::string& to) {
    return Refusal(With(Sample("zhejiang.js"), from, to));
  };
  const auto warned = [](const std::string& from, const std::string& to) {
    return Warnings(With(Sample("zhejiang.js"), from, to));
  };
  const std::string four =
      "', expected four numbers in [0, 3000] such as 250|220|200|180; the value is "
      "ignored\n";
  EXPECT_EQ(warned("300|200|190|250", "300|200|190"),
            "x:9: [0].points[0].radius7: got '300|200|190" + four);
  EXPECT_EQ(warned("300|200|190|250", "300|-2|190|250|"),
            "x:9: [0].points[0].radius7: got '300|-2|190|250|" + four);
  EXPECT_EQ(warned("\"30.4\"", "\"95\""),
            "x:16: [0].points[0].forecast[1].forecastpoints[0].lat: got '95', expected a number in "
            "[-90, 90]; the point is left out\n"
            "x:15: [0].points[0].forecast[1]: got no points after its issue; the forecast is left "
            "out\n");
  EXPECT_EQ(warned("radius7\": \"300|200|190|250\"", "r7\": \"300|200|190\""),
            "x:9: [0].points[0].r7: got '300|200|190" + four);
  EXPECT_EQ(warned("radius12\": \"\"", "r12Quad\": {\"ne\": -1}"),
            "x:9: [0].points[0].r12Quad.ne: got -1, expected a number in [0, 3000]; the value is "
            "ignored\n"
            "x:9: [0].points[0].r12Quad: 64 kt: has none of the quadrants ne, se, sw and nw\n");
  EXPECT_EQ(warned("\"29.7\"", "\"95\""),
            "x:7: [0].points[0].lat: got '95', expected a number in [-90, 90]; the point is left "
            "out\n");
  EXPECT_NE(refused("];", "").find(": invalid JSON: "), std::string::npos);
  EXPECT_EQ(refused("let typhoons =", "typhoons").substr(0, 21), "x:3: invalid JSON: la");
}

TEST(Bulletin, ReadsBeijingTimeAndQuadrants) {
  const StormFile file = Load("bulletin.json");
  ASSERT_EQ(file.tracks.size(), 2U);
  const StormTrack& storm = FindTrack(file, "烟花");
  EXPECT_EQ(storm.name, "In-Fa");
  const StormFix& fix = storm.fixes[0];
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

TEST(Bulletin, ReadsBothSpellingsAndUnknownValues) {
  const StormFile file = ParseStormFile(Sample("bulletin.json"), "b.json");
  const StormTrack& storm = FindTrack(file, "202106");
  const StormFix& bare = storm.fixes[1];
  EXPECT_EQ(bare.wind_mps, std::nullopt);
  EXPECT_EQ(bare.pressure_hpa, std::nullopt);
  EXPECT_EQ(bare.grade, StormGrade::kUnknown);
  ExpectRadii(bare, 34, {200, 200, 200, 200});
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{"b.json:18: [0].points[1].moveDir: '中' is not a "
                                     "known direction"});
  const StormFix& weak = storm.fixes[2];
  EXPECT_EQ(weak.grade, StormGrade::kTropicalStorm) << "by its wind";
  EXPECT_EQ(weak.Ring(34), nullptr) << "18 m/s blow somewhere";
  ExpectRadii(weak, 50, {0, 0, 0, 0});
  EXPECT_EQ(file.tracks[1].name, "");
  EXPECT_EQ(file.tracks[1].local_name, "");
}

TEST(Bulletin, SaysWhichForecastsHaveNoPoints) {
  const auto said = [](const std::string& forecasts) {
    return Warnings(
        "[{\"tfbh\": \"1\", \"points\": [\n{\"time\": \"2021-07-25T08:00:00\", \"lat\": 30, "
        "\"lng\": 122,\n\"forecast\": [" +
        forecasts + "]}]}]");
  };
  const std::string point = R"([{"time": "2021-07-25T20:00:00", "lat": 30, "lng": 121}])";
  const std::string left_out = ": got no points after its issue; the forecast is left out\n";
  EXPECT_EQ(said(""), "");
  EXPECT_EQ(said("{\"sets\": \"中国\", \"points\": " + point + "}"), "");
  for (const std::string none :
       {R"({"sets": "中国"})", R"({"sets": "中国", "points": []})",
        R"({"sets": "中国", "points": null})", R"({"sets": "中国", "point": [{"lat": 30}]})",
        R"({"points": [{"time": "2021-07-25T08:00:00", "lat": 30, "lng": 122}]})"}) {
    EXPECT_EQ(said(none), "x:3: [0].points[0].forecast[0]" + left_out) << none;
    EXPECT_EQ(said("{\"points\": " + point + "},\n" + none),
              "x:4: [0].points[0].forecast[1]" + left_out);
  }
}

TEST(Bulletin, LeavesOutWhatAForecastSaysOfBefore) {
  const std::string late = With(Sample("bulletin.json"), "\"time\": \"2021-07-25T20:00:00\"",
                                "\"time\": \"2021-07-25T07:00:00\"");
  EXPECT_NE(Warnings(late).find("x:13: [0].points[0].forecast[0].points[0].time: got "
                                "2021-07-24T23:00:00Z, expected at least 2021-07-25T00:00:00Z, the "
                                "time of issue; the point is left out\n"),
            std::string::npos)
      << Warnings(late);
}

TEST(Bulletin, LeavesOutForecastPointsOfAnotherTime) {
  const auto with = [](const std::string& time) {
    return With(Sample("bulletin.json"), "2021-07-26T08:00:00", time);
  };
  EXPECT_EQ(Warnings(with("2021-08-09T08:00:00")).find("15 days"), std::string::npos);
  const std::string late = with("2021-08-09T08:01:00");
  EXPECT_EQ(Warnings(late).substr(0, 182),
            "x:15: [0].points[0].forecast[0].points[1].time: got 2021-08-09T00:01:00Z, expected "
            "the time of a forecast, within 15 days after 2021-07-25T00:00:00Z; the point is left "
            "out\nx:18: [0].");
  EXPECT_EQ(ParseStormFile(late, "x").tracks[0].forecasts.at(0).fixes.size(), 1U);
}

TEST(Bulletin, KeepsForecastsAndLandfallsInOrder) {
  const StormTrack storm = FindTrack(Load("bulletin.json"), "In-Fa");
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
  const StormFile file = ParseStormFile(Sample("weather_service.json"), "x");
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{"x:9: track[0].windRadius64: 64 kt: some quadrants have no "
                                     "radius; they get the radius 0"});
  const StormTrack& storm = file.tracks.at(0);
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

TEST(WeatherService, MayAnswerWithAForecastAlone) {
  const std::string answer = R"({"code": "200", "updateTime": "2021-07-27T03:00+00:00",
    "forecast": [
    {"fxTime": "2021-07-27T20:00+08:00", "lat": "31.7", "lon": "118.4", "type": "TS",
     "windSpeed": "18", "moveDir": ""},
    {"fxTime": "2021-07-28T20:00+08:00", "lat": "95", "lon": "117.2"}]})";
  EXPECT_EQ(Warnings(answer),
            "x:5: forecast[1].lat: got '95', expected a number in [-90, 90]; the point is left "
            "out\n");
  const StormFile file = ParseStormFile(With(answer, "\"95\"", "\"33\""), "x");
  EXPECT_TRUE(file.warnings.empty());
  ASSERT_EQ(file.tracks.at(0).fixes.size(), 2U);
  EXPECT_TRUE(file.tracks[0].fixes[0].forecast) << "not recorded";
}

TEST(WeatherService, ReadsTheForecastNextToTheTrackOrThePresentPosition) {
  const std::string forecast = R"(, "forecast": [
    {"fxTime": "2021-07-25T02:00+08:00", "lat": "29", "lon": "123"},
    {"fxTime": "2021-07-25T14:00+08:00", "lat": "31", "lon": "122", "windSpeed": "30"}]})";
  const std::string now = R"({"pubTime": "2021-07-25T08:00+08:00", "lat": "30", "lon": "122"})";
  for (const std::string& recorded : {"{\"track\": [" + now + "]", "{\"now\": " + now}) {
    const StormTrack track = ParseStormFile(recorded + forecast, "x").tracks.at(0);
    ASSERT_EQ(track.fixes.size(), 1U) << recorded;
    EXPECT_FALSE(track.fixes[0].forecast);
    ASSERT_EQ(track.forecasts.size(), 1U);
    EXPECT_EQ(track.forecasts[0].issued, kInFaNoon - 6 * 3600);
    ASSERT_EQ(track.forecasts[0].fixes.size(), 1U) << "the first is before the last position";
    EXPECT_EQ(track.forecasts[0].fixes[0].position.latitude, 31.0);
  }
}

TEST(WeatherService, SaysWhatItDoesNotRead) {
  const std::string track = R"("track": [{"time": "2021-07-25T08:00+08:00", "lat": "30",
    "lon": "122"}])";
  const std::string forecast = R"("forecast": [{"fxTime": "2021-07-25T14:00+08:00", "lat": "31",
    "lon": "122"}])";
  EXPECT_EQ(Warnings("{\"code\": \"200\", \"refer\": {},\n" + track + ",\n" + forecast + "}"), "");
  EXPECT_EQ(Warnings("{" + track + ",\n\"alerts\": [{\"id\": 1}], \"gusts\": null}"),
            "x:3: alerts: is not read\n");
  for (const char* none : {"null", "\"\"", "[]"}) {
    const std::string answer = std::string("{\"track\": ") + none + ",\n" + forecast + "}";
    EXPECT_EQ(Warnings(answer), "") << none;
    EXPECT_EQ(ParseStormFile(answer, "x").tracks.at(0).fixes.size(), 1U) << none;
  }
}

TEST(Motion, OfZeroWasNotSaid) {
  const auto speeds = [](const std::string& text) {
    return ParseStormFile(text, "x").tracks[0].fixes;
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

}  // namespace
}  // namespace aquafarm
