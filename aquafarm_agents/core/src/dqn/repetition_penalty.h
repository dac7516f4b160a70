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

/// Ends going to and fro while exploring: an action counts as worth a penalty less for each time
/// that it was taken in the same situation (cell, load, devices still out) of this episode. Where
/// errors of a network make a ship step aside and back from what it should pick up, the pickup's
/// turn comes soon, and is learnt from. (Counts of an episode: Badia et al. 2020, there as a
/// reward.)
class RepetitionPenalty {
 public:
  /// @param penalty each time, on the scale of the values; 0: none, and nothing is kept
  RepetitionPenalty(const EnvironmentSpec& spec, double penalty);

  /// Forgets the episodes that are over.
  void Begin(const StepResults& results);
  /// @param values [kActionCount]
  /// @param features of the agent, a row of Results::features
  /// @returns [kActionCount] what they are worth yet, valid until the next call
  const float* Penalize(const float* values, const float* features, std::size_t entry);
  /// Planes tell no situation; DeepOptions refuses a penalty with them.
  const float* Penalize(const float* values, const std::uint8_t*, std::size_t) { return values; }
  /// The action that came of the last Penalize.
  void Add(std::uint8_t action, std::size_t entry);

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError when it is not of as many entries
  void Load(const Checkpoint& checkpoint);

 private:
  static constexpr std::size_t kRemembered = 1024;  // steps of an episode, the last ones

  std::uint64_t SituationOf(const float* features) const;

  std::size_t agents_;
  float penalty_;
  std::vector<std::size_t> telling_;  // features that tell situations apart
  std::vector<std::uint64_t> done_;   // [entries, kRemembered] situation and action
  std::vector<std::uint64_t> turn_;   // [entries] steps since the episode began
  std::uint64_t situation_{};         // of the last Penalize
  std::array<float, kActionCount> values_{};
};

}  // namespace aquafarm::agents
