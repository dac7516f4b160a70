// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/service_client.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <thread>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/checked_topics.h"

namespace aquafarm_agents {

inline constexpr double kRetryPeriod_s = 0.1;  ///< between attempts to reach a sim node

/// Runs a task in a separate thread and waits for its end. If the task does not end within
/// 0.2 s · `looks`, prints a line to standard error and ends the process with ExitCode::kLost.
void EndUnlessDone(const std::function<void()>& task, int looks);

/// Calls services with a timeout, because the calls of roscpp have none. A call that exceeds the
/// limit is aborted and returns false. If roscpp cannot abort it, the process ends (EndUnlessDone).
/// Calls must not overlap.
class CallLimit {
 public:
  explicit CallLimit(double limit_s);
  ~CallLimit();
  CallLimit(const CallLimit&) = delete;
  CallLimit& operator=(const CallLimit&) = delete;

  /// @returns false if there was no readable response, for example because the service is gone or
  ///          the limit is exceeded.
  ///          The client is then shut down and must be created again. It is shut down because
  ///          roscpp sometimes reports a dropped connection as valid.
  template <typename Service>
  bool Call(ros::ServiceClient& client, Service& service) {
    Arm(client);
    const bool answered = aquafarm_sim::Call(client, service);
    Disarm();
    if (!answered) client.shutdown();
    return answered;
  }

 private:
  using Clock = std::chrono::steady_clock;
  void Arm(ros::ServiceClient& client);
  void Disarm();
  void Watch();

  const std::chrono::duration<double> limit_;
  aquafarm::Mutex mutex_;
  std::condition_variable ended_;
  bool ends_ AQUAFARM_GUARDED_BY(mutex_){};
  ros::ServiceClient* armed_ AQUAFARM_GUARDED_BY(mutex_){};
  Clock::time_point since_ AQUAFARM_GUARDED_BY(mutex_);
  std::thread watcher_;
};

}  // namespace aquafarm_agents
