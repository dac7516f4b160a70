// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/link/call_limit.h"

#include <cstdio>
#include <cstdlib>
#include <future>

#include "aquafarm/agents/base/exit_code.h"

namespace aquafarm_agents {
namespace {

using aquafarm::MutexLock;

// Period between two checks. It is long, so that the watcher costs little.
constexpr std::chrono::milliseconds kLook{200};
// Number of periods in 15 s. Counting them leaves out the time in which the process is suspended.
constexpr int kLastLooks = 75;

}  // namespace

void EndUnlessDone(const std::function<void()>& task, int looks) {
  const std::future<void> done = std::async(std::launch::async, task);
  for (int i = 0; i < looks; ++i) {
    if (done.wait_for(kLook) == std::future_status::ready) return;
  }
  std::fprintf(
      stderr,
      "a service call cannot be aborted: roscpp is in a deadlock (ros_comm issue 2057); the "
      "node ends. A training keeps its last checkpoint: continue it with resume:=true\n");
  std::fflush(nullptr);
  std::_Exit(static_cast<int>(aquafarm::agents::ExitCode::kLost));  // destructors would hang, too
}

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
    if (lock.WaitUntil(ended_, Clock::now() + kLook)) continue;  // woken by the destructor
    if (armed_ == nullptr || Clock::now() - since_ < limit_) continue;
    ros::ServiceClient* const client = armed_;
    // Drops the connection, which aborts the call. In rare cases this causes a deadlock: the call
    // waits for a lock of the connection, and the thread that closes the connection waits for the
    // call.
    EndUnlessDone([client] { client->shutdown(); }, kLastLooks);
    armed_ = nullptr;
  }
}

}  // namespace aquafarm_agents
