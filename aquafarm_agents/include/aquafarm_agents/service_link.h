// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/init.h>
#include <ros/node_handle.h>

#include <atomic>
#include <string>
#include <utility>

#include "aquafarm/agents/environment.h"
#include "aquafarm_agents/call_limit.h"

namespace aquafarm_agents {

/// One persistent connection to a service, made again when it breaks, with limits.
class ServiceLink {
 public:
  inline static constexpr double kCallLimit_s = 30.0;

  /// @param wait_limit_s for an answer, over all attempts
  /// @param stop may be set by a signal handler; null: never
  /// @param call_limit_s for an answer to one attempt
  ServiceLink(ros::NodeHandle node, double wait_limit_s, const std::atomic<bool>* stop,
              double call_limit_s = kCallLimit_s)
      : node_(std::move(node)), wait_limit_s_(wait_limit_s), stop_(stop), limit_(call_limit_s) {}

  /// @throws EnvironmentLost when there is no answer within the limit
  template <typename Service>
  void Call(const std::string& name, Service& service) {
    const ros::WallTime start = ros::WallTime::now();
    for (;;) {
      if (!client_.isValid()) client_ = node_.serviceClient<Service>(name, true);
      if (client_.isValid() && limit_.Call(client_, service)) return;
      const bool stopped = !ros::ok() || (stop_ != nullptr && *stop_);
      if (stopped || (ros::WallTime::now() - start).toSec() >= wait_limit_s_) {
        throw aquafarm::agents::EnvironmentLost("sim node: no answer from service " +
                                                node_.resolveName(name));
      }
      ros::WallDuration(kRetryPeriod_s).sleep();
    }
  }

 private:
  inline static constexpr double kRetryPeriod_s = 0.1;

  ros::NodeHandle node_;
  double wait_limit_s_;
  const std::atomic<bool>* stop_;
  CallLimit limit_;
  ros::ServiceClient client_;
};

/// Limit of a ship's command, which may wait for those of the others.
inline double CommandLimit_s(double barrier_timeout_s) {
  return barrier_timeout_s + ServiceLink::kCallLimit_s;
}

}  // namespace aquafarm_agents
