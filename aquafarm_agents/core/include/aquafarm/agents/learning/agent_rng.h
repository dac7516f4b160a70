// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

struct Checkpoint;

/// Random streams for exploration, one for each slot (agent of a farm). Slot i draws from stream
/// first + i of (seed, RngStream::kExploration). Restored streams continue bit-identically.
class AgentRng {
 public:
  AgentRng() = default;
  /// @param first number of the stream of slot 0
  AgentRng(std::uint64_t seed, std::size_t slots, std::size_t first = 0);

  std::size_t size() const { return streams_.size(); }
  RandomStream& operator[](std::size_t slot) { return streams_[slot]; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if the section is missing or the number of slots differs
  void Load(const Checkpoint& checkpoint);

 private:
  std::vector<RandomStream> streams_;
};

}  // namespace aquafarm::agents
