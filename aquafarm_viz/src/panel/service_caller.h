// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/Command.h>
#include <ros/ros.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <thread>
#include <type_traits>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/checked_topics.h"

namespace aquafarm_viz {

/// Calls services one after another from a separate thread, so that a window never blocks. A call
/// is aborted if there is no response within a time limit. A call is refused if eight calls are
/// already waiting.
class ServiceCaller {
 public:
  using OnAnswer = std::function<void(const std::string& line)>;

  /// @param limit_s time limit of each call [s]
  /// @param on_answer is called with a readable line after each call. It is called from the thread
  ///        of this object or, for a refused call, from the thread that called Call.
  ServiceCaller(const ros::NodeHandle& node, double limit_s, OnAnswer on_answer);
  ~ServiceCaller();
  ServiceCaller(const ServiceCaller&) = delete;
  ServiceCaller& operator=(const ServiceCaller&) = delete;

  /// Queues a call of a service of the ranch and returns immediately. The response of the service
  /// must have the fields `ok` and `message`; in the response of Command, they are in `result`.
  /// @param describe returns the line for a response whose `ok` is true; for Command, for each
  ///        response
  template <typename Service>
  void Call(const std::string& name, Service service,
            std::function<std::string(const Service&)> describe) {
    Enqueue(name, [this, name, service, describe = std::move(describe)]() mutable {
      const std::string full = node_.resolveName(name);
      ros::ServiceClient client = node_.serviceClient<Service>(name, true);
      if (!client.isValid()) return full + ": service not available; is a ranch running?";
      if (!Arm(&client)) return std::string();
      const bool answered = aquafarm_sim::Call(client, service);
      if (Disarm()) return full + ": no answer within " + LimitInWords();
      if (!answered) return full + ": the call failed";
      return Describe(name, service, describe);
    });
  }

 private:
  using Clock = std::chrono::steady_clock;

  template <typename Service, typename Describer>
  static std::string Describe(const std::string& name, const Service& service,
                              const Describer& describe) {
    if constexpr (std::is_same_v<Service, aquafarm_msgs::Command>) {
      return describe(service);  // `ok` and `message` are in the field `result`
    } else {
      return service.response.ok ? describe(service) : name + ": " + service.response.message;
    }
  }

  void Enqueue(const std::string& name, std::function<std::string()> job);
  std::string LimitInWords() const;
  bool Arm(ros::ServiceClient* client);  // false during destruction
  bool Disarm();                         // true if the call was aborted
  void Work();
  void Watch();

  ros::NodeHandle node_;
  const std::chrono::duration<double> limit_;
  const OnAnswer on_answer_;
  aquafarm::Mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<std::string()>> jobs_ AQUAFARM_GUARDED_BY(mutex_);
  ros::ServiceClient* armed_ AQUAFARM_GUARDED_BY(mutex_){};
  Clock::time_point end_ AQUAFARM_GUARDED_BY(mutex_);  // deadline of the armed call
  bool cut_off_ AQUAFARM_GUARDED_BY(mutex_){};
  bool ending_ AQUAFARM_GUARDED_BY(mutex_){};
  std::thread worker_;
  std::thread watcher_;
};

}  // namespace aquafarm_viz
