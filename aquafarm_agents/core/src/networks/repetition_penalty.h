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
/// that it was taken in the same situation (cell, load, remaining devices) of this episode. If
/// errors of the network make a ship move back and forth next to a device, the pickup is soon
/// tried. (Episodic counts: Badia et al. 2020, there as a reward.)
class RepetitionPenalty {
 public:
  /// @param penalty per repetition, on the scale of the values; 0 disables it and stores nothing
  RepetitionPenalty(const EnvironmentSpec& spec, double penalty);

  /// Clears the records of episodes that ended.
  void Begin(const StepResults& results);
  /// @param values [kActionCount]
  /// @param features of the agent, a row of StepResults::features
  /// @returns penalized values [kActionCount], valid until the next call
  const float* Penalize(const float* values, const float* features, std::size_t slot);
  /// Planes do not identify a situation; DeepOptions rejects a penalty with them.
  const float* Penalize(const float* values, const std::uint8_t*, std::size_t) { return values; }
  /// Records the action chosen after the last Penalize.
  void Add(std::uint8_t action, std::size_t slot);

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if the number of slots differs
  void Load(const Checkpoint& checkpoint);

 private:
  static constexpr std::size_t kRemembered = 1024;  // most recent steps of an episode

  std::uint64_t SituationOf(const float* features) const;

  std::size_t agents_;
  float penalty_;
  std::vector<std::size_t> described_;  // features that identify a situation
  std::vector<std::uint64_t> done_;     // [slots, kRemembered] situation and action
  std::vector<std::uint64_t> steps_;    // [slots] steps since the episode began
  std::uint64_t situation_{};           // situation of the last Penalize
  std::array<float, kActionCount> values_{};
};

}  // namespace aquafarm::agents
