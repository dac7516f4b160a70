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

/// A persistent connection to a service, with timeouts. It reconnects after a failure.
class ServiceLink {
 public:
  inline static constexpr double kCallLimit_s = 30.0;

  /// @param wait_limit_s max time for which a failed call is repeated
  /// @param stop if true, Call makes no further attempt; null: calls cannot be stopped
  /// @param call_limit_s max duration of one attempt
  ServiceLink(const ros::NodeHandle& node, double wait_limit_s, const std::atomic<bool>* stop,
              double call_limit_s = kCallLimit_s)
      : node_(node),
        wait_limit_s_(wait_limit_s),
        stop_(stop),
        call_limit_s_(call_limit_s),
        limit_(call_limit_s) {}

  /// Calls the service, and repeats the call until the service responds.
  /// @throws EnvironmentLost if there is no response within the limit, or if the call is stopped
  template <typename Service>
  void Call(const std::string& name, Service& service) {
    ros::WallTime lost_since;
    for (;;) {
      const ros::WallTime begun = ros::WallTime::now();
      if (!client_.isValid()) client_ = node_.serviceClient<Service>(name, true);
      if (client_.isValid() && limit_.Call(client_, service)) return;
      const ros::WallTime now = ros::WallTime::now();
      // The wait starts at the end of the first failed attempt. If this attempt timed out, the wait
      // starts at the start of the attempt.
      if (lost_since.isZero()) lost_since = (now - begun).toSec() < call_limit_s_ ? now : begun;
      const bool stopped = !ros::ok() || (stop_ != nullptr && *stop_);
      if (stopped || (now - lost_since).toSec() >= wait_limit_s_) {
        throw aquafarm::agents::EnvironmentLost("sim node: no response from service " +
                                                node_.resolveName(name));
      }
      ros::WallDuration(kRetryPeriod_s).sleep();
    }
  }

 private:
  ros::NodeHandle node_;
  double wait_limit_s_;
  const std::atomic<bool>* stop_;
  double call_limit_s_;
  CallLimit limit_;
  ros::ServiceClient client_;
};

/// Returns the timeout of a ship's command, which may wait for the commands of the other ships.
inline double CommandLimit_s(double barrier_timeout_s) {
  return barrier_timeout_s + ServiceLink::kCallLimit_s;
}

}  // namespace aquafarm_agents
