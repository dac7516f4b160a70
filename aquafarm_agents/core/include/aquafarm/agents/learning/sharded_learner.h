// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// A learner whose farms may be divided into shards. The shards may be divided among the ranks of a
/// process group.
class ShardedLearner : public Learner {
 public:
  /// Returns the interval, in calls of Step, at which the trainer counts steps, saves and ends. 1
  /// with a single shard. With several shards it is the length of a rollout, so that the training
  /// ends at the same step with any number of ranks.
  virtual std::uint32_t sync_interval() const = 0;
};

}  // namespace aquafarm::agents
