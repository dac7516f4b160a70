// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/sim_node.h"

#include <aquafarm_msgs/Claim.h>
#include <aquafarm_msgs/Command.h>
#include <aquafarm_msgs/DropOff.h>
#include <aquafarm_msgs/Move.h>
#include <aquafarm_msgs/Outcome.h>
#include <aquafarm_msgs/Pickup.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/this_node.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/names.h"
#include "aquafarm_sim/node/reusing_service.h"

namespace aquafarm_sim {
namespace {

constexpr std::uint32_t kCommonThreads = 2;
constexpr double kDiagnosticsPeriod_s = 1.0;
constexpr double kLookPeriod_s = 0.05;
constexpr double kAtWork_s = 2.0;     // max time since the last joint step of a running trainer
constexpr double kSaveLimit_s = 8.0;  // roslaunch sends SIGTERM after 15 s

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // set in a signal handler

std::shared_ptr<const aquafarm::Scenario> Load(const std::string& scenario) {
  return std::make_shared<const aquafarm::Scenario>(
      aquafarm::LoadScenario(ResolveScenario(scenario, ScenarioFolder())));
}

/// Advertises a service with the callback `handle`. Its exceptions are logged and fail the call.
template <typename Service, typename Handle>
ros::ServiceServer Serve(ros::NodeHandle& node, const std::string& name, Handle handle) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [name, handle](Request& request,
                                                                             Response& response) {
    try {
      handle(request, response);
      return true;
    } catch (const std::exception& error) {
      ROS_ERROR("%s: %s", name.c_str(), error.what());
      return false;
    }
  };
  return node.advertiseService(name, callback);
}

/// As Serve; `handle` also receives the name of the calling node.
template <typename Service, typename Handle>
ros::ServiceServer ServeCaller(ros::NodeHandle& node, const std::string& name, Handle handle) {
  using Event = ros::ServiceEvent<typename Service::Request, typename Service::Response>;
  const boost::function<bool(Event&)> callback = [name, handle](Event& event) {
    try {
      handle(event.getRequest(), event.getResponse(), event.getCallerName());
      return true;
    } catch (const std::exception& error) {
      ROS_ERROR("%s: %s", name.c_str(), error.what());
      return false;
    }
  };
  ros::AdvertiseServiceOptions options;
  options.initBySpecType<Event>(name, callback);
  return node.advertiseService(options);
}

/// Converts a ship's request to a command.
template <typename Request>
ShipCommand ToCommand(std::int32_t ship, std::uint8_t action, const Request& request,
                      const std::string& caller) {
  return {ship, action, request.episode, request.step, request.token, caller};
}

ros::NodeHandle OnQueue(const ros::NodeHandle& node, ros::CallbackQueue& queue) {
  ros::NodeHandle handle(node);
  handle.setCallbackQueue(&queue);
  return handle;
}

std::string Joined(const std::vector<std::int32_t>& ships) {
  std::string text;
  for (const std::int32_t ship : ships) text += (text.empty() ? "" : ", ") + std::to_string(ship);
  return text;
}

double ResidentMebibytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

// Returns the ships that were absent between two diagnoses only.
std::vector<std::int32_t> ReturnedShips(const ServerCounters& before, const ServerCounters& now) {
  std::vector<std::int32_t> ships;
  for (std::size_t i = 0; i < now.absences.size(); ++i) {
    const auto ship = static_cast<std::int32_t>(i);
    const bool is_absent = std::count(now.absent.begin(), now.absent.end(), ship) > 0;
    const std::uint64_t earlier = i < before.absences.size() ? before.absences[i] : 0;
    if (!is_absent && now.absences[i] > earlier) ships.push_back(ship);
  }
  return ships;
}

}  // namespace

SimNode::SimNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : params_(ReadSimParams(private_node)),
      node_(node),
      ranch_(Load(params_.scenario), params_.ranch),
      publisher_(node_, params_, ranch_),
      ship_node_(OnQueue(node_, ship_queue_)),
      diagnostics_(ros::NodeHandle(), private_node, ros::this_node::getName()),
      diagnosed_at_(ros::WallTime::now()) {
  const double wait_s = params_.recorder_wait_s;
  if (wait_s > 0.0 && !publisher_.WaitForRecorder(wait_s)) {
    ROS_WARN("no recorder subscribed within ~recorder_wait_s, %g s; continuing without one",
             wait_s);
  }
  KeepEpisodes();
  const std::int32_t agents = ranch_.agents();
  for (std::int32_t ship = 0; ship < agents; ++ship) AdvertiseShip(ship);
  AdvertiseFarm();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("farm", this, &SimNode::Diagnose);
  diagnostics_timer_ =
      node_.createWallTimer(ros::WallDuration(kDiagnosticsPeriod_s),
                            [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  // At most one command per ship waits, so one thread is always free.
  const std::int32_t threads = agents == 1 ? 1 : agents + 1;
  ship_spinner_ =
      std::make_unique<ros::AsyncSpinner>(static_cast<std::uint32_t>(threads), &ship_queue_);
  ship_spinner_->start();
  pacer_ = std::thread([this] { ranch_.RunPaced(); });
}

SimNode::~SimNode() {
  ranch_.Shutdown();
  for (ros::ServiceServer& service : services_) service.shutdown();
  ship_spinner_->stop();
  pacer_.join();
  ranch_.SetRecorder(nullptr);
}

void SimNode::KeepEpisodes() {
  const Keep keep = ParseKeep(params_.keep);
  if (keep.which == Keep::Which::kNone) return;
  BagFormat format;
  format.ns = node_.resolveName(names::kState);
  format.ns.resize(format.ns.size() - std::string(names::kState).size());
  format.map_frame = params_.map_frame;
  format.rate_hz = params_.ranch.rate_hz;
  format.farms = params_.ranch.farms;
  const std::string folder = std::filesystem::absolute(params_.keep_dir).string();
  recorder_ = std::make_unique<EpisodeRecorder>(ranch_.shared_scenario(), keep, folder, format);
  ranch_.SetRecorder(recorder_.get());
  ROS_INFO("keeping episodes (%s) in %s", params_.keep.c_str(), folder.c_str());
}

void SimNode::AdvertiseShip(std::int32_t ship) {
  using aquafarm::Action;
  services_.push_back(ServeCaller<aquafarm_msgs::Move>(
      ship_node_, names::Move(ship),
      [this, ship](const auto& request, auto& response, const std::string& caller) {
        response.result = ranch_.MoveShip(ToCommand(ship, request.direction, request, caller));
      }));
  services_.push_back(ServeCaller<aquafarm_msgs::Pickup>(
      ship_node_, names::Pickup(ship),
      [this, ship](const auto& request, auto& response, const std::string& caller) {
        constexpr auto kPickup = static_cast<std::uint8_t>(Action::kPickup);
        response.result = ranch_.Command(ToCommand(ship, kPickup, request, caller));
      }));
  services_.push_back(ServeCaller<aquafarm_msgs::DropOff>(
      ship_node_, names::DropOff(ship),
      [this, ship](const auto& request, auto& response, const std::string& caller) {
        constexpr auto kDropOff = static_cast<std::uint8_t>(Action::kDropOff);
        response.result = ranch_.Command(ToCommand(ship, kDropOff, request, caller));
      }));
  services_.push_back(ServeCaller<aquafarm_msgs::Claim>(
      ship_node_, names::Claim(ship),
      [this, ship](const auto& request, auto& response, const std::string& caller) {
        ranch_.Claim(ship, caller, request.release != 0, response);
      }));
}

void SimNode::AdvertiseFarm() {
  namespace msgs = aquafarm_msgs;
  services_.push_back(ServeCaller<msgs::Command>(
      ship_node_, names::kCommand,
      [this](const auto& request, auto& response, const std::string& caller) {
        response.result = ranch_.Command(ToCommand(request.ship, request.action, request, caller));
      }));
  services_.push_back(ReusingService<msgs::Step>::Advertise(
      node_, names::kStep, [this](const auto& request, const std::string& caller) -> const auto& {
        return ranch_.Step(request, caller);
      }));
  services_.push_back(ServeCaller<msgs::Reset>(
      node_, names::kReset,
      [this](const auto& q, auto& a, const std::string& caller) { ranch_.Reset(q, a, caller); }));
  services_.push_back(Serve<msgs::GetState>(
      node_, names::kGetState, [this](const auto& q, auto& a) { ranch_.GetState(q, a); }));
  services_.push_back(Serve<msgs::SaveState>(
      node_, names::kSaveState, [this](const auto&, auto& a) { ranch_.SaveState(a); }));
  services_.push_back(Serve<msgs::LoadState>(
      node_, names::kLoadState, [this](const auto& q, auto& a) { ranch_.LoadState(q, a); }));
  services_.push_back(Serve<msgs::Pause>(node_, names::kPause,
                                         [this](const auto& q, auto& a) { ranch_.Pause(q, a); }));
  services_.push_back(Serve<msgs::SetPace>(
      node_, names::kSetPace, [this](const auto& q, auto& a) { ranch_.SetPace(q, a); }));
  services_.push_back(Serve<msgs::SetDisaster>(
      node_, names::kSetDisaster, [this](const auto& q, auto& a) { ranch_.SetDisaster(q, a); }));
}

void SimNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ServerCounters now = ranch_.counters();
  const ros::WallTime time = ros::WallTime::now();
  const double elapsed_s = std::max((time - diagnosed_at_).toSec(), 1e-3);
  const double steps_per_s =
      static_cast<double>(now.farm_steps - diagnosed_.farm_steps) / elapsed_s;
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  if (now.barrier_timeouts > diagnosed_.barrier_timeouts) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "barrier timed out");
  }
  const std::vector<std::int32_t> returned = ReturnedShips(diagnosed_, now);
  if (!returned.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "held without a command in time, and returned: ship " + Joined(returned));
  }
  if (!now.absent.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "not waiting until their next command: ship " + Joined(now.absent));
  }
  const std::string lost = recorder_ == nullptr ? "" : recorder_->fault();
  if (!lost.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "recording of episodes stopped: " + lost);
  }
  if (now.untold > diagnosed_.untold) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        "something was not published: " + now.untold_why);
  }
  if (!now.fault.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "paused itself: " + now.fault);
  }
  status.add("version", aquafarm::kVersion);
  status.add("farm steps per second", steps_per_s);
  status.add("farm steps", now.farm_steps);
  status.add("late ships", now.late_ships);
  status.add("barrier timeouts", now.barrier_timeouts);
  status.add("superseded commands", now.superseded);
  status.add("dropped clients", now.dropped_clients);
  status.add("refused requests", now.refused);
  status.add("dropped episode summaries", publisher_.dropped_summaries());
  if (recorder_ != nullptr) status.add("kept episodes", recorder_->kept());
  status.add("memory [MiB]", ResidentMebibytes());
  diagnosed_ = now;
  diagnosed_at_ = time;
}

// Ctrl-C in a launch reaches trainer and farm together. A running trainer gets time to save.
void SimNode::LetClientsSave() {
  const ros::WallTime start = ros::WallTime::now();
  const auto elapsed_s = [&start] { return (ros::WallTime::now() - start).toSec(); };
  const std::uint64_t saves = ranch_.counters().saves;
  while (ros::ok() && ranch_.counters().joint_step_age_s < kAtWork_s &&
         ranch_.counters().saves == saves && elapsed_s() < kSaveLimit_s) {
    ros::WallDuration(kLookPeriod_s).sleep();
  }
  ros::WallDuration(kLookPeriod_s).sleep();  // time to send the response
}

int RunSimNode() {
  // rosconsole ends with the last node handle, so refusals are printed to stderr directly.
  try {
    SimNode node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::AsyncSpinner spinner(kCommonThreads);
    spinner.start();
    std::signal(SIGINT, [](int) { interrupted = true; });
    while (ros::ok() && !interrupted) ros::WallDuration(kLookPeriod_s).sleep();
    node.LetClientsSave();
    ros::shutdown();
    return 0;
  } catch (const aquafarm::InputError& error) {
    std::fprintf(stderr, "sim_node: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sim_node: %s\n", error.what());
    return 1;
  }
}

}  // namespace aquafarm_sim
