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
  float loss{};         ///< moving average of the squared TD error [reward²]; NaN before the first
  float exploration{};  ///< ε, temperature, or mean entropy of a policy [nats]
  float learning_rate{};
};

/// Learns from the transitions of N farms × S agents. Independent of the simulator and the
/// transport.
class Learner {
 public:
  virtual ~Learner() = default;

  /// The observation types it requires, a mask of ObservationTypeBits.
  virtual std::uint8_t observation_types() const = 0;
  /// All options with their effective values. Learners with equal options learn identically.
  virtual std::string options() const = 0;

  /// Learns from the transition that ended in `results`, then chooses the next exploratory actions.
  /// Slots with is_first = 1 hold no transition and are skipped. Only termination stops
  /// bootstrapping; truncation does not.
  /// @param progress of the run, [0, 1]; drives the schedules
  /// @param actions is resized to [N, S]
  /// @throws LearnerFailed
  virtual void Step(const StepResults& results, double progress,
                    std::vector<std::uint8_t>& actions) = 0;

  virtual LearnerStatus status() const = 0;

  /// Snapshot of the current greedy policy. It is independent of the learner's lifetime.
  virtual std::unique_ptr<Policy> GreedyPolicy() const = 0;

  /// Adds the sections that MakePolicy of the same algorithm needs.
  virtual void SavePolicy(Checkpoint& checkpoint) const = 0;
  /// Adds the complete state: a learner restored from it continues bit-identically.
  virtual void Save(Checkpoint& checkpoint) const = 0;
  /// Restores the state saved by Save. @throws InputError if sections are missing or do not fit
  virtual void Load(const Checkpoint& checkpoint) = 0;
};

}  // namespace aquafarm::agents
