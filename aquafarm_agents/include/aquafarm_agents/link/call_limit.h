// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/service_client.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace aquafarm_agents {

/// Gives service calls the limit that roscpp lacks: a call that has taken longer is cut off, so
/// that it returns false. For one caller, whose calls do not overlap.
class CallLimit {
 public:
  explicit CallLimit(double limit_s);
  ~CallLimit();
  CallLimit(const CallLimit&) = delete;
  CallLimit& operator=(const CallLimit&) = delete;

  /// @returns false when there was no answer: the service is gone or the limit is over. The client
  ///          is shut down then and has to be made anew: roscpp at times goes on calling a dropped
  ///          connection valid.
  template <typename Service>
  bool Call(ros::ServiceClient& client, Service& service) {
    Arm(client);
    const bool answered = client.call(service);
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
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ends_{};
  ros::ServiceClient* armed_{};
  Clock::time_point since_;
  std::thread watcher_;
};

}  // namespace aquafarm_agents
