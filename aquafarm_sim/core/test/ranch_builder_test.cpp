// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/ranch_builder.h"

#include <gtest/gtest.h>
#include <netcdf.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "aquafarm/check.h"
#include "aquafarm/farm.h"
#include "aquafarm/geo_frame.h"
#include "aquafarm/hazard_file.h"
#include "aquafarm/scenario_yaml.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(AQUAFARM_CORE_DIR) / "test" / "data";
constexpr std::int64_t kHour_s = 3600;
constexpr std::int64_t kMidnight = 1627171200;  // 2021-07-25 00:00 UTC

// The square island with a lake of coast.json, and the storm of cma.txt, which passes 20 km north.
RanchRequest Request() {
  RanchRequest request;
  request.chart = (kData / "coast.json").string();
  request.center = GeoPoint{30.03, 122.05};
  request.width = 24;
  request.height = 20;
  request.cell_size_m = 500.0;
  request.track = (kData / "cma.txt").string();
  request.storm = "In-fa";
  return request;
}

bool Says(const std::vector<std::string>& lines, const std::string& words) {
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.find(words) != std::string::npos;
  });
}

std::string Refused(const RanchRequest& request) {
  try {
    BuildRanch(request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was made";
}

TEST(Ranch, OfManyDevicesTellsNetworksTheWay) {
  RanchRequest request = Request();
  request.devices = 3;
  EXPECT_FALSE(BuildRanch(request).scenario.view.waterways);
  request.devices = 12;
  const Ranch ranch = BuildRanch(request);
  EXPECT_TRUE(ranch.scenario.view.waterways);
  // 24 x 20 cells, each device waiting or delivered, or one of them aboard.
  EXPECT_TRUE(Says(ranch.decided, "states: 13762560, many for a table"));
  EXPECT_NE(ranch.yaml.find("#   states: 13762560"), std::string::npos);
}

TEST(Ranch, TooLargeForWaysByWaterIsWhatItsFileSays) {
  RanchRequest request;
  request.width = request.height = 1100;
  request.devices = 12;
  const Ranch ranch = BuildRanch(request);
  EXPECT_FALSE(ranch.scenario.view.waterways);
  EXPECT_EQ(HashScenario(ranch.scenario), HashScenario(ParseScenario(ranch.yaml, request.name)));
}

TEST(Ranch, TellsItsAgentsWhatTheBulletinsForecast) {
  RanchRequest request = Request();
  request.forecasts = (kData / "bulletin.json").string();
  const Ranch ranch = BuildRanch(request);
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

// The ranch with bulletins of In-fa of a year, each a pair of hours of its 25 July, UTC: when it
// was issued and when the one point forecast is.
Ranch WithBulletins(RanchRequest request, int year,
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
  const Ranch ranch = WithBulletins(request, 2021, {{-6, 20}, {0, 20}, {4, 22}, {6, 23}});
  EXPECT_TRUE(ranch.warnings.size() == 1) << "of a fix that is there twice";
  const std::vector<IssuedForecast>& told = ranch.scenario.disasters[0].forecasts;
  ASSERT_EQ(told.size(), 2U) << "the storm is over at 06:00";
  EXPECT_NEAR(told[0].step, -2.0 * kHour_s / ranch.scenario.step_duration_s, 1e-2);
  EXPECT_NEAR(told[1].step, 2.0 * kHour_s / ranch.scenario.step_duration_s, 1e-2);
}

TEST(Ranch, LeavesOutAForecastThatEndsBeforeItsStart) {
  RanchRequest request = Request();
  request.start = kMidnight + 2 * kHour_s;
  const Ranch ranch = WithBulletins(request, 2021, {{-6, 20}, {0, 2}, {4, 22}});
  EXPECT_TRUE(Says(ranch.warnings,
                   "forecasts: that of 2021-07-25T00:00:00Z ends at 2021-07-25T02:00:00Z, by the "
                   "start, and is left out"));
  EXPECT_EQ(ranch.scenario.disasters[0].forecasts.size(), 1U);
  try {
    WithBulletins(request, 2021, {{-6, 20}, {0, 1}});
    FAIL() << "was made with forecasts that nobody is told";
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

TEST(Ranch, StandsOnTheChartWithPortsAtTheShore) {
  const Ranch ranch = BuildRanch(Request());
  const Scenario& scenario = ranch.scenario;
  EXPECT_EQ(scenario.width, 24);
  EXPECT_EQ(scenario.cell_size_m, 500.0);
  EXPECT_EQ(scenario.ports.cells.size(), 4U);
  std::int32_t land = 0;
  for (const IslandBlock& block : scenario.islands) land += block.width * block.height;
  // 4.8 x 5.5 km with its lake filled, and a triangle of half a square kilometre.
  EXPECT_NEAR(land * 0.25, 4.82 * 5.54 + 0.53, 3.0);
  EXPECT_TRUE(Says(ranch.decided, "island cells"));
  EXPECT_TRUE(Says(ranch.decided, "of enclosed water filled"));
  const std::string sketch = Sketch(scenario);
  EXPECT_EQ(sketch.size(), 20U * 25U);
  EXPECT_EQ(std::count(sketch.begin(), sketch.end(), 'P'), 4);
  EXPECT_EQ(std::count(sketch.begin(), sketch.end(), 'd'), 4);
  EXPECT_EQ(std::count(sketch.begin(), sketch.end(), '#'), land);
}

TEST(Ranch, HasTheStormAsItsFileSays) {
  const Ranch ranch = BuildRanch(Request());
  ASSERT_EQ(ranch.scenario.disasters.size(), 1U);
  const DisasterSpec& storm = ranch.scenario.disasters[0];
  ASSERT_EQ(storm.track.size(), 3U);
  EXPECT_EQ(ranch.scenario.start_time, kMidnight) << "the track's first fix";
  EXPECT_EQ(storm.track[2].step, 6.0F * 3600.0F / 243.0F) << "500 m at 4 knots take 243 s";
  EXPECT_EQ(storm.track[0].grade, 3);
  EXPECT_EQ(storm.track[0].risks, DefaultGradeRisks()[2]);
  EXPECT_EQ(storm.duration, 89) << "to the last fix";
  EXPECT_TRUE(Says(ranch.decided, "In-fa (2106), CMA best track cma.txt, 3 fixes, winds of 2 min"));
  EXPECT_TRUE(Says(ranch.decided, "radii estimated at 3, unknown at 0"));
  EXPECT_TRUE(Says(ranch.decided, "34 kt over the ranch for 6."));
  EXPECT_TRUE(Says(ranch.warnings, "cma.txt:9: time: 2021-07-25T06:00:00Z is there twice"));
  Farm farm(std::make_shared<const Scenario>(ranch.scenario));
  farm.Reset(1, 0);
  EXPECT_LT(RiskAt(farm.disasters(), {12, 10}), 0.0F);
}

TEST(Ranch, BorrowsRadiiAndHasItsOwnStart) {
  RanchRequest request = Request();
  request.radii = (kData / "bulletin.json").string();
  request.storm = "2106";
  request.start = kMidnight + kHour_s;
  request.step_s = 60.0;
  const Ranch ranch = BuildRanch(request);
  EXPECT_TRUE(Says(ranch.decided, "radii of 3 from bulletin.json"));
  EXPECT_EQ(ranch.scenario.start_time, kMidnight + kHour_s);
  EXPECT_EQ(ranch.scenario.step_duration_s, 60.0);
  EXPECT_FLOAT_EQ(ranch.scenario.disasters[0].track[0].step, -60.0F);
}

TEST(Ranch, PutsAPortAskedForAtTheNearestShore) {
  RanchRequest request = Request();
  request.port_places = {{30.025, 122.025}};  // in the lake
  const Ranch ranch = BuildRanch(request);
  ASSERT_EQ(ranch.scenario.ports.cells.size(), 1U);
  EXPECT_TRUE(Says(ranch.decided, "port: asked for at (7, 8), put at the shore at ("));
}

TEST(Ranch, MayBeCalmAndOnOpenSea) {
  RanchRequest request;
  request.devices = 12;
  request.placement = DevicePlacement::kLinear;
  const Ranch ranch = BuildRanch(request);
  EXPECT_TRUE(ranch.scenario.disasters.empty());
  EXPECT_EQ(ranch.scenario.origin, std::nullopt);
  EXPECT_EQ(ranch.scenario.ports.count, 4);
  EXPECT_TRUE(Says(ranch.decided, "no shore, so 4 drawn at the edge"));
}

TEST(Ranch, HasOtherDisastersBesideItsStorm) {
  RanchRequest request = Request();
  request.disasters = {"red_tide:area_km2=120,current_mps=0.3,current_to_deg=45",
                       "wave:height_m=4,radius_km=5,duration_h=48"};
  const Ranch ranch = BuildRanch(request);
  ASSERT_EQ(ranch.scenario.disasters.size(), 3U);
  EXPECT_EQ(ranch.scenario.disasters[0].duration, 89);
  EXPECT_EQ(ranch.scenario.disasters[1].kind, DisasterKind::kRedTide);
  EXPECT_EQ(ranch.scenario.disasters[1].heading_deg, 45);
  EXPECT_EQ(ranch.scenario.disasters[2].grade, 2);
  EXPECT_EQ(ranch.scenario.disasters[2].duration, 712) << "48 h of 243 s";
  EXPECT_EQ(ranch.scenario.step_limit, 812);
  EXPECT_TRUE(Says(ranch.decided, "disaster: wave:height_m=4"));
  request.disasters = {"wave:height_m=1,radius_km=5"};
  EXPECT_EQ(Refused(request), "disaster: wave: height_m: got 1, expected [2.5, 30]");
}

TEST(Ranch, TakesItsSizeFromAGridInMetres) {
  const fs::path path = fs::temp_directory_path() / ("bay." + std::to_string(getpid()) + ".asc");
  std::ofstream(path) << "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 150\n"
                         "-1 -1 -1 -1\n-1 5 -1 -1\n-1 -1 -1 -1\n";
  RanchRequest request;
  request.chart = path.string();
  request.ports = 2;
  const Ranch ranch = BuildRanch(request);
  EXPECT_EQ(ranch.scenario.width, 4);
  EXPECT_EQ(ranch.scenario.cell_size_m, 150.0);
  EXPECT_EQ(Sketch(ranch.scenario)[5 + 1], '#');
  request.start = kMidnight;
  EXPECT_EQ(BuildRanch(request).scenario.start_time, kMidnight) << "without a storm";
  fs::remove(path);
}

TEST(Ranch, IsRefusedWithTheReason) {
  RanchRequest request = Request();
  request.center.reset();
  EXPECT_EQ(Refused(request), "center: got nothing, expected the place of the ranch for its storm");
  request.track.clear();
  EXPECT_EQ(Refused(request), "center: got nothing, expected the place of the ranch on the chart");
  request = Request();
  request.storm = "Rai";
  EXPECT_EQ(Refused(request).substr(0, 37), "storm: got 'Rai', expected one of: 71");
  request = Request();
  request.start = kMidnight + 24 * kHour_s;
  EXPECT_EQ(Refused(request),
            "start: got 2021-07-26T00:00:00Z, expected a time before 2021-07-25T06:00:00Z, when "
            "the storm is over");
  request = Request();
  request.center = GeoPoint{30.01, 122.01};
  request.width = request.height = 3;
  EXPECT_EQ(Refused(request), "chart: got no water, expected some for ships to sail on");
  request = Request();
  request.devices = 1000;
  EXPECT_NE(Refused(request).find("devices"), std::string::npos);
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
  const std::string id = FindTrack(LoadHazardFile(request.track), request.storm).id;
  EXPECT_TRUE(Says(BuildRanch(with("Lekima", id)).decided, "radii of 3")) << "by its id";
  EXPECT_TRUE(Says(BuildRanch(with("IN-FA", "202106")).decided, "radii of 3"));
  fs::remove(path);
}

TEST(Ranch, SaysTheNoticesInForce) {
  RanchRequest request = Request();
  request.notices = (kData / "anchorage.json").string();
  EXPECT_TRUE(Says(BuildRanch(request).decided, "notices: 2 more at other times"));
  request.track.clear();
  request.storm.clear();
  EXPECT_TRUE(Says(BuildRanch(request).decided, "rating 1 of 4, from 2026-04-30T15:00:00Z"));
}

TEST(Ranch, CountsNoticesAfterItsLastStepAsOfOtherTimes) {
  const fs::path path =
      fs::temp_directory_path() / ("notices." + std::to_string(getpid()) + ".json");
  RanchRequest request = Request();
  request.notices = path.string();
  const auto warn = [&](const char* from, const char* to) {
    std::ofstream(path) << R"({"code": "200", "warning": [{"sender": "x", "typeName": "gale",
      "severityColor": "Red", "startTime": ")"
                        << from << R"(", "endTime": ")" << to << "\"}]}";
    return BuildRanch(request).decided;
  };
  // 189 steps of 243 s from midnight, so to 12:45.
  EXPECT_TRUE(Says(warn("2021-07-25T12:00+00:00", "2021-07-26T12:00+00:00"), "notice: gale of x"));
  EXPECT_TRUE(Says(warn("2021-07-26T12:45+00:00", "2021-07-27T12:00+00:00"),
                   "notices: 1 more at other times"));
  request.disasters = {"wave:height_m=4,radius_km=5,duration_h=48"};
  EXPECT_TRUE(Says(warn("2021-07-26T12:45+00:00", "2021-07-27T12:00+00:00"), "notice: gale of x"));
  fs::remove(path);
}

TEST(Ranch, KeepsASeaOfSmallNumbersAndRulesByWhatItWrites) {
  const fs::path path = fs::temp_directory_path() / ("small." + std::to_string(getpid()) + ".nc");
  int file = 0;
  std::array<int, 2> dims{};
  std::array<int, 3> variables{};
  nc_create(path.c_str(), NC_CLOBBER, &file);
  nc_def_dim(file, "lat", 2, &dims[0]);
  nc_def_dim(file, "lon", 2, &dims[1]);
  nc_def_var(file, "lat", NC_DOUBLE, 1, &dims[0], &variables[0]);
  nc_def_var(file, "lon", NC_DOUBLE, 1, &dims[1], &variables[1]);
  nc_def_var(file, "chl", NC_FLOAT, 2, dims.data(), &variables[2]);
  nc_enddef(file);
  const std::array<double, 2> latitude{29.0, 31.0};
  const std::array<double, 2> longitude{121.0, 123.0};
  const std::array<float, 4> values{1e-5F, 1e-5F, 1e-5F, 1e-5F};
  nc_put_var_double(file, variables[0], latitude.data());
  nc_put_var_double(file, variables[1], longitude.data());
  nc_put_var_float(file, variables[2], values.data());
  nc_close(file);
  RanchRequest request = Request();
  request.sea = {{"chl", path.string(), "chl"}};
  request.value = "chl > 0.000009 ? 70.125 : 1";
  request.sea_risk = "chl > 0.000009 ? -8 : 0";
  const Scenario scenario = BuildRanch(request).scenario;
  EXPECT_EQ(scenario.seas->layers[0].values[7], 1e-5F);
  EXPECT_EQ(scenario.seas->risk[7], -8.0F);
  for (const DeviceSite& site : scenario.devices.sites) EXPECT_EQ(*site.value, 70.125F);
  fs::remove(path);
}

TEST(Ranch, KeepsQuadrantsWhereAskedTo) {
  RanchRequest request = Request();
  request.radii = (kData / "bulletin.json").string();
  request.reduction = RingReduction::kQuadrants;
  const Ranch ranch = BuildRanch(request);
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
  const Ranch ranch = BuildRanch(request);
  EXPECT_EQ(ranch.scenario.ships.count, 1);
  EXPECT_NE(ranch.scenario.description.find("X?ships: {count: 9} # \""), std::string::npos);
  fs::remove(path);
}

// Runs the program; gives its exit code and what it wrote.
std::pair<int, std::string> RunApp(const std::string& arguments) {
  FILE* pipe = popen((AQUAFARM_SCENARIO_APP " " + arguments + " 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> part{};
  while (fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  return {WEXITSTATUS(pclose(pipe)), text};
}

TEST(Program, SaysWhatToTrainWith) {
  const fs::path path = fs::temp_directory_path() / ("many_" + std::to_string(getpid()) + ".yaml");
  const auto now = [&path](const std::string& arguments) {
    const std::string text = RunApp("--size 20x20 -o " + path.string() + " " + arguments).second;
    const std::string made = "now: ./aquafarm train scenario:=" + path.string();
    const std::size_t at = text.find(made);
    return at == std::string::npos ? text : text.substr(at + made.size());
  };
  EXPECT_EQ(now("--devices 3"), "\n");
  EXPECT_EQ(now("--devices 14"), "\n");
  EXPECT_EQ(now("--devices 15"), " algorithm:=dqn options:=steps_per_update=4 steps:=1200000\n");
  EXPECT_EQ(now("--devices 3 --ships 2"), " algorithm:=auto\n");
  fs::remove(path);
}

TEST(Program, MakesAFileAndSaysWhatItDecided) {
  const fs::path path = fs::temp_directory_path() / ("bay_" + std::to_string(getpid()) + ".yaml");
  const std::string data = kData.string();
  const auto [code, text] = RunApp(
      "--chart " + data + "/coast.json --center 30.03,122.05 --size 24x20 --cell 0.5km --track " +
      data + "/cma.txt --storm in-fa --devices 6 --layout linear -o " + path.string());
  EXPECT_EQ(code, 0) << text;
  EXPECT_NE(text.find("nearest: "), std::string::npos);
  EXPECT_NE(text.find("now: ./aquafarm train scenario:=" + path.string()), std::string::npos);
  const Scenario scenario = LoadScenario(path.string());
  EXPECT_EQ(scenario.name, path.stem().string());
  EXPECT_EQ(scenario.devices.count, 6);
  fs::remove(path);
}

TEST(Program, RefusesWrongArguments) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"--center 30", "center: got '30', expected LATITUDE,LONGITUDE in degrees"},
      {"--center 95,120", "expected a latitude in [-90, 90] and a longitude in [-180, 180]"},
      {"--size 25", "size: got '25', expected WIDTHxHEIGHT in cells"},
      {"--size 1x25", "size: got '1x25', expected whole numbers in [2, 4096]"},
      {"--cell 20furlongs", "cell: got '20furlongs', expected a length as 200m or 0.2km"},
      {"--layout explicit", "layout: got 'explicit', expected one of uniform, linear, random"},
      {"--sea salt:so --value 3", "sea: got 'salt:so', expected NAME=FILE:VARIABLE"},
      {"--value 3", "value: got no layer to evaluate '3' on"},
      {"--rings oval --track x",
       "rings: got 'oval', expected one of equal_area, largest, quadrants"},
      {"--storm Rai", "--storm requires --track"},
      {"--radii x", "--radii requires --track"},
      {"--rings largest", "--rings requires --track"},
      {"--lead 4", "--lead requires --track"},
      {"--sea-risk 1", "--sea-risk requires --sea"},
      {"--sea-level nan", "sea_level: got nan, expected [-100000, 100000]"},
      {"--start noon", "start: got 'noon', expected a UTC time as 2021-07-24T12:00:00Z"},
      {"--chart /nowhere.json --center 30,122", "/nowhere.json: cannot read: No such file"},
      {"--devices 0", "--devices: Value 0 not in range"},
      {"--frob", "The following argument was not expected: --frob"},
      {"-o /nowhere/x.yaml", "/nowhere/x.yaml: cannot write"}};
  for (const auto& [arguments, words] : cases) {
    const auto [code, text] = RunApp(arguments);
    EXPECT_EQ(code, 2) << arguments;
    EXPECT_NE(text.find(words), std::string::npos) << text;
  }
}

TEST(Program, RefusesASizeForAChartWithItsOwn) {
  const fs::path path = fs::temp_directory_path() / ("own." + std::to_string(getpid()) + ".asc");
  std::ofstream(path) << "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 150\n"
                         "-1 -1 -1 -1\n-1 5 -1 -1\n-1 -1 -1 -1\n";
  const std::string chart = "--ports 2 --chart " + path.string();
  const auto [size_code, size] = RunApp(chart + " --size 9x9");
  EXPECT_EQ(size_code, 2);
  EXPECT_EQ(size, "size: got '9x9', expected none, as the chart has its own\n");
  const auto [cell_code, cell] = RunApp(chart + " --cell 1km");
  EXPECT_EQ(cell_code, 2);
  EXPECT_EQ(cell, "cell: got '1km', expected none, as the chart has its own\n");
  EXPECT_EQ(RunApp(chart).first, 0);
  fs::remove(path);
}

TEST(RealFiles, MakeARanchOffDongji) {
  const fs::path data = SharedData();
  if (!fs::exists(data)) GTEST_SKIP() << "no real files at " << data;
  RanchRequest request;
  request.chart = (data / "coast" / "zhoushan_330900.json").string();
  request.center = GeoPoint{30.2, 122.7};
  request.track = (data / "tracks" / "CH2021BST.txt").string();
  request.storm = "IN-FA";
  request.radii = (data / "bulletins" / "202106.json").string();
  request.devices = 12;
  request.placement = DevicePlacement::kLinear;
  const Ranch ranch = BuildRanch(request);
  EXPECT_TRUE(ranch.warnings.empty());
  EXPECT_TRUE(Says(ranch.decided, "nearest: 32 km at 2021-07-25T03:30:00Z")) << ranch.yaml;
  EXPECT_TRUE(Says(ranch.decided, "strongest ring 64 kt"));
}

TEST(RealFiles, GiveDevicesTheirValueFromTheSea) {
  const fs::path data = SharedData();
  if (!fs::exists(data)) GTEST_SKIP() << "no real files at " << data;
  RanchRequest request;
  request.center = GeoPoint{24.8, 57.9};
  request.cell_size_m = 2000.0;
  const std::string file = (data / "ocean" / "HYCOM_ST_GoO_20160428to20160503.nc").string();
  request.sea = {{"salt", file, "so"}, {"warmth", file, "thetao"}};
  request.value = "warmth > 26 ? 80 : 40 + salt";
  const Ranch ranch = BuildRanch(request);
  EXPECT_TRUE(Says(ranch.decided, "salt: so of HYCOM_ST_GoO_20160428to20160503.nc at 2016-04-28T"));
  ASSERT_EQ(ranch.scenario.devices.sites.size(), 4U);
  for (const DeviceSite& site : ranch.scenario.devices.sites) {
    EXPECT_TRUE(*site.value == 80.0F || (*site.value > 75.0F && *site.value < 79.0F));
  }
  request.value = "-salt";
  EXPECT_NE(Refused(request).find("expected a number in [0, 10000]"), std::string::npos);
  request.value = "salty";
  EXPECT_NE(Refused(request).find("expected an expression"), std::string::npos);
  request.center = GeoPoint{30.0, 122.0};
  EXPECT_NE(Refused(request).find("has no value on this ranch"), std::string::npos);
}

// The archive's bulletins were kept without their forecasts; the storm goes on as it did.
TEST(RealFiles, OfBulletinsHaveNoForecastsToTell) {
  const fs::path data = SharedData();
  if (!fs::exists(data)) GTEST_SKIP() << "no real files at " << data;
  RanchRequest request;
  request.center = GeoPoint{30.2, 122.7};
  request.track = (data / "tracks" / "CH2021BST.txt").string();
  request.storm = "IN-FA";
  request.forecasts = (data / "bulletins" / "202106.json").string();
  EXPECT_EQ(Refused(request),
            "forecasts: got no forecast points of the storm between 2021-07-24T11:00:00Z and "
            "2021-07-26T01:00:00Z in "
            "202106.json, expected bulletins with forecast points");
}

// Scenario files that a person may edit; what decides the play is still what the command makes.
TEST(RealFiles, MakeTheShippedRanches) {
  const fs::path data = SharedData();
  if (!fs::exists(data)) GTEST_SKIP() << "no real files at " << data;
  const fs::path shipped = fs::path(AQUAFARM_CORE_DIR).parent_path() / "scenarios";
  RanchRequest request;
  request.chart = (data / "coast" / "zhoushan_330900.json").string();
  request.center = GeoPoint{30.19, 122.70};
  request.width = 22;
  request.height = 18;
  request.cell_size_m = 500.0;
  request.track = (data / "tracks" / "CH2019BST.txt").string();
  request.radii = (data / "tracks" / "bst_all_2015-2021.txt").string();
  request.ports = 3;
  request.storm = "DANAS";
  request.devices = 4;
  request.placement = DevicePlacement::kUniform;
  EXPECT_EQ(BuildRanch(request).scenario.hash,
            LoadScenario((shipped / "zhoushan_danas_2019.yaml").string()).hash);
  request.storm = "MITAG";
  request.devices = 6;
  request.placement = DevicePlacement::kLinear;
  EXPECT_EQ(BuildRanch(request).scenario.hash,
            LoadScenario((shipped / "zhoushan_mitag_2019.yaml").string()).hash);
}

// It was written by hand, for its islands are blocks that a person chose; its storm is the
// command's.
TEST(RealRanch, ShippedInFaHasTheStormThatTheCommandMakes) {
  const fs::path data = SharedData();
  if (!fs::exists(data)) GTEST_SKIP() << "no real files at " << data;
  const Scenario shipped = LoadScenario(AQUAFARM_CORE_DIR "/../scenarios/zhoushan_infa_2021.yaml");
  RanchRequest request;
  request.center = GeoFrame(*shipped.origin, 1000.0).ToGeo(9.5, 6.5);
  request.width = 20;
  request.height = 14;
  request.cell_size_m = 1000.0;
  request.step_s = 480.0;
  request.start = shipped.start_time;
  request.track = (data / "tracks" / "CH2021BST.txt").string();
  request.storm = "IN-FA";
  request.radii = (data / "bulletins" / "202106.json").string();
  const DisasterSpec made = BuildRanch(request).scenario.disasters[0];
  int same = 0;
  for (const Waypoint& by_hand : shipped.disasters[0].track) {
    for (const Waypoint& by_command : made.track) {
      if (by_command.step != by_hand.step) continue;
      EXPECT_NEAR(by_command.x, by_hand.x, 0.02F) << "the origin is rounded";
      EXPECT_NEAR(by_command.y, by_hand.y, 0.02F);
      EXPECT_EQ(by_command.grade, by_hand.grade);
      // After the last bulletin the command estimates a gale ring, the hand wrote none.
      if (by_hand.radii.back() == 0.0F) continue;
      EXPECT_EQ(by_command.radii, by_hand.radii) << by_hand.step;
      ++same;
    }
  }
  EXPECT_EQ(same, 13);
}

}  // namespace
}  // namespace aquafarm
