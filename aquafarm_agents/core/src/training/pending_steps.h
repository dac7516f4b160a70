// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

/// Farm steps and finished episodes that the training has not counted yet. They are the results of
/// several calls of Environment::Step.
class PendingSteps {
 public:
  /// Adds the results of one call.
  void Add(const StepResults& results);
  void Clear();
  /// Number of calls of Add since the last Clear.
  std::size_t calls() const { return steps_.size(); }
  /// Farm steps of a call. @param call [0, calls())
  std::uint64_t steps(std::size_t call) const { return steps_[call]; }

  /// Calls visit(episode) for the episodes that ended in a call, ordered by farm.
  template <typename Visit>
  void VisitFinished(std::size_t call, const Visit& visit) const {
    for (std::size_t i = 0; i < finished_.size(); ++i) {
      if (calls_[i] == call) visit(finished_[i]);
    }
  }

  /// Returns bytes for another rank, which must run the same program.
  std::string ToBytes() const;
  /// Restores the steps from the bytes of ToBytes. @throws InputError if there are too few bytes
  static PendingSteps FromBytes(const std::string& bytes);

 private:
  std::vector<std::uint64_t> steps_;      // by call: farm steps
  std::vector<std::uint64_t> calls_;      // by finished episode: index of its call
  std::vector<EpisodeSummary> finished_;  // ordered by call, then by farm
};

}  // namespace aquafarm::agents
