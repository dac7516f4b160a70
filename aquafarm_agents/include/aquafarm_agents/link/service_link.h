// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/init.h>
#include <ros/node_handle.h>

#include <atomic>
#include <string>
#include <utility>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm_agents/link/call_limit.h"

namespace aquafarm_agents {

/// One persistent connection to a service, made again when it breaks, with limits.
class ServiceLink {
 public:
  inline static constexpr double kCallLimit_s = 30.0;

  /// @param wait_limit_s for an answer after the first attempt was lost
  /// @param stop may be set by a signal handler; null: never
  /// @param call_limit_s for an answer to one attempt
  ServiceLink(ros::NodeHandle node, double wait_limit_s, const std::atomic<bool>* stop,
              double call_limit_s = kCallLimit_s)
      : node_(std::move(node)),
        wait_limit_s_(wait_limit_s),
        stop_(stop),
        call_limit_s_(call_limit_s),
        limit_(call_limit_s) {}

  /// @throws EnvironmentLost when there is no answer within the limit
  template <typename Service>
  void Call(const std::string& name, Service& service) {
    ros::WallTime lost_since;
    for (;;) {
      const ros::WallTime begun = ros::WallTime::now();
      if (!client_.isValid()) client_ = node_.serviceClient<Service>(name, true);
      if (client_.isValid() && limit_.Call(client_, service)) return;
      const ros::WallTime now = ros::WallTime::now();
      // An answer may be long in coming; only one that never came counts from the call on.
      if (lost_since.isZero()) lost_since = (now - begun).toSec() < call_limit_s_ ? now : begun;
      const bool stopped = !ros::ok() || (stop_ != nullptr && *stop_);
      if (stopped || (now - lost_since).toSec() >= wait_limit_s_) {
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
  double call_limit_s_;
  CallLimit limit_;
  ros::ServiceClient client_;
};

/// Limit of a ship's command, which may wait for those of the others.
inline double CommandLimit_s(double barrier_timeout_s) {
  return barrier_timeout_s + ServiceLink::kCallLimit_s;
}

}  // namespace aquafarm_agents
