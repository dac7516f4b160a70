// SPDX-License-Identifier: BSD-3-Clause
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/RescuePlan.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <std_msgs/Time.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/mutex.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_agents/link/duplicate_node.h"
#include "aquafarm_agents/nodes/node.h"
#include "aquafarm_agents/nodes/refuse.h"
#include "aquafarm_agents/plan/newest_work.h"
#include "aquafarm_agents/plan/plan_keeper.h"
#include "aquafarm_agents/plan/plan_markers.h"
#include "aquafarm_sim/checked_topics.h"
#include "aquafarm_sim/params.h"

namespace aquafarm_agents {
namespace {

namespace agents = aquafarm::agents;
using agents::ExitCode;
using aquafarm_msgs::RescuePlan;

constexpr double kHeartbeat_s = 1.0;   // period; the panel waits 5 s for a heartbeat
constexpr double kMarkerLife_s = 5.0;  // as long as the panel waits
constexpr double kPlanLimit_s = 60.0;  // a plan that takes longer stops the heartbeat

struct PlanParams {
  std::string scenario;  ///< file or name; empty: that of the running ranch
  std::string bulletin;  ///< file or folder
  std::string at;
  agents::RescueRequest request;
  double period_s{0.5};      ///< between checks of the files
  double min_period_s{2.0};  ///< between the starts of two plans
  double refresh_s{300.0};   ///< with ~scenario: period after which the plan is made again
  double state_timeout_s{10.0};
  std::string command{"plan_node"};
};

void ReadRequest(aquafarm_sim::Params& reader, PlanParams& params) {
  agents::RescueRequest& request = params.request;
  reader.Text("storm", request.storm);
  reader.Text("storm_name", request.storm_name);
  reader.Text("devices", request.devices);
  reader.Text("ships_file", request.ships_file);
  reader.Text("currency", request.currency);
  int ships = -1;
  int capacity = 0;
  int members = request.members;
  int seed = static_cast<int>(request.seed);
  double speed_kn = 0.0;
  double depart_h = 0.0;
  constexpr double kUnset = 99.0;
  double utc_offset_h = kUnset;
  reader.Int("ships", -1, 64, ships);
  reader.Int("capacity", 0, 100, capacity);
  reader.Int("members", 10, 20000, members);
  reader.Int("seed", 0, INT_MAX, seed);
  reader.Number("speed_kn", 0.0, 60.0, speed_kn);
  reader.Number("depart_h", 0.0, 96.0, depart_h);
  reader.Number("utc_offset_h", -14.0, kUnset, utc_offset_h);
  if (utc_offset_h > 14.0 && utc_offset_h < kUnset) {
    throw aquafarm::InputError("~utc_offset_h: got " + std::to_string(utc_offset_h) +
                               ", expected [-14, 14], or 99 for the zone of the longitude");
  }
  reader.Number("abort_wind_kt", 10.0, 100.0, request.abort_wind_kt);
  reader.Number("risk_averse", 0.0, 1.0, request.risk_averse);
  if (ships >= 0) request.ships = ships;
  if (capacity > 0) request.capacity = capacity;
  if (speed_kn > 0.0) request.speed_kn = speed_kn;
  if (utc_offset_h < kUnset) request.utc_offset_h = utc_offset_h;
  request.members = members;
  request.seed = static_cast<std::uint64_t>(seed);
  request.depart_s = 3600.0 * depart_h;
}

PlanParams ReadPlanParams(const ros::NodeHandle& node) {
  PlanParams params;
  aquafarm_sim::Params reader(node);
  reader.Text("scenario", params.scenario);
  reader.Text("bulletin", params.bulletin);
  reader.Text("at", params.at);
  ReadRequest(reader, params);
  reader.Number("period_s", 0.05, 60.0, params.period_s);
  reader.Number("min_period_s", 0.1, 3600.0, params.min_period_s);
  reader.Number("refresh_s", 1.0, 86400.0, params.refresh_s);
  reader.Number("state_timeout_s", 0.5, 3600.0, params.state_timeout_s);
  reader.Allow("diagnostic_period");  // read by diagnostic_updater
  reader.RefuseOthers();
  if (params.bulletin.empty() == params.request.storm.empty()) {
    throw aquafarm::InputError("~bulletin: got " +
                               std::string(params.bulletin.empty() ? "nothing" : "also ~storm") +
                               ", expected one of ~bulletin (file or folder) and ~storm (file of "
                               "a recorded track)");
  }
  if (!params.bulletin.empty()) NewestFiles(params.bulletin);  // throws if it does not exist
  if (!params.at.empty()) params.request.at = aquafarm::ParseUtc("~at", params.at);
  if (params.scenario.empty() && !params.at.empty()) {
    throw aquafarm::InputError("~at: got " + params.at +
                               ", expected nothing without ~scenario: the ranch has its own time");
  }
  if (!params.request.storm.empty() && !params.scenario.empty() && params.at.empty()) {
    throw aquafarm::InputError("~at: got nothing, expected the start of the plan with ~storm");
  }
  for (const std::string& one : reader.given()) params.command += " _" + one;
  return params;
}

// Loads a scenario by path, or a shipped one by name.
aquafarm::Scenario LoadRanch(const std::string& name) {
  std::error_code ignored;
  const std::string shipped =
      ros::package::getPath("aquafarm_sim") + "/scenarios/" + name + ".yaml";
  const bool is_name = name.find('/') == std::string::npos;
  if (is_name && std::filesystem::exists(shipped, ignored)) return aquafarm::LoadScenario(shipped);
  if (std::filesystem::exists(name, ignored)) return aquafarm::LoadScenario(name);
  throw aquafarm::InputError("~scenario: got '" + name +
                             "', expected a file or the name of a shipped scenario; make one with "
                             "aquafarm scenario");
}

agents::FleetState ToFleet(const aquafarm_msgs::FarmState& state) {
  agents::FleetState fleet;
  fleet.seed = state.seed;
  fleet.episode = state.episode;
  for (const auto& ship : state.ships) {
    if (ship.own_device < 0) fleet.ships.push_back({{ship.x, ship.y}, ship.aboard});
  }
  for (const auto& device : state.devices) {
    fleet.devices.push_back({device.status == aquafarm_msgs::DeviceState::DEPLOYED,
                             device.self_propelled != 0, static_cast<double>(device.health)});
  }
  return fleet;
}

// Publishes rescue plans. Callbacks store the inputs; a worker thread plans and publishes.
class PlanNode {
 public:
  PlanNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node, PlanParams params)
      : node_(node),
        params_(std::move(params)),
        diagnostics_(node_, private_node, ros::this_node::getName()),
        plan_(node_.advertise<RescuePlan>("plan", 2, true)),
        markers_(node_.advertise<visualization_msgs::MarkerArray>("plan/markers", 2, true)),
        chart_(node_.advertise<nav_msgs::OccupancyGrid>("plan/chart", 2, true)) {
    if (!params_.scenario.empty()) {
      scenario_ = std::make_shared<const aquafarm::Scenario>(LoadRanch(params_.scenario));
    } else {
      spec_ = aquafarm_sim::Subscribe<aquafarm_msgs::FarmSpec>(
          node_, "spec", 2, [this](const aquafarm_msgs::FarmSpecConstPtr& spec) { OnSpec(spec); });
      FollowState();
    }
    work_ = std::make_unique<NewestWork<PlanInputs>>(
        [this](const PlanInputs& inputs) { Work(inputs); },
        std::chrono::duration<double>(params_.min_period_s));
    diagnostics_.setHardwareID("none");
    diagnostics_.add("plan", this, &PlanNode::Diagnose);
    heartbeat_ = node_.advertise<std_msgs::Time>("plan/heartbeat", 2);
    beat_ = node_.createWallTimer(ros::WallDuration(kHeartbeat_s),
                                  [this](const ros::WallTimerEvent&) { Beat(); });
    look_ = node_.createWallTimer(ros::WallDuration(params_.period_s),
                                  [this](const ros::WallTimerEvent&) { Look(); });
    Look();
  }

 private:
  bool follows() const { return params_.scenario.empty(); }

  void FollowState() {
    state_ = aquafarm_sim::Subscribe<aquafarm_msgs::FarmState>(
        node_, "state", 1,
        [this](const aquafarm_msgs::FarmStateConstPtr& state) { OnState(state); });
  }

  void OnSpec(const aquafarm_msgs::FarmSpecConstPtr& spec) {
    if (scenario_ && scenario_->hash == spec->scenario_hash) return;
    // The last state may belong to another ranch. A new subscription receives the state of this
    // ranch.
    last_state_ = nullptr;
    state_.shutdown();
    FollowState();
    try {
      scenario_ = std::make_shared<const aquafarm::Scenario>(
          aquafarm::ParseScenario(spec->scenario_yaml, spec->scenario_name));
      spec_fault_.clear();
    } catch (const aquafarm::InputError& error) {
      scenario_ = nullptr;
      spec_fault_ = error.what();
    }
  }

  // Publishes the heartbeat and renews the markers, unless planning hangs. To subscribers, a node
  // that hangs thus looks like a node that has ended.
  void Beat() {
    if (work_->busy_s() > kPlanLimit_s) return;
    std_msgs::Time now;
    const ros::WallTime wall = ros::WallTime::now();
    now.data = ros::Time(wall.sec, wall.nsec);
    heartbeat_.publish(now);
    RenewMarkers(wall);
  }

  // Publishes the markers again before rviz removes them at the end of their lifetime. rviz counts
  // the lifetime in ROS time, which may run faster than the wall clock.
  void RenewMarkers(const ros::WallTime& wall) {
    const aquafarm::MutexLock lock(markers_mutex_);
    const ros::Time now = ros::Time::now();
    const double ran_s = (now - renewed_).toSec();
    const double pace = renewed_.isZero() ? 1.0 : ran_s / (wall - renewed_wall_).toSec();
    lifetime_ = ros::Duration(kMarkerLife_s * std::clamp(pace, 1.0, 1000.0));
    renewed_ = now;
    renewed_wall_ = wall;
    if (drawn_.markers.empty() || markers_.getNumSubscribers() == 0) return;
    for (auto& marker : drawn_.markers) marker.lifetime = lifetime_;
    markers_.publish(drawn_);
  }

  void PublishMarkers(const RescuePlan& plan) {
    const aquafarm::MutexLock lock(markers_mutex_);
    drawn_ = PlanMarkers(plan);
    for (auto& marker : drawn_.markers) marker.lifetime = lifetime_;
    markers_.publish(drawn_);
    // The first marker deletes the markers of the previous plan. RenewMarkers must not repeat it.
    drawn_.markers.erase(drawn_.markers.begin());
  }

  void OnState(const aquafarm_msgs::FarmStateConstPtr& state) {
    last_state_ = state;
    heard_ = ros::WallTime::now();
    Look();
  }

  // Collects the inputs and passes them to the worker if they have changed.
  void Look() {
    PlanInputs inputs;
    inputs.request = params_.request;
    inputs.command = params_.command;
    inputs.request.now = std::time(nullptr);
    std::string fault = follows() ? FollowRanch(inputs) : "";
    if (!follows() || inputs.fleet) inputs.scenario = scenario_;
    if (!follows()) {
      inputs.refresh =
          static_cast<std::int64_t>(std::floor(ros::WallTime::now().toSec() / params_.refresh_s));
    }
    for (const std::string& path : {params_.request.devices, params_.request.ships_file}) {
      if (!path.empty()) inputs.files.push_back(StampOf(path));
    }
    try {
      if (!params_.bulletin.empty()) inputs.bulletins = NewestFiles(params_.bulletin);
      if (!params_.bulletin.empty() && inputs.bulletins.empty()) {
        fault += (fault.empty() ? "" : "; ") + params_.bulletin + ": no bulletin yet";
      }
    } catch (const aquafarm::InputError& error) {
      fault += (fault.empty() ? "" : "; ") + std::string(error.what());
      if (asked_) inputs.bulletins = asked_->bulletins;
    }
    inputs.fault = fault;
    if (asked_ && SamePlan(*asked_, inputs) && asked_->fault == inputs.fault) return;
    asked_ = inputs;
    work_->Ask(std::move(inputs));
  }

  // Adds the state of the ranch to the inputs. Returns why the state is missing or outdated; empty
  // if it is current.
  std::string FollowRanch(PlanInputs& inputs) {
    if (!spec_fault_.empty()) return spec_fault_;
    const std::string name = node_.resolveName("state");
    if (!scenario_ || !last_state_) {
      return name + ": no ranch yet; start one there (sim.launch) or give a scenario";
    }
    inputs.fleet = ToFleet(*last_state_);
    inputs.step = last_state_->step;
    if (!last_state_->world_time.isZero() && scenario_->start_time) {
      inputs.request.at = static_cast<std::int64_t>(last_state_->world_time.sec);
    }
    const double silent_s = (ros::WallTime::now() - heard_).toSec();
    if (silent_s < params_.state_timeout_s) return "";
    // A ranch that waits for its ships or is paused publishes nothing, but its services exist.
    const bool may_be_silent =
        last_state_->pace == aquafarm_msgs::FarmState::LOCKSTEP || last_state_->paused;
    if (may_be_silent && ros::service::exists("get_state", false)) return "";
    return name + ": the ranch has ended or hangs (last state: step " +
           std::to_string(inputs.step) + "); start the ranch again";
  }

  void Work(const PlanInputs& inputs) {
    try {
      if (!keeper_.Update(inputs)) return;
      PlanMessages messages = keeper_.plan();
      Publish(messages);
      Report(messages.plan);
      const aquafarm::MutexLock lock(shown_mutex_);
      shown_ = std::move(messages.plan);
    } catch (const std::exception& error) {
      ROS_ERROR("plan: %s", error.what());
    }
  }

  void Publish(PlanMessages& messages) {
    RescuePlan& plan = messages.plan;
    plan.header.stamp = ros::Time::now();
    plan.header.frame_id = "map";
    messages.chart.header = plan.header;
    messages.chart.info.map_load_time = plan.header.stamp;
    if (plan.width > 0) chart_.publish(messages.chart);
    while (paths_.size() < plan.ships.size()) {
      paths_.push_back(node_.advertise<nav_msgs::Path>(
          "ship_" + std::to_string(paths_.size()) + "/plan", 2, true));
    }
    for (std::size_t ship = 0; ship < paths_.size(); ++ship) {
      paths_[ship].publish(PathOfShip(plan, static_cast<std::int32_t>(ship)));
    }
    PublishMarkers(plan);
    plan_.publish(plan);
  }

  // Logs the fault and the text of a plan when they change. ROS_WARN_THROTTLE is not used, because
  // it counts ROS time, which may stand still.
  void Report(const RescuePlan& plan) {
    if (plan.fault != told_fault_ && !plan.fault.empty()) ROS_WARN("plan: %s", plan.fault.c_str());
    told_fault_ = plan.fault;
    if (plan.text == told_text_) return;
    told_text_ = plan.text;
    ROS_INFO("plan (%.2f s): %s", plan.compute_s, plan.text.c_str());
  }

  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    const aquafarm::MutexLock lock(shown_mutex_);
    using Status = diagnostic_msgs::DiagnosticStatus;
    const bool has_plan = shown_.result != RescuePlan::NONE;
    const bool is_stop = !shown_.warnings.empty() && shown_.warnings.front().severity == "stop";
    status.summary(!has_plan                          ? Status::ERROR
                   : is_stop || !shown_.fault.empty() ? Status::WARN
                                                      : Status::OK,
                   shown_.fault.empty() ? shown_.text : shown_.fault);
    status.add("compute_s", shown_.compute_s);
    status.add("busy", work_->busy());
    status.add("step", shown_.step);
    status.add("storm_file", shown_.storm_file);
  }

  ros::NodeHandle node_;
  const PlanParams params_;
  std::shared_ptr<const aquafarm::Scenario> scenario_;
  aquafarm_msgs::FarmStateConstPtr last_state_;
  ros::WallTime heard_;
  std::string spec_fault_;
  std::optional<PlanInputs> asked_;
  diagnostic_updater::Updater diagnostics_;
  ros::Publisher plan_;
  ros::Publisher markers_;
  ros::Publisher chart_;
  ros::Subscriber spec_;
  ros::Subscriber state_;
  ros::Publisher heartbeat_;
  ros::WallTimer look_;
  ros::WallTimer beat_;

  // Used only by the worker thread.
  PlanKeeper keeper_;
  std::vector<ros::Publisher> paths_;  // by ship
  std::string told_fault_;
  std::string told_text_;

  aquafarm::Mutex markers_mutex_;
  // The markers of the current plan, without the marker that deletes those of the previous plan.
  visualization_msgs::MarkerArray drawn_ AQUAFARM_GUARDED_BY(markers_mutex_);
  ros::Duration lifetime_ AQUAFARM_GUARDED_BY(markers_mutex_){kMarkerLife_s};
  ros::Time renewed_ AQUAFARM_GUARDED_BY(markers_mutex_);
  ros::WallTime renewed_wall_ AQUAFARM_GUARDED_BY(markers_mutex_);

  aquafarm::Mutex shown_mutex_;
  RescuePlan shown_ AQUAFARM_GUARDED_BY(shown_mutex_) = NoPlan();

  static RescuePlan NoPlan() {
    RescuePlan plan;
    plan.result = RescuePlan::NONE;
    plan.text = "There is no plan yet.";
    return plan;
  }

  std::unique_ptr<NewestWork<PlanInputs>> work_;  // last, because its thread uses other members
};

}  // namespace

int RunPlanNode() {
  try {
    RefuseTwin();
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    PlanNode plan(node, private_node, ReadPlanParams(private_node));
    ros::spin();
    return 0;
  } catch (const aquafarm::InputError& error) {
    return Refuse("plan_node", ExitCode::kBadInput, error.what());
  } catch (const std::exception& error) {
    return Refuse("plan_node", ExitCode::kInternal, error.what());
  }
}

}  // namespace aquafarm_agents
