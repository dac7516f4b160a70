// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

/// Thrown when learning cannot continue, for example after a non-finite loss. what() is one line.
class LearnerFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Training statistics of a learner.
struct LearnerStatus {
  float loss{};  ///< moving average of the squared error of the learned values [reward²]; NaN
                 ///< before the first update
  float exploration{};  ///< ε, temperature, or the mean entropy of the policy [nats]
  float learning_rate{};
};

/// Learns from the transitions of N farms with S agents each. It does not depend on how the farms
/// are simulated or reached.
class Learner {
 public:
  virtual ~Learner() = default;

  /// Returns the observation types that the learner requires, a mask of ObservationTypeBits.
  virtual std::uint8_t observation_types() const = 0;
  /// Returns the options with their effective values, as key=value pairs. Learners of the same
  /// algorithm with equal options and seeds learn identically on the same farms.
  virtual std::string options() const = 0;

  /// Learns from the transitions that ended in `results`, and chooses the next exploratory actions.
  /// A farm with is_first = 1 has no transition. Targets bootstrap after truncation, but not after
  /// termination.
  /// @param progress fraction of the run that is done, [0, 1]; determines the schedules
  /// @param actions is resized to [N, S]
  /// @throws LearnerFailed if learning cannot continue
  virtual void Step(const StepResults& results, double progress,
                    std::vector<std::uint8_t>& actions) = 0;

  /// Returns the current training statistics.
  virtual LearnerStatus status() const = 0;

  /// Returns a copy of the current policy. Later learning does not change the copy. The copy
  /// acts greedily, unless the learner is RANDOM, or PPO or MAPPO with policy=sampled.
  virtual std::unique_ptr<Policy> GreedyPolicy() const = 0;

  /// Adds the sections from which Algorithm::make_policy makes the policy.
  virtual void SavePolicy(Checkpoint& checkpoint) const = 0;
  /// Adds the complete state. A learner restored from it continues bit-identically.
  virtual void Save(Checkpoint& checkpoint) const = 0;
  /// Restores the state saved by Save. @throws InputError if sections are missing or do not fit
  virtual void Load(const Checkpoint& checkpoint) = 0;
};

}  // namespace aquafarm::agents
