// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

/// Interface of learners that can start with the weights of a saved policy (fine-tuning).
class WarmStart {
 public:
  virtual ~WarmStart() = default;
  /// Replaces the initial weights by those of a checkpoint, which contains a policy or the state of
  /// a training. The checkpoint must be of the same algorithm as the learner.
  /// @throws InputError if the features or the network of the checkpoint differ from those of the
  ///   learner; the weights are then unchanged
  virtual void LoadWeights(const Checkpoint& checkpoint) = 0;
};

}  // namespace aquafarm::agents
