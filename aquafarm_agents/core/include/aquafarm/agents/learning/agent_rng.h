// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

struct Checkpoint;

/// What each agent of each farm draws its exploration from: entry i from stream i of (seed,
/// exploration). Saved and loaded it goes on bit for bit.
class EntryStreams {
 public:
  EntryStreams() = default;
  EntryStreams(std::uint64_t seed, std::size_t entries);

  std::size_t size() const { return streams_.size(); }
  RandomStream& operator[](std::size_t entry) { return streams_[entry]; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError when it is not of as many entries
  void Load(const Checkpoint& checkpoint);

 private:
  std::vector<RandomStream> streams_;
};

}  // namespace aquafarm::agents
