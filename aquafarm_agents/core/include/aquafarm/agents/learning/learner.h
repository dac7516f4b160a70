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

/// Thrown when learning cannot go on, such as at a loss that is no number; what() is one line.
class LearnerFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How a learner is getting on.
struct LearnerStatus {
  float loss{};         ///< mean square error of late (a moving average) [reward²]; NaN: none
  float exploration{};  ///< ε or temperature
  float learning_rate{};
};

/// Improves its values from what happens on N farms × S agents. Knows no farm and no transport.
class Learner {
 public:
  virtual ~Learner() = default;

  /// What it reads of Results; EncodingBits.
  virtual std::uint8_t encodings() const = 0;
  /// All its options with their values in force; equal for learners that learn alike.
  virtual std::string options() const = 0;

  /// Learns from the transition that ended in `results` (entries with started = 1 are none), then
  /// chooses the next actions, exploring. Only termination stops bootstrapping; truncation does
  /// not.
  /// @param progress of the run, [0, 1]; drives the schedules
  /// @param actions is resized to [N, S]
  /// @throws LearnerFailed
  virtual void Step(const Results& results, double progress,
                    std::vector<std::uint8_t>& actions) = 0;

  virtual LearnerStatus status() const = 0;

  /// What it would do now, exploring nothing: a snapshot that lives on its own.
  virtual std::unique_ptr<Policy> GreedyPolicy() const = 0;

  /// Adds what MakePolicy of the same algorithm needs.
  virtual void SavePolicy(Checkpoint& checkpoint) const = 0;
  /// Adds everything: a learner that loads it goes on bit for bit.
  virtual void Save(Checkpoint& checkpoint) const = 0;
  /// @throws InputError when sections are missing or do not fit
  virtual void Load(const Checkpoint& checkpoint) = 0;
};

}  // namespace aquafarm::agents
