// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/base/mutex.h"
#include "aquafarm/observation/farm_batch.h"

namespace aquafarm_agents {

/// Publishes V_π and the greedy action of ship 0 in each free cell of farm 0, for the farm's
/// current state. The topics are `values` and `values/points`, both latched. A low-priority thread
/// computes the messages while there are subscribers. The pause after a computation is at least
/// nine times as long as the computation, so that the thread hardly slows down playing and
/// training. Publishes nothing for farms of more than kMaxCells (greedy_actions.h) cells.
class ValuesPublisher {
 public:
  /// @param period_s min time between the starts of two computations; 0: nothing is published
  ValuesPublisher(const ros::NodeHandle& node, double period_s);
  ~ValuesPublisher();
  ValuesPublisher(const ValuesPublisher&) = delete;
  ValuesPublisher& operator=(const ValuesPublisher&) = delete;

  /// Replaces the policy if there are subscribers and a publication is due.
  /// @param make returns a copy of the learner's policy. It is called so rarely that it takes at
  ///        most a fiftieth of the caller's time
  void Refresh(const std::function<std::unique_ptr<aquafarm::agents::Policy>()>& make);

  /// Replaces the policy. Ignores policies that cannot have values: those that read the complete
  /// farm state, such as planners, and those that read no observation, such as do_nothing.
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
  std::unique_ptr<aquafarm::FarmBatch> farms_;  // copies of the sim node's farms, for thread_ only
  std::string frame_;
  Clock::time_point copy_due_;  // used only by the caller of Refresh

  aquafarm::Mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<aquafarm::agents::Policy> policy_ AQUAFARM_GUARDED_BY(mutex_);
  Clock::time_point due_ AQUAFARM_GUARDED_BY(mutex_);
  std::atomic<bool> ending_{};
  std::thread thread_;
};

}  // namespace aquafarm_agents
