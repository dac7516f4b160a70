// SPDX-License-Identifier: BSD-3-Clause
// Watches a folder for bulletins. Sends the track, forecast and rings of the storm in each bulletin
// to the ranch with set_disaster. The ranch converts them to a disaster.
#include <aquafarm_msgs/SetDisaster.h>
#include <ros/ros.h>

#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>

#include "aquafarm/base/check.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/fine_rings.h"
#include "aquafarm/tracks/reader.h"
#include "aquafarm_sim/checked_topics.h"
#include "aquafarm_sim/convert/conversions.h"
#include "aquafarm_sim/names.h"
#include "aquafarm_sim/node/bulletin_folder.h"
#include "aquafarm_sim/node_help.h"
#include "aquafarm_sim/params.h"

namespace aquafarm_sim {
namespace {

constexpr double kLookPeriod_s = 0.05;
constexpr std::chrono::seconds kEndLimit{
    2};  // max time from the shutdown of a connection to the end of its call

/// Thrown if the call of set_disaster fails or takes too long. The file is then sent again at the
/// next check of the folder.
class NoAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A service call. Send and the thread of the call share this object, because the thread may still
/// run after Send has returned.
struct Call {
  ros::ServiceClient client;
  aquafarm_msgs::SetDisaster message;
  std::promise<bool> answered;
};

struct BulletinParams {
  std::string folder;
  std::string storm;          // id or name of the storm; empty: the only storm of the file
  double period_s{1.0};       // time between checks of the folder
  double call_limit_s{10.0};  // max time to wait for the response of the ranch
  int id{0};                  // id of the disaster that the bulletins replace
  bool forecast_only{false};  // true: change only the forecast, not the track of the disaster
};

BulletinParams ReadParams() {
  BulletinParams params;
  Params reader{ros::NodeHandle("~")};
  reader.Text("folder", params.folder);
  reader.Text("storm", params.storm);
  reader.Number("period_s", 0.05, 3600.0, params.period_s);
  reader.Number("call_limit_s", 0.1, 600.0, params.call_limit_s);
  reader.Int("id", 0, 63, params.id);
  reader.Flag("forecast_only", params.forecast_only);
  reader.RefuseOthers();
  if (params.folder.empty()) {
    throw aquafarm::InputError("~folder: missing, expected the folder of the bulletins");
  }
  BulletinFolder(params.folder).New();  // throws if the folder does not exist
  return params;
}

class BulletinNode {
 public:
  explicit BulletinNode(const BulletinParams& params) : params_(params), folder_(params.folder) {}

  /// Sends the new and changed files of the folder.
  void Look() {
    try {
      for (const std::string& path : folder_.New()) {
        TrySend(path);
        folder_.Mark(path);
      }
      fault_.clear();
    } catch (const std::exception& error) {  // the folder or the ranch may become available again
      // Logs a repeated error once. ROS_ERROR_THROTTLE depends on /clock, which may stand still.
      if (fault_ != error.what()) ROS_ERROR("%s", error.what());
      fault_ = error.what();
    }
  }

 private:
  void TrySend(const std::string& path) {
    try {
      Send(path);
    } catch (const NoAnswer&) {
      throw;
    } catch (const std::exception& error) {
      ROS_ERROR("%s", error.what());
    }
  }

  void Send(const std::string& path) {
    const aquafarm::StormFile file = aquafarm::LoadStormFile(path);
    for (const std::string& warning : file.warnings) ROS_WARN("%s", warning.c_str());
    const aquafarm::StormTrack& storm = params_.storm.empty() && file.tracks.size() == 1
                                            ? file.tracks[0]
                                            : aquafarm::FindTrack(file, params_.storm);
    const std::string name = storm.name.empty() ? storm.id : storm.name;
    if (storm.fixes.front().time < 0) {
      throw aquafarm::InputError(path + ": " + name + ": got positions before 1970, expected " +
                                 "later ones, because ROS time begins in 1970");
    }
    const auto call = std::make_shared<Call>();
    call->message.request.farm = -1;
    call->message.request.id = params_.id;
    call->message.request.storm = ToMsg(storm);
    call->message.request.forecast_only = params_.forecast_only;
    // Only a persistent client has a connection that shutdown() can drop.
    call->client = node_.serviceClient<aquafarm_msgs::SetDisaster>(names::kSetDisaster, true);
    std::future<bool> answer = call->answered.get_future();
    std::thread([call] {
      call->answered.set_value(aquafarm_sim::Call(call->client, call->message));
    }).detach();
    const std::chrono::duration<double> limit(params_.call_limit_s);
    if (answer.wait_for(limit) != std::future_status::ready) {
      call->client.shutdown();
      answer.wait_for(kEndLimit);
    }
    if (answer.wait_for(std::chrono::seconds(0)) != std::future_status::ready || !answer.get()) {
      throw NoAnswer(path + ": the ranch did not answer; the file is sent again");
    }
    const auto& response = call->message.response;
    if (!response.ok) throw aquafarm::InputError(path + ": refused: " + response.message);
    Report(path, name, storm);
  }

  // Logs the id of the disaster and the times until which the storm is recorded and forecast.
  void Report(const std::string& path, const std::string& name,
              const aquafarm::StormTrack& storm) const {
    const aquafarm::StormTrack whole =
        aquafarm::WithForecast(storm, aquafarm::NoForecast::kPersist);
    const aquafarm::StormKnowledge known = aquafarm::KnowledgeOf(storm, whole);
    const std::int32_t held =
        aquafarm::ToFineRings(whole, aquafarm::RingReduction::kQuadrants, known.recorded_until)
            .held;
    if (held > 0) {
      ROS_WARN(
          "%s: stretches of the storm's track in which the wind cannot be interpolated: %d; they "
          "have the larger radii of both ends; send a bulletin with a wind at each point",
          path.c_str(), held);
    }
    const std::string id = std::to_string(params_.id);
    const std::string text =
        path + ": " + name +
        (params_.forecast_only ? " is the forecast of disaster " + id : " is now disaster " + id) +
        "; " + aquafarm::Describe(known);
    if (known.issued == 0) {
      ROS_WARN("%s", text.c_str());
    } else {
      ROS_INFO("%s", text.c_str());
    }
  }

  const BulletinParams params_;
  BulletinFolder folder_;
  std::string fault_;  // last reported error
  ros::NodeHandle node_;
};

int Run() {
  try {
    const ros::NodeHandle
        lives;  // ROS stops its logging permanently when the last handle is destroyed
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
  constexpr aquafarm_sim::NodeHelp kHelp{
      "aquafarm_sim", "bulletin_node",
      "Sends new and changed storm tracks of a folder into the running episode.", nullptr};
  if (aquafarm_sim::PrintHelpIfRequested(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "bulletins");
  return aquafarm_sim::Run();
}
