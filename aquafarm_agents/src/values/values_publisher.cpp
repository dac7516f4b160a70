// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/values/values_publisher.h"

#include <aquafarm_msgs/GetState.h>
#include <aquafarm_msgs/SaveState.h>
#include <ros/console.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <utility>

#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_agents/link/service_link.h"
#include "aquafarm_agents/values/values_messages.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_agents {
namespace {

namespace names = aquafarm_sim::names;
using aquafarm::agents::Policy;

constexpr double kCallLimit_s = 2.0;
constexpr auto kPollPeriod = std::chrono::milliseconds(100);
constexpr int kRest = 9;       // pause after computing, as a multiple of the computing time
constexpr int kCopyRest = 49;  // pause after copying a policy, as a multiple of the copying time
constexpr int kNice = 10;

}  // namespace

ValuesPublisher::ValuesPublisher(const ros::NodeHandle& node, double period_s)
    : node_(node), period_(period_s) {
  if (period_s <= 0.0) return;
  grid_ = node_.advertise<nav_msgs::OccupancyGrid>(names::kValues, 1, true);
  points_ = node_.advertise<sensor_msgs::PointCloud2>(names::kValuePoints, 1, true);
  thread_ = std::thread([this] { Run(); });
}

ValuesPublisher::~ValuesPublisher() {
  {
    const aquafarm::MutexLock lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool ValuesPublisher::IsWatched() const {
  return grid_.getNumSubscribers() > 0 || points_.getNumSubscribers() > 0;
}

void ValuesPublisher::Refresh(const std::function<std::unique_ptr<Policy>()>& make) {
  const auto start = Clock::now();
  if (!thread_.joinable() || !IsWatched() || start < copy_due_) return;
  {
    const aquafarm::MutexLock lock(mutex_);
    if (start < due_) return;
  }
  Offer(make());
  const auto end = Clock::now();
  copy_due_ = end + kCopyRest * (end - start);
}

void ValuesPublisher::Offer(std::unique_ptr<Policy> policy) {
  const std::uint8_t observation_types = policy->observation_types();
  if (observation_types == 0 || (observation_types & aquafarm::agents::kStatesBit) != 0) return;
  const aquafarm::MutexLock lock(mutex_);
  policy_ = std::move(policy);
}

void ValuesPublisher::Run() {
  // On Linux this affects only this thread.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
  aquafarm::MutexLock lock(mutex_);
  while (!ending_) {
    if (policy_ == nullptr || !IsWatched() || Clock::now() < due_) {
      lock.WaitUntil(changed_,
                     Clock::now() + kPollPeriod);  // polls, because new subscribers cause no event
      continue;
    }
    const std::shared_ptr<Policy> policy = policy_;
    lock.Unlock();
    const auto start = Clock::now();
    try {
      Look(*policy);
    } catch (const std::exception& error) {  // the sim node is gone, or its farms have changed
      farms_.reset();
      ROS_DEBUG("no values: %s", error.what());
    }
    const auto now = Clock::now();
    lock.Lock();
    due_ = std::max(start + std::chrono::duration_cast<Clock::duration>(period_),
                    now + kRest * (now - start));
  }
}

void ValuesPublisher::Look(Policy& policy) {
  const auto call = [this](const char* name, auto& service) {
    ServiceLink(node_, kCallLimit_s, &ending_, kCallLimit_s).Call(name, service);
    if (!service.response.ok) throw std::runtime_error(service.response.message);
  };
  if (farms_ == nullptr) {
    aquafarm_msgs::GetState get;
    get.request.with_spec = true;
    call(names::kGetState, get);
    const aquafarm_msgs::FarmSpec& spec = get.response.spec;
    frame_ = spec.header.frame_id;
    farms_ = std::make_unique<aquafarm::FarmBatch>(
        std::make_shared<const aquafarm::Scenario>(
            aquafarm::ParseScenario(spec.scenario_yaml, spec.scenario_name)),
        spec.farms);
  }
  if (const std::string why = aquafarm::agents::WhyNoBestMoves(farms_->scenario()); !why.empty()) {
    ROS_WARN_ONCE("no values: %s", why.c_str());
    return;
  }
  aquafarm_msgs::SaveState save;
  call(names::kSaveState, save);
  farms_->Load({save.response.data.begin(), save.response.data.end()});
  const auto moves = aquafarm::agents::GreedyActions(farms_->farm(0), policy.observation_types(),
                                                     policy, &ending_);
  if (ending_) return;
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = frame_;
  grid_.publish(ValuesToGrid(moves, farms_->scenario(), header));
  points_.publish(ValuesToPoints(moves, farms_->scenario(), header));
}

}  // namespace aquafarm_agents
