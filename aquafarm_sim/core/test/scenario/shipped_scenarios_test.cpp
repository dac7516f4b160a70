// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "aquafarm/farm/farm.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/scenario/damage_defaults.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(AQUAFARM_CORE_DIR).parent_path() / "scenarios";

std::vector<std::string> ShippedNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scenario Load(const std::string& name) {
  return LoadScenario((kFolder / (name + ".yaml")).string());
}

TEST(Shipped, AreThese) {
  EXPECT_EQ(ShippedNames(), (std::vector<std::string>{
                                "four_squads", "networked_devices", "paper", "paper_partial",
                                "paper_plain", "partial", "procedural", "red_tide", "smart_devices",
                                "truncated", "two_squads", "zhoushan_danas_2019",
                                "zhoushan_infa_2021", "zhoushan_mitag_2019", "zhoushan_storms"}));
}

TEST(Shipped, RealRanchesAloneHaveTheirDamageByKinds) {
  for (const std::string& name : ShippedNames()) {
    const bool real = name.find("zhoushan") == 0;
    EXPECT_EQ(Load(name).damage.kinds, real ? kRealDamage : kEqualDamage) << name;
  }
}

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, IsNamedAsItsFileAndSaysWhatItIs) {
  const Scenario scenario = Load(GetParam());
  EXPECT_EQ(scenario.name, GetParam());
  EXPECT_GT(scenario.description.size(), 20U);
}

TEST_P(Shipped, WritesTextThatReadsBackTheSame) {
  const Scenario scenario = Load(GetParam());
  const std::string text = ToYaml(scenario);
  const Scenario back = ParseScenario(text, "again");
  EXPECT_EQ(ToYaml(back), text);
  EXPECT_EQ(back.hash, scenario.hash);
  EXPECT_NE(scenario.hash, 0U);
}

TEST_P(Shipped, PlaysToAnEnd) {
  const auto scenario = std::make_shared<const Scenario>(Load(GetParam()));
  Farm farm(scenario);
  RandomStream rng({1, 0, RngStream::kExploration, 0});
  std::vector<std::uint8_t> actions(static_cast<std::size_t>(scenario->AgentCount()));
  for (std::uint64_t episode = 0; episode < 3; ++episode) {
    farm.Reset(1, episode);
    while (!farm.over()) {
      for (std::uint8_t& action : actions) {
        action = static_cast<std::uint8_t>(rng.Below(kActionCount));
      }
      farm.Step(actions.data());
    }
    EXPECT_LE(farm.step(), scenario->step_limit);
    EXPECT_GT(farm.step(), 50);
  }
}

TEST_P(Shipped, HasALayoutThatAFarmCanTakeInEveryEpisode) {
  const Scenario scenario = Load(GetParam());
  LayoutGenerator generator(scenario);
  Layout layout;
  for (std::uint64_t episode = 0; episode < 1000; ++episode) {
    ASSERT_NO_THROW(generator.Generate(1, episode, layout)) << "seed 1, episode " << episode;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Shipped, testing::ValuesIn(ShippedNames()),
                         [](const auto& test) { return test.param; });

TEST(Truncated, IsTruncatedBeforeItsDisasterEnds) {
  const auto scenario = std::make_shared<const Scenario>(Load("truncated"));
  Farm farm(scenario);
  const std::uint8_t stay = static_cast<std::uint8_t>(Action::kDropOff);
  farm.Reset(1, 0);
  while (!farm.over()) farm.Step(&stay);
  EXPECT_EQ(farm.reason(), EndReason::kStepLimit);
  EXPECT_EQ(farm.step(), 150);
  EXPECT_TRUE(farm.disasters()[0].active());
}

// Both scenarios have the same episodes, so that one clairvoyant optimum applies to both.
TEST(PaperPlain, DiffersFromPaperInItsViewAlone) {
  Scenario plain = Load("paper_plain");
  const Scenario paper = Load("paper");
  EXPECT_FALSE(plain.view.routes);
  EXPECT_FALSE(plain.view.lookahead_risk);
  plain.view = paper.view;
  plain.name = paper.name;
  plain.description = paper.description;
  EXPECT_EQ(ToYaml(plain), ToYaml(paper));
}

TEST(Paper, IsTheFarmOfThePaper) {
  const Scenario scenario = Load("paper");
  EXPECT_EQ(scenario.width, 25);
  EXPECT_EQ(scenario.height, 25);
  EXPECT_EQ(scenario.devices.Total(), 3);
  EXPECT_EQ(scenario.ports.count, 4);
  EXPECT_EQ(scenario.layout, LayoutMode::kFixed);
  EXPECT_EQ(scenario.view.mode, ViewMode::kFull);
  EXPECT_EQ(scenario.damage.exposure_damage, 0.0F);
  EXPECT_EQ(scenario.step_limit, 5000);
  ASSERT_EQ(scenario.disasters.size(), 1U);
  EXPECT_EQ(scenario.disasters[0].start, std::nullopt);
}

struct BestTrackPoint {
  std::string time;  // YYYYMMDDHH, UTC
  int grade{};
  double latitude{};
  double longitude{};
};

std::vector<BestTrackPoint> BestTrackOfInFa() {
  std::ifstream file(SharedData() / "tracks" / "CH2021BST.txt");
  std::vector<BestTrackPoint> points;
  std::string line;
  bool wanted = false;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "66666") {
      wanted = line.find("In-fa") != std::string::npos;
    } else if (wanted) {
      BestTrackPoint point{first, 0, 0.0, 0.0};
      words >> point.grade >> point.latitude >> point.longitude;
      point.latitude /= 10.0;
      point.longitude /= 10.0;
      points.push_back(point);
    }
  }
  return points;
}

TEST(InFa, FollowsTheBestTrack) {
  const std::vector<BestTrackPoint> all = BestTrackOfInFa();
  if (all.empty()) GTEST_SKIP() << "no best track at " << SharedData();
  std::vector<BestTrackPoint> points;
  std::copy_if(all.begin(), all.end(), std::back_inserter(points), [](const BestTrackPoint& point) {
    return point.time >= "2021072400" && point.time <= "2021072606";
  });
  const Scenario scenario = Load("zhoushan_infa_2021");
  const std::vector<Waypoint>& track = scenario.disasters[0].track;
  ASSERT_EQ(track.size(), points.size());
  const GeoFrame frame(*scenario.origin, scenario.cell_size_m);
  for (std::size_t i = 0; i < track.size(); ++i) {
    SCOPED_TRACE(points[i].time);
    const GeoPoint point{points[i].latitude, points[i].longitude};
    EXPECT_NEAR(track[i].x, frame.ToGrid(point)[0], 1e-3);
    EXPECT_NEAR(track[i].y, frame.ToGrid(point)[1], 1e-3);
    EXPECT_EQ(track[i].grade, points[i].grade - 1) << "TS, STS, TY as 1, 2, 3";
    const int day = std::stoi(points[i].time.substr(6, 2));
    const int hour = std::stoi(points[i].time.substr(8, 2));
    EXPECT_FLOAT_EQ(track[i].step, static_cast<float>((day - 24) * 24 + hour - 12) * 7.5F);
  }
}

// Verifies the comments in the scenario file.
TEST(InFa, BringsItsRingsOverTheRanchWhenTheFileSays) {
  const auto scenario = std::make_shared<const Scenario>(Load("zhoushan_infa_2021"));
  Farm farm(scenario);
  farm.Reset(1, 0);
  std::vector<std::pair<std::int32_t, float>> changes;
  float risk = 0.0F;
  float nearest = 1.0e6F;
  const auto hold = static_cast<std::uint8_t>(Action::kHold);
  while (!farm.over()) {
    farm.Step(&hold);
    const Disaster& storm = farm.disasters()[0];
    nearest = std::min(nearest, std::hypot(storm.x - 9.0F, storm.y - 7.0F));
    const float now = RiskAt(farm.disasters(), {9, 7});
    if (now != risk) changes.emplace_back(farm.step(), now);
    risk = now;
  }
  const std::vector<std::pair<std::int32_t, float>> expected{
      {21, -5.0F}, {79, -10.0F}, {104, -20.0F}, {129, -10.0F}, {202, -5.0F}, {277, 0.0F}};
  EXPECT_EQ(changes, expected);
  EXPECT_NEAR(nearest, 29.0F, 0.5F);
  EXPECT_EQ(farm.reason(), EndReason::kDisasterEnded);
  EXPECT_EQ(farm.step(), 315);
}

// Returns the worst risk in the middle of a ranch during the passage of its storm.
float WorstInTheMiddle(const std::string& name) {
  const auto scenario = std::make_shared<const Scenario>(Load(name));
  Farm farm(scenario);
  farm.Reset(1, 0);
  float worst = 0.0F;
  const auto hold = static_cast<std::uint8_t>(Action::kHold);
  while (!farm.over()) {
    farm.Step(&hold);
    worst = std::min(worst, RiskAt(farm.disasters(), {scenario->width / 2, scenario->height / 2}));
  }
  return worst;
}

TEST(Storms, AreAsBadAsTheyWere) {
  EXPECT_EQ(WorstInTheMiddle("zhoushan_danas_2019"), -5.0F) << "no 50 kt at all";
  EXPECT_LE(WorstInTheMiddle("zhoushan_mitag_2019"), -9.0F) << "50 kt pass over it";
  EXPECT_EQ(WorstInTheMiddle("zhoushan_infa_2021"), -20.0F);
}

}  // namespace
}  // namespace aquafarm
