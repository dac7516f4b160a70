// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/plan/plan_keeper.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_agents/plan/plan_markers.h"
#include "aquafarm_sim/plan_words.h"

namespace aquafarm_agents {
namespace {

namespace fs = std::filesystem;
using aquafarm_msgs::RescuePlan;

// A bulletin of a typhoon that reaches the ranch off Zhoushan a day later.
std::string Bulletin(const std::string& name, double latitude) {
  const auto point = [](const std::string& time, double lat, const std::string& more) {
    return "{\"time\": \"" + time + "\", \"lat\": " + std::to_string(lat) +
           R"x(, "lng": 122.7, "strong": "台风(TY)", "speed": 38, "radius7": 250, )x" +
           R"x("radius10": 100, "radius12": 40)x" + more + "}";
  };
  const std::string ahead =
      R"x(, "move_dir": "北", "move_speed": 10, "forecast": [{"sets": "CMA", "points": [)x" +
      point("2021-07-25T08:00:00", latitude + 2.0, "") + ", " +
      point("2021-07-26T08:00:00", latitude + 4.0, "") + "]}]";
  return R"x([{"tfbh": "202106", "ename": ")x" + name + R"x(", "points": [)x" +
         point("2021-07-24T08:00:00", latitude, ahead) + "]}]";
}

class Keeper : public ::testing::Test {
 protected:
  Keeper() : folder_(fs::temp_directory_path() / ("plan_keeper_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    inputs_.scenario = std::make_shared<const aquafarm::Scenario>(
        aquafarm::LoadScenario(AQUAFARM_SCENARIO_DIR "/zhoushan_infa_2021.yaml"));
    inputs_.request.members = 50;
    inputs_.request.speed_kn = 12.0;
    inputs_.request.ships = 2;
    inputs_.request.at = aquafarm::ParseUtc("at", "2021-07-24T00:00:00Z");
  }
  ~Keeper() override { fs::remove_all(folder_); }

  std::string Put(const std::string& name, const std::string& text, int age_s = 0) {
    const fs::path path = folder_ / name;
    std::ofstream(path) << text;
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::seconds(age_s));
    return path.string();
  }
  // Updates the keeper with the files of the folder.
  const RescuePlan& Update() {
    inputs_.bulletins = NewestFiles(folder_.string());
    keeper_.Update(inputs_);
    return keeper_.plan().plan;
  }

  fs::path folder_;
  PlanInputs inputs_;
  PlanKeeper keeper_;
};

TEST_F(Keeper, FilesAreNewestFirstWithoutIncompleteOnes) {
  Put("old.json", "1", 100);
  const std::string newest = Put("new.json", "22", 1);
  Put(".hidden", "3");
  Put("half.json.part", "4");
  const auto files = NewestFiles(folder_.string());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].path, newest);
  const std::string stamp = files[0].stamp;
  Put("new.json", "222", 1);
  EXPECT_NE(StampOf(newest).stamp, stamp);
  EXPECT_EQ(StampOf(folder_ / "none").stamp, "");
  EXPECT_EQ(NewestFiles(newest).size(), 1U);
  try {
    NewestFiles("/nowhere");
    FAIL();
  } catch (const aquafarm::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "/nowhere: got No such file or directory, expected a bulletin or a folder of "
                 "bulletins");
  }
}

TEST_F(Keeper, WithoutABulletinThereIsNoPlanAndAReason) {
  inputs_.fault = "bulletins: no bulletin yet";
  const RescuePlan& plan = Update();
  EXPECT_EQ(plan.result, RescuePlan::NONE);
  EXPECT_EQ(plan.fault, "bulletins: no bulletin yet");
  EXPECT_FALSE(keeper_.Update(inputs_)) << "nothing new";
}

TEST_F(Keeper, ANewBulletinMakesANewPlan) {
  Put("1.json", Bulletin("First", 28.0), 60);
  EXPECT_EQ(Update().storm_name, "First");
  EXPECT_EQ(keeper_.plan().plan.fault, "");
  EXPECT_EQ(keeper_.plan().plan.result, RescuePlan::PLAN) << keeper_.plan().plan.text;
  const std::string newer = Put("2.json", Bulletin("First", 28.2), 0);
  EXPECT_NE(newer.find(Update().storm_file), std::string::npos);
  EXPECT_NE(keeper_.plan().plan.storm_file.find("2.json"), std::string::npos);
  EXPECT_EQ(keeper_.plan().plan.fault, "");
  EXPECT_FALSE(keeper_.Update(inputs_)) << "nothing new";
  inputs_.refresh = 1;
  EXPECT_TRUE(keeper_.Update(inputs_)) << "time has passed";
}

TEST_F(Keeper, ABadBulletinLeavesTheOneBeforeInUseAndIsNamed) {
  Put("1.json", Bulletin("First", 28.0), 60);
  Update();
  const std::string bad = Put("2.json", "[{\"tfbh\": \"202106\", \"points\": [", 30);
  const RescuePlan& plan = Update();
  EXPECT_EQ(plan.storm_name, "First");
  EXPECT_EQ(plan.result, RescuePlan::PLAN);
  EXPECT_EQ(plan.fault.find(bad), 0U) << plan.fault;
  EXPECT_NE(plan.fault.find("this plan uses " + (folder_ / "1.json").string()), std::string::npos)
      << plan.fault;
  EXPECT_EQ(plan.fault.find('\n'), std::string::npos);
  Put("3.json", Bulletin("First", 28.0), 0);
  EXPECT_EQ(Update().fault, "");
  EXPECT_NE(keeper_.plan().plan.storm_file.find("3.json"), std::string::npos);
}

TEST_F(Keeper, ABulletinOfAnotherStormDoesNotHideTheOneThatComes) {
  Put("1.json", Bulletin("First", 28.0), 60);
  Update();
  const std::string other = Put("2.json", Bulletin("Far", 5.0), 0);
  const RescuePlan& plan = Update();
  EXPECT_EQ(plan.storm_name, "First");
  EXPECT_EQ(plan.result, RescuePlan::PLAN);
  EXPECT_EQ(plan.fault.find(other + ": got a bulletin of 'Far', expected 'First'"), 0U)
      << plan.fault;
}

TEST_F(Keeper, AtTheStartTheNewestFileThatCanBeReadIsUsed) {
  Put("1.json", Bulletin("First", 28.0), 60);
  const std::string bad = Put("2.json", "no bulletin", 0);
  const RescuePlan& plan = Update();
  EXPECT_EQ(plan.result, RescuePlan::PLAN);
  EXPECT_EQ(plan.fault.find(bad), 0U) << plan.fault;
}

TEST_F(Keeper, ABadFirstBulletinGivesNoPlanAndAReason) {
  Put("1.json", "no bulletin");
  EXPECT_EQ(Update().result, RescuePlan::NONE);
  EXPECT_NE(keeper_.plan().plan.fault.find("1.json"), std::string::npos);
}

TEST_F(Keeper, ABulletinThatIsTooOldIsAWarningAndThenAFault) {
  Put("1.json", Bulletin("First", 28.0));
  inputs_.request.at = aquafarm::ParseUtc("at", "2021-07-24T14:00:00Z");
  const RescuePlan& plan = Update();
  ASSERT_FALSE(plan.warnings.empty());
  EXPECT_TRUE(std::any_of(plan.warnings.begin(), plan.warnings.end(), [](const auto& one) {
    return one.code == "bulletin_old" && one.severity == "stop";
  }));
  EXPECT_NEAR(plan.age_h, 14.0, 0.01);
  inputs_.request.at = aquafarm::ParseUtc("at", "2021-07-28T00:00:00Z");
  EXPECT_NE(Update().fault.find("get a newer bulletin"), std::string::npos)
      << keeper_.plan().plan.fault;
  EXPECT_EQ(keeper_.plan().plan.storm_name, "First");
  EXPECT_NE(keeper_.plan().plan.fault.find("this plan is an earlier one"), std::string::npos);
}

TEST_F(Keeper, AFaultOfTheRanchIsAddedWithoutPlanningAgain) {
  Put("1.json", Bulletin("First", 28.0));
  const ros::Time before = Update().computed_at;
  inputs_.fault = "/aquafarm/state: the ranch is gone";
  EXPECT_TRUE(keeper_.Update(inputs_));
  EXPECT_EQ(keeper_.plan().plan.fault, "/aquafarm/state: the ranch is gone");
  EXPECT_EQ(keeper_.plan().plan.computed_at, before);
  inputs_.fault.clear();
  EXPECT_TRUE(keeper_.Update(inputs_));
  EXPECT_EQ(keeper_.plan().plan.fault, "");
}

TEST_F(Keeper, AStepOfTheRanchPlansAgainFromItsShips) {
  Put("1.json", Bulletin("First", 28.0));
  aquafarm::agents::FleetState fleet;
  fleet.devices.resize(4);
  fleet.ships = {{{10, 5}, {}}};
  inputs_.fleet = fleet;
  inputs_.step = 7;
  EXPECT_EQ(Update().ships.at(0).cell.x, 10);
  EXPECT_TRUE(keeper_.plan().plan.follows_ranch);
  EXPECT_EQ(keeper_.plan().plan.step, 7U);
  inputs_.fleet->ships[0].cell = {11, 5};
  inputs_.step = 8;
  EXPECT_EQ(Update().ships.at(0).cell.x, 11);
  for (auto& device : inputs_.fleet->devices) device.is_deployed = false;
  inputs_.fleet->devices[0].self_propelled = true;
  inputs_.step = 9;
  EXPECT_EQ(Update().text, "Every device is in port: there is nothing left to fetch.");
  EXPECT_EQ(keeper_.plan().plan.result, RescuePlan::PLAN);
}

TEST_F(Keeper, MarkersShowRoutesConeAndOdds) {
  Put("1.json", Bulletin("First", 28.0));
  RescuePlan plan = Update();
  plan.header.frame_id = "map";
  std::map<std::string, int> count;
  for (const auto& marker : PlanMarkers(plan).markers) {
    EXPECT_EQ(marker.header.frame_id, "map");
    if (marker.action == visualization_msgs::Marker::DELETEALL) {
      EXPECT_TRUE(count.empty()) << "what comes before it is deleted";
      ++count["clear"];
    } else {
      ++count[marker.ns];
      EXPECT_EQ(marker.color.a > 0.0F, true);
    }
    if (marker.ns == "plan_device") {
      const auto& device = plan.devices.at(static_cast<std::size_t>(marker.id));
      EXPECT_EQ(marker.text.find(device.name), 0U);
      EXPECT_EQ(marker.text.find(aquafarm_sim::PercentText(device.home)) != std::string::npos,
                device.ship >= 0)
          << marker.text;
      EXPECT_EQ(marker.pose.position.x, device.cell.x * plan.cell_size_m);
    }
    if (marker.ns == "plan_cone") {
      const auto& spread = plan.forecast_error.at(static_cast<std::size_t>(marker.id));
      for (const auto& point : marker.points) {
        EXPECT_NEAR(std::hypot(point.x - spread.x * plan.cell_size_m,
                               point.y - spread.y * plan.cell_size_m),
                    1000.0 * static_cast<double>(spread.radius70_km), 1.0);
      }
    }
  }
  EXPECT_EQ(count["clear"], 1);
  EXPECT_EQ(count["plan_route"], static_cast<int>(plan.routes.size()));
  EXPECT_GE(count["plan_route"], 1);
  EXPECT_EQ(count["plan_device"], 4);
  EXPECT_EQ(count["plan_ship"], 2);
  EXPECT_EQ(count["plan_port"], 3);
  EXPECT_EQ(count["plan_cone"], static_cast<int>(plan.forecast_error.size()));
  EXPECT_EQ(count["plan_outcome"], 1);
  EXPECT_EQ(PlanMarkers(RescuePlan()).markers.size(), 1U) << "without a plan";
}

}  // namespace
}  // namespace aquafarm_agents
