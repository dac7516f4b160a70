// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm_agents {

/// Publishes V_π and the best move of each cell of farm 0 as it stands (`values`, latched, and
/// `values/points`, latched), while somebody subscribes. A thread of low priority does it, and
/// rests nine times as long as it worked, so that playing and training do not wait for it.
class ValuesPublisher {
 public:
  /// @param period_s between two looks, at least; 0: never
  ValuesPublisher(const ros::NodeHandle& node, double period_s);
  ~ValuesPublisher();
  ValuesPublisher(const ValuesPublisher&) = delete;
  ValuesPublisher& operator=(const ValuesPublisher&) = delete;

  /// Takes a newer policy when it would be looked at soon. Learners copy theirs for it, so that is
  /// asked for no more often than to take a fiftieth of the caller's time.
  void Refresh(const std::function<std::unique_ptr<aquafarm::agents::Policy>()>& make);

  /// Takes a policy of its own from now on. One that knows the whole farm (a planner) or looks at
  /// nothing (random) holds no values and is left aside.
  void Offer(std::unique_ptr<aquafarm::agents::Policy> policy);

 private:
  using Clock = std::chrono::steady_clock;
  bool IsWatched() const;
  void Run();
  void Look(aquafarm::agents::Policy& policy);

  ros::NodeHandle node_;
  const std::chrono::duration<double> period_;
  ros::Publisher grid_;
  ros::Publisher points_;
  std::unique_ptr<aquafarm::FarmBatch> farms_;  // as the sim node's; only the thread touches them
  std::string frame_;
  Clock::time_point copy_due_;  // only the caller of Refresh touches it

  std::mutex mutex_;  // guards the rest
  std::condition_variable changed_;
  std::shared_ptr<aquafarm::agents::Policy> policy_;
  Clock::time_point due_;
  std::atomic<bool> ending_{};
  std::thread thread_;
};

}  // namespace aquafarm_agents
