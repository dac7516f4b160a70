// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// A learner whose farms may be divided into groups (shards). The shards may be divided among the
/// ranks of a process group.
class ShardedLearner : public Learner {
 public:
  /// Returns the number of calls of Step between two points at which the trainer may count steps,
  /// save and end. The number is 1 for a single shard. For several shards it is the length of a
  /// rollout, so that the training ends at the same step with any number of ranks.
  virtual std::uint32_t sync_interval() const = 0;
};

}  // namespace aquafarm::agents
