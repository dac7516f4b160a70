// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"

namespace aquafarm::agents {

/// Farm steps and finished episodes of several calls of Environment::Step that the training has not
/// counted yet.
class PendingSteps {
 public:
  void Add(const StepResults& results);
  void Clear();
  /// Number of calls of Add since the last Clear.
  std::size_t calls() const { return steps_.size(); }
  /// Farm steps of a call.
  std::uint64_t steps(std::size_t call) const { return steps_[call]; }

  /// Calls visit(episode) for the episodes that ended in a call, ordered by farm.
  template <typename Visit>
  void VisitFinished(std::size_t call, const Visit& visit) const {
    for (std::size_t i = 0; i < finished_.size(); ++i) {
      if (calls_[i] == call) visit(finished_[i]);
    }
  }

  /// Bytes for another rank that runs the same program.
  std::string ToBytes() const;
  /// @throws InputError if the bytes are not those of ToBytes
  static PendingSteps FromBytes(const std::string& bytes);

 private:
  std::vector<std::uint64_t> steps_;      // by call
  std::vector<std::uint64_t> calls_;      // by finished episode
  std::vector<EpisodeSummary> finished_;  // by call, then by farm
};

}  // namespace aquafarm::agents
