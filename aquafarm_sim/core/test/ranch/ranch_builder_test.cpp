// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/ranch/ranch_builder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "aquafarm/scenario/scenario_yaml.h"
#include "ranch_request.h"
#include "write_sea.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

TEST(Ranch, OfManyDevicesHasRoutesForNetworks) {
  RanchRequest request = Request();
  request.devices = 3;
  EXPECT_FALSE(BuildRanch(request).scenario.view.routes);
  request.devices = 12;
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(ranch.scenario.view.routes);
  // 24 x 20 cells; each device is waiting or delivered, or one of them is aboard.
  EXPECT_TRUE(Says(ranch.decided, "states: 13762560; slow to learn in a table"));
  EXPECT_NE(ranch.yaml.find("#   states: 13762560"), std::string::npos);
}

TEST(Ranch, TooLargeForWaysByWaterIsWhatItsFileSays) {
  RanchRequest request;
  request.width = request.height = 1100;
  request.devices = 12;
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_FALSE(ranch.scenario.view.routes);
  EXPECT_EQ(HashScenario(ranch.scenario), HashScenario(ParseScenario(ranch.yaml, request.name)));
}

TEST(Ranch, StandsOnTheChartWithPortsAtTheShore) {
  const BuiltRanch ranch = BuildRanch(Request());
  const Scenario& scenario = ranch.scenario;
  EXPECT_EQ(scenario.width, 24);
  EXPECT_EQ(scenario.cell_size_m, 500.0);
  EXPECT_EQ(scenario.ports.cells.size(), 4U);
  std::int32_t land = 0;
  for (const IslandBlock& block : scenario.islands) land += block.width * block.height;
  // 4.8 x 5.5 km with its lake filled, and a triangle of 0.5 km².
  EXPECT_NEAR(land * 0.25, 4.82 * 5.54 + 0.53, 3.0);
  EXPECT_TRUE(Says(ranch.decided, "island cells"));
  EXPECT_TRUE(Says(ranch.decided, "of enclosed water filled"));
  const std::string sketch = RenderAscii(scenario);
  EXPECT_EQ(sketch.size(), 20U * 25U);
  EXPECT_EQ(std::count(sketch.begin(), sketch.end(), 'P'), 4);
  EXPECT_EQ(std::count(sketch.begin(), sketch.end(), 'd'), 4);
  EXPECT_EQ(std::count(sketch.begin(), sketch.end(), '#'), land);
}

TEST(Ranch, PutsAPortAskedForAtTheNearestShore) {
  RanchRequest request = Request();
  request.port_places = {{30.025, 122.025}};  // in the lake
  const BuiltRanch ranch = BuildRanch(request);
  ASSERT_EQ(ranch.scenario.ports.cells.size(), 1U);
  EXPECT_TRUE(Says(ranch.decided, "port: given at (7, 8), put on the shore at ("));
}

TEST(Ranch, WarnsOfAPortOnLand) {
  RanchRequest request = Request();
  const BuiltRanch any = BuildRanch(request);
  const GeoFrame frame(*any.scenario.origin, any.scenario.cell_size_m);
  const std::string sketch = RenderAscii(any.scenario);  // north up
  const auto warnings = [&](char symbol) {
    const auto at = static_cast<std::int32_t>(sketch.find(symbol));
    const std::int32_t line = any.scenario.width + 1;
    request.port_places = {frame.ToGeo(at % line, any.scenario.height - 1 - at / line)};
    return BuildRanch(request).warnings;
  };
  EXPECT_TRUE(Says(warnings('#'), "which is land, expected water; it is put on the nearest shore"));
  EXPECT_FALSE(Says(warnings('.'), "port"));
}

TEST(Ranch, MayBeCalmAndOnOpenSea) {
  RanchRequest request;
  request.devices = 12;
  request.placement = DevicePlacement::kLinear;
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(ranch.scenario.disasters.empty());
  EXPECT_EQ(ranch.scenario.origin, std::nullopt);
  EXPECT_EQ(ranch.scenario.ports.count, 4);
  EXPECT_TRUE(Says(ranch.decided, "no shore, so 4 drawn at the edge"));
}

TEST(Ranch, HasOtherDisastersInAdditionToItsStorm) {
  RanchRequest request = Request();
  request.disasters = {"red_tide:area_km2=120,current_mps=0.3,current_to_deg=45",
                       "wave:height_m=4,radius_km=5,duration_h=48"};
  const BuiltRanch ranch = BuildRanch(request);
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
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_EQ(ranch.scenario.width, 4);
  EXPECT_EQ(ranch.scenario.cell_size_m, 150.0);
  EXPECT_EQ(RenderAscii(ranch.scenario)[5 + 1], '#');
  request.start = kMidnight;
  EXPECT_EQ(BuildRanch(request).scenario.start_time, kMidnight) << "without a storm";
  fs::remove(path);
}

TEST(Ranch, IsRefusedWithTheReason) {
  RanchRequest request = Request();
  request.center.reset();
  EXPECT_EQ(Refused(request),
            "center: got none, expected the position of the ranch, which storms and ports require");
  request.track.clear();
  EXPECT_EQ(Refused(request), "center: got none, expected the position of the ranch on the chart");
  request = Request();
  request.storm = "Rai";
  EXPECT_EQ(Refused(request).substr(0, 37), "storm: got 'Rai', expected one of: 71");
  request = Request();
  request.start = kMidnight + 24 * kHour_s;
  EXPECT_EQ(Refused(request),
            "start: got 2021-07-26T00:00:00Z, expected a time before 2021-07-25T06:00:00Z, until "
            "when the storm is known");
  request = Request();
  request.center = GeoPoint{30.01, 122.01};
  request.width = request.height = 3;
  EXPECT_EQ(Refused(request),
            request.chart + ": got a chart without water, expected at least one water cell");
  request = Request();
  request.devices = 1000;
  EXPECT_NE(Refused(request).find("devices"), std::string::npos);
}

TEST(Ranch, RecognisesItsChartByItsContent) {
  const fs::path folder = fs::temp_directory_path() / ("charts." + std::to_string(getpid()));
  fs::create_directories(folder);
  RanchRequest request = Request();
  request.track.clear();
  request.storm.clear();
  const auto with = [&](const fs::path& sample, const std::string& name) {
    fs::copy_file(sample, folder / name, fs::copy_options::overwrite_existing);
    request.chart = (folder / name).string();
    return Refused(request).substr(Refused(request).find(request.chart) == 0 ? request.chart.size()
                                                                             : 0);
  };
  const std::string expected =
      ", expected a chart: a coast as GeoJSON, a map of map_server (its YAML) or an ASCII grid of "
      "heights";
  EXPECT_EQ(with(kData / "coast.json", "coast.txt"), "was made");
  EXPECT_EQ(with(kData / "cma.txt", "cma.json"),
            ":1: got tracks of storms (CMA best track)" + expected);
  EXPECT_EQ(with(kData / "anchorage.json", "a.json"), ":1: got anchorage forecasts" + expected);
  EXPECT_EQ(with(kData / "chart.png", "chart.png"), ":1: got a PNG picture" + expected);
  EXPECT_EQ(with(kData / "chart.bmp", "chart.bmp"), ":1: got a BMP picture" + expected);
  std::ofstream(folder / "sea.nc") << "CDF\1";
  EXPECT_EQ(with(folder / "sea.nc", "sea.asc"), ":1: got a netCDF file" + expected);
  std::ofstream(folder / "words") << "\nsome words";
  EXPECT_EQ(with(folder / "words", "words.txt"), ":1: got 'some words'" + expected);
  EXPECT_EQ(with(folder / "words", "words.json").substr(0, 21), ":2: invalid JSON: las");
  std::ofstream(folder / "turned.yaml") << "image: " << (kData / "chart.pgm").string()
                                        << "\nresolution: 10\norigin: [0, 0, 1.5]\nnegate: 0\n"
                                           "occupied_thresh: 0.65\nfree_thresh: 0.2\n";
  EXPECT_EQ(with(folder / "turned.yaml", "turned.map"),
            ": origin[2]: got a yaw of 1.5, expected 0: a ranch's grid points north");
  fs::remove_all(folder);
}

TEST(Ranch, SaysTheNoticesInForce) {
  RanchRequest request = Request();
  request.notices = (kData / "anchorage.json").string();
  EXPECT_TRUE(Says(BuildRanch(request).decided, "notices: 2 more, not in force"));
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
  // 89 steps of 243 s from midnight end at 06:00, after which the storm is not known.
  EXPECT_TRUE(Says(warn("2021-07-25T06:00+00:00", "2021-07-26T12:00+00:00"), "notice: gale of x"));
  EXPECT_TRUE(Says(warn("2021-07-25T06:01+00:00", "2021-07-26T12:00+00:00"),
                   "notices: 1 more, not in force"));
  EXPECT_TRUE(Says(warn("2021-07-26T12:45+00:00", "2021-07-27T12:00+00:00"),
                   "notices: 1 more, not in force"));
  request.disasters = {"wave:height_m=4,radius_km=5,duration_h=48"};
  EXPECT_TRUE(Says(warn("2021-07-26T12:45+00:00", "2021-07-27T12:00+00:00"), "notice: gale of x"));
  fs::remove(path);
}

TEST(Ranch, KeepsASeaOfSmallNumbersAndRulesByWhatItWrites) {
  const fs::path path = fs::temp_directory_path() / ("small." + std::to_string(getpid()) + ".nc");
  WriteSea(path.string(), "chl", {29.0, 31.0}, {121.0, 123.0}, {1e-5F, 1e-5F, 1e-5F, 1e-5F});
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

}  // namespace
}  // namespace aquafarm
