// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/link/call_limit.h"

namespace aquafarm_agents {
namespace {

using aquafarm::MutexLock;

// Coarse, so that the overhead of a fast call is negligible.
constexpr std::chrono::milliseconds kLook{200};

}  // namespace

CallLimit::CallLimit(double limit_s) : limit_(limit_s), watcher_([this] { Watch(); }) {}

CallLimit::~CallLimit() {
  {
    const MutexLock lock(mutex_);
    ends_ = true;
  }
  ended_.notify_all();
  watcher_.join();
}

void CallLimit::Arm(ros::ServiceClient& client) {
  const auto now = Clock::now();
  const MutexLock lock(mutex_);
  armed_ = &client;
  since_ = now;
}

void CallLimit::Disarm() {
  const MutexLock lock(mutex_);
  armed_ = nullptr;
}

void CallLimit::Watch() {
  MutexLock lock(mutex_);
  while (!ends_) {
    if (lock.WaitUntil(ended_, Clock::now() + kLook)) continue;  // woken before the time
    if (armed_ == nullptr || Clock::now() - since_ < limit_) continue;
    armed_->shutdown();  // drops the connection, which aborts the call
    armed_ = nullptr;
  }
}

}  // namespace aquafarm_agents
