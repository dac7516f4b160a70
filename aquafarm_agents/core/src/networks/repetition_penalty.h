// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {

/// Discourages oscillation. The value (or logit) of an action is reduced by a penalty for each time
/// that the agent took it in the same situation (cell, load, remaining devices) of this episode. If
/// errors of the network make a ship move back and forth over the cell of a device, the ship soon
/// tries the pickup. Only the last 1024 steps of the episode are counted. (Badia et al. 2020 use
/// such counts within an episode for a reward.)
class RepetitionPenalty {
 public:
  /// @param penalty for each repetition, on the scale of the values; 0 disables the penalty
  RepetitionPenalty(const EnvironmentSpec& spec, double penalty);

  /// Clears the records of farms that start an episode in `results`.
  void Begin(const StepResults& results);
  /// Subtracts the penalties from the values of one agent.
  /// @param values [kActionCount]
  /// @param features of the agent, a row of StepResults::features
  /// @returns penalized values [kActionCount], valid until the next call
  const float* Penalize(const float* values, const float* features, std::size_t slot);
  /// Returns `values`. Planes do not identify a situation, so DeepOptions rejects a penalty with
  /// them.
  const float* Penalize(const float* values, const std::uint8_t*, std::size_t) { return values; }
  /// Records the action that the agent chose after the last Penalize, which must have been for
  /// `slot`.
  void Add(std::uint8_t action, std::size_t slot);

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or the number of slots differs
  void Load(const Checkpoint& checkpoint);

 private:
  // Number of latest steps of an episode that are counted.
  static constexpr std::size_t kRemembered = 1024;

  std::uint64_t SituationOf(const float* features) const;

  std::size_t agents_;
  float penalty_;
  std::vector<std::size_t> described_;  // indices of the features that identify a situation
  std::vector<std::uint64_t> done_;     // [slots, kRemembered] situation | action, a ring per slot
  std::vector<std::uint64_t> steps_;    // [slots] steps since the episode began
  std::uint64_t situation_{};           // SituationOf() in the last Penalize
  std::array<float, kActionCount> values_{};
};

}  // namespace aquafarm::agents
