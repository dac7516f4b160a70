// SPDX-License-Identifier: BSD-3-Clause
// Ranches built from published files: from excerpts, which every clone has, and from whole files. A
// test whose whole files are missing is skipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "ranch_request.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

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
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(ranch.warnings.empty());
  EXPECT_TRUE(Says(ranch.decided, "nearest: 32 km at 2021-07-25T03:30:00Z")) << ranch.yaml;
  EXPECT_TRUE(Says(ranch.decided, "strongest ring 64 kt"));
}

TEST(RealExcerpts, GiveDevicesTheirValueFromTheSea) {
  RanchRequest request;
  request.center = GeoPoint{24.8, 57.9};
  request.cell_size_m = 2000.0;
  const std::string file = (kData / "real" / "hycom_oman_2016.nc").string();
  request.sea = {{"salt", file, "so"}, {"warmth", file, "thetao"}};
  request.value = "warmth > 26 ? 80 : 40 + salt";
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(Says(ranch.decided, "salt: so of hycom_oman_2016.nc at 2016-04-28T"));
  ASSERT_EQ(ranch.scenario.devices.sites.size(), 4U);
  for (const DeviceSite& site : ranch.scenario.devices.sites) {
    EXPECT_TRUE(*site.value == 80.0F || (*site.value > 75.0F && *site.value < 79.0F));
  }
  request.value = "-salt";
  EXPECT_NE(Refused(request).find("expected a number in [0, 10000]"), std::string::npos);
  request.value = "salty";
  EXPECT_NE(Refused(request).find("expected an expression"), std::string::npos);
  request.center = GeoPoint{30.0, 122.0};
  EXPECT_NE(Refused(request).find("expected an area with the ranch at"), std::string::npos);
}

// Every clone has this chart and this track. The track has the rings of its own agency.
TEST(RealExcerpts, OfJmaMakeARanch) {
  RanchRequest request = Request();
  request.track = (kData / "real" / "jma_in_fa_2021.txt").string();
  const BuiltRanch ranch = BuildRanch(request);
  EXPECT_TRUE(Says(ranch.decided, "nearest: 9 km at 2021-07-25T12:10:00Z")) << ranch.yaml;
  EXPECT_EQ(ranch.scenario.disasters.size(), 1U);
  EXPECT_GT(ranch.scenario.disasters[0].track.size(), 2U);
}

// The bulletins of the archive contain no forecasts; the storm continues its motion.
TEST(RealFiles, OfBulletinsHaveNoForecasts) {
  const fs::path data = SharedData();
  if (!fs::exists(data)) GTEST_SKIP() << "no real files at " << data;
  RanchRequest request;
  request.center = GeoPoint{30.2, 122.7};
  request.track = (data / "tracks" / "CH2021BST.txt").string();
  request.storm = "IN-FA";
  request.forecasts = (data / "bulletins" / "202106.json").string();
  EXPECT_EQ(Refused(request),
            "forecasts: got no forecast points of the storm between 2021-07-24T09:00:00Z and "
            "2021-07-26T13:00:00Z in "
            "202106.json, expected bulletins with forecast points");
}

// Returns a scenario without the waypoints of its first storm that are between those of another
// scenario. The shipped files were made before the command wrote waypoints between those of the
// track.
Scenario AtStepsOf(const Scenario& other, Scenario scenario) {
  std::vector<Waypoint>& track = scenario.disasters[0].track;
  const std::vector<Waypoint>& steps = other.disasters[0].track;
  track.erase(std::remove_if(track.begin(), track.end(),
                             [&steps](const Waypoint& one) {
                               return std::none_of(
                                   steps.begin(), steps.end(),
                                   [&one](const Waypoint& at) { return at.step == one.step; });
                             }),
              track.end());
  return scenario;
}

// People may edit scenario files; the parts that determine an episode still match the command's
// result.
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
  // The command writes no insured values and prices, which change no episode.
  const auto expect_made = [&](const char* name) {
    Scenario scenario = LoadScenario((shipped / name).string());
    scenario.money.reset();
    const Scenario made = BuildRanch(request).scenario;
    EXPECT_GT(made.disasters[0].track.size(), scenario.disasters[0].track.size()) << name;
    EXPECT_GE(AtStepsOf(scenario, made).disasters[0].track.size(),
              scenario.disasters[0].track.size() - 1)
        << name;
    EXPECT_EQ(HashScenario(AtStepsOf(scenario, made)), HashScenario(AtStepsOf(made, scenario)))
        << name;
  };
  expect_made("zhoushan_danas_2019.yaml");
  request.storm = "MITAG";
  request.devices = 6;
  request.placement = DevicePlacement::kLinear;
  expect_made("zhoushan_mitag_2019.yaml");
}

// The file was written by hand, with islands as blocks of cells; its storm equals the command's.
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
      // After the last bulletin the command estimates a gale ring; the file has none there.
      if (by_hand.radii.back() == 0.0F) continue;
      EXPECT_EQ(by_command.radii, by_hand.radii) << by_hand.step;
      ++same;
    }
  }
  EXPECT_EQ(same, 13);
}

}  // namespace
}  // namespace aquafarm
