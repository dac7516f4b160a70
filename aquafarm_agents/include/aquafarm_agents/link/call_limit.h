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

inline constexpr double kRetryPeriod_s = 0.1;  ///< pause between two attempts of a call

/// Runs a task in a separate thread and waits for its end. If the task does not end within
/// 0.2 s · `looks`, reports a deadlock of roscpp on standard error and ends the process with
/// ExitCode::kLost.
void EndUnlessDone(const std::function<void()>& task, int looks);

/// Calls services with a timeout, because the calls of roscpp have no timeout. A call that exceeds
/// the limit is aborted. If roscpp does not abort the call within 15 s, the process ends
/// (EndUnlessDone). Calls must not overlap.
class CallLimit {
 public:
  /// @param limit_s max duration of a call
  explicit CallLimit(double limit_s);
  ~CallLimit();
  CallLimit(const CallLimit&) = delete;
  CallLimit& operator=(const CallLimit&) = delete;

  /// Calls a service. If the call fails, shuts down the client, because roscpp sometimes reports a
  /// dropped connection as valid. The caller must then create the client again.
  /// @returns false if there was no readable response, for example because the service is gone or
  ///          the limit is exceeded
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
