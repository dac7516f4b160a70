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

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/names.h"
#include "aquafarm_sim/node/checked_service.h"
#include "aquafarm_sim/node/reusing_service.h"

namespace aquafarm_sim {
namespace {

constexpr std::uint32_t kCommonThreads = 2;
constexpr double kLookPeriod_s = 0.05;
constexpr double kAtWork_s = 2.0;     // max time since the last joint step of a running trainer
constexpr double kSaveLimit_s = 8.0;  // roslaunch sends SIGTERM after 15 s

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // set in a signal handler

std::shared_ptr<const aquafarm::Scenario> Load(const std::string& scenario) {
  return std::make_shared<const aquafarm::Scenario>(
      aquafarm::LoadScenario(ResolveScenario(scenario, ScenarioFolder())));
}

/// Advertises a service with the callback `handle`, which receives the request, the response and
/// the name of the calling node. An exception of the callback is logged, and the call fails.
template <typename Service, typename Handle>
ros::ServiceServer ServeCaller(ros::NodeHandle& node, const std::string& name, Handle handle) {
  const auto callback = [name, handle](typename Service::Request& request,
                                       typename Service::Response& response,
                                       const std::string& caller) {
    try {
      handle(request, response, caller);
      return true;
    } catch (const std::exception& error) {
      ROS_ERROR("%s: %s", name.c_str(), error.what());
      return false;
    }
  };
  return AdvertiseHelper<Service>(node, name,
                                  boost::make_shared<CheckedService<Service>>(callback));
}

/// Does the same as ServeCaller, without the name of the calling node.
template <typename Service, typename Handle>
ros::ServiceServer Serve(ros::NodeHandle& node, const std::string& name, Handle handle) {
  return ServeCaller<Service>(
      node, name, [handle](auto& request, auto& response, const std::string& /*caller*/) {
        handle(request, response);
      });
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

}  // namespace

SimNode::SimNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : params_(ReadSimParams(private_node)),
      node_(node),
      ranch_(Load(params_.scenario), params_.ranch),
      publisher_(node_, params_, ranch_),
      ship_node_(OnQueue(node_, ship_queue_)) {
  const double wait_s = params_.recorder_wait_s;
  if (wait_s > 0.0 && !publisher_.WaitForRecorder(wait_s)) {
    ROS_WARN("no recorder subscribed within ~recorder_wait_s, %g s; continuing without one",
             wait_s);
  }
  KeepEpisodes();
  const std::int32_t agents = ranch_.agents();
  for (std::int32_t ship = 0; ship < agents; ++ship) AdvertiseShip(ship);
  AdvertiseFarm();
  diagnostics_ =
      std::make_unique<FarmDiagnostics>(node_, private_node, ranch_, publisher_, recorder_.get());
  // At most one command per ship waits, so one thread is always free. A single ship never waits.
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
  format.ns = node_.resolveName(names::kState, /*remap=*/false);
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

// Ctrl-C in a launch sends SIGINT to the trainer and to sim_node at the same time. A running
// trainer then needs the services of sim_node to save.
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
  // rosconsole stops with the last node handle, so startup errors are printed to stderr directly.
  try {
    SimNode node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::AsyncSpinner spinner(kCommonThreads);
    spinner.start();
    for (const int number : {SIGINT, SIGTERM}) {
      std::signal(number, [](int) { interrupted = true; });
    }
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
