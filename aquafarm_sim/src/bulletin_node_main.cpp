// SPDX-License-Identifier: BSD-3-Clause
// Watches a folder for bulletins and tells the ranch of each: a storm's track, forecast and rings
// become a disaster of the running episode through set_disaster.
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/SetDisaster.h>
#include <ros/ros.h>

#include <chrono>
#include <future>
#include <optional>

#include "aquafarm/hazard_disaster.h"
#include "aquafarm/hazard_file.h"
#include "aquafarm/scenario_yaml.h"
#include "aquafarm_sim/bulletin_folder.h"
#include "aquafarm_sim/conversions.h"
#include "aquafarm_sim/names.h"
#include "aquafarm_sim/params.h"

namespace aquafarm_sim {
namespace {

constexpr double kLookPeriod_s = 0.05;
constexpr std::chrono::seconds kCallLimit{10};

struct BulletinParams {
  std::string folder;
  std::string storm;     // empty: the file's only one
  double period_s{1.0};  // between looks at the folder
  int id{0};             // of the disaster that the bulletins replace
};

BulletinParams ReadParams() {
  BulletinParams params;
  Params reader{ros::NodeHandle("~")};
  reader.Text("folder", params.folder);
  reader.Text("storm", params.storm);
  reader.Number("period_s", 0.05, 3600.0, params.period_s);
  reader.Int("id", 0, 63, params.id);
  reader.RefuseOthers();
  if (params.folder.empty()) {
    throw aquafarm::InputError("~folder: missing, expected the folder of the bulletins");
  }
  BulletinFolder(params.folder).TakeNew();  // refuses a folder that is not there
  return params;
}

class BulletinNode {
 public:
  explicit BulletinNode(const BulletinParams& params) : params_(params), folder_(params.folder) {
    spec_ = node_.subscribe<aquafarm_msgs::FarmSpec>(
        names::kSpec, 1, [this](const aquafarm_msgs::FarmSpec::ConstPtr& message) {
          try {
            scenario_ = aquafarm::ParseScenario(message->scenario_yaml, "spec");
          } catch (const aquafarm::InputError& error) {
            ROS_ERROR("%s", error.what());
          }
        });
    state_ = node_.subscribe<aquafarm_msgs::FarmState>(
        names::kState, 1, [this](const aquafarm_msgs::FarmState::ConstPtr& message) {
          step_ = static_cast<std::int32_t>(message->step);
        });
  }

  /// Sends what is new in the folder, once the ranch is known.
  void Look() {
    if (!scenario_) return;
    try {
      for (const std::string& path : folder_.TakeNew()) TrySend(path);
    } catch (const aquafarm::InputError& error) {  // the folder may come back
      ROS_ERROR_THROTTLE(10.0, "%s", error.what());
    }
  }

 private:
  void TrySend(const std::string& path) {
    try {
      Send(path);
    } catch (const aquafarm::InputError& error) {
      ROS_ERROR("%s", error.what());
    }
  }

  void Send(const std::string& path) {
    const aquafarm::HazardFile file = aquafarm::LoadHazardFile(path);
    for (const std::string& warning : file.warnings) ROS_WARN("%s", warning.c_str());
    const aquafarm::HazardTrack& storm = params_.storm.empty() && file.tracks.size() == 1
                                             ? file.tracks[0]
                                             : aquafarm::FindTrack(file, params_.storm);
    aquafarm_msgs::SetDisaster call;
    call.request.farm = -1;
    call.request.id = params_.id;
    call.request.info = ToMsg(aquafarm::ToDisaster(storm, *scenario_, step_));
    ros::ServiceClient client =
        node_.serviceClient<aquafarm_msgs::SetDisaster>(names::kSetDisaster);
    std::future<bool> answer =
        std::async(std::launch::async, [&client, &call] { return client.call(call); });
    if (answer.wait_for(kCallLimit) != std::future_status::ready) client.shutdown();
    if (!answer.get()) throw aquafarm::InputError(path + ": the ranch did not answer");
    if (!call.response.ok) throw aquafarm::InputError(path + ": refused: " + call.response.message);
    ROS_INFO("%s: %s is now disaster %d", path.c_str(),
             (storm.name.empty() ? storm.id : storm.name).c_str(), params_.id);
  }

  const BulletinParams params_;
  BulletinFolder folder_;
  ros::NodeHandle node_;
  ros::Subscriber spec_;
  ros::Subscriber state_;
  std::optional<aquafarm::Scenario> scenario_;
  std::int32_t step_{};
};

int Run() {
  try {
    const BulletinParams params = ReadParams();
    BulletinNode node(params);
    ros::WallTime next = ros::WallTime::now();
    while (ros::ok()) {
      ros::spinOnce();
      if (ros::WallTime::now() >= next) {
        node.Look();
        next = ros::WallTime::now() + ros::WallDuration(params.period_s);
      }
      ros::WallDuration(kLookPeriod_s).sleep();
    }
    return 0;
  } catch (const aquafarm::InputError& error) {
    std::fprintf(stderr, "bulletin_node: %s\n", error.what());
    return 2;
  }
}

}  // namespace
}  // namespace aquafarm_sim

int main(int argc, char** argv) {
  ros::init(argc, argv, "bulletins");
  return aquafarm_sim::Run();
}
