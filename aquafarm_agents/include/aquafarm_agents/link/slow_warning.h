// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>

#include <string>

#include "aquafarm/base/mutex.h"

namespace aquafarm_agents {

/// Logs at most one warning per 5 s of wall time and drops all others. ROS_WARN_THROTTLE is not
/// used, because it counts ROS time, which may stand still. Thread-safe.
class SlowWarning {
 public:
  void Say(const std::string& text) {
    const aquafarm::MutexLock lock(mutex_);
    const ros::WallTime now = ros::WallTime::now();
    if ((now - said_at_).toSec() < kPeriod_s) return;
    said_at_ = now;
    ROS_WARN("%s", text.c_str());
  }

 private:
  inline static constexpr double kPeriod_s = 5.0;

  aquafarm::Mutex mutex_;
  ros::WallTime said_at_ AQUAFARM_GUARDED_BY(mutex_);
};

}  // namespace aquafarm_agents
