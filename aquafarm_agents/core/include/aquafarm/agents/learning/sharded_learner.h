// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// A learner whose farms may be divided into shards, and these among the ranks of a process group.
class ShardedLearner : public Learner {
 public:
  /// Number of calls of Step between two at which the training may count, save and end. More than
  /// 1 if there are several shards: every number of ranks then stops at the same step.
  virtual std::uint32_t sync_interval() const = 0;
};

}  // namespace aquafarm::agents
