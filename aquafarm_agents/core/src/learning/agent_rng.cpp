// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/agent_rng.h"

#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

AgentRng::AgentRng(std::uint64_t seed, std::size_t slots, std::size_t first) {
  streams_.reserve(slots);
  for (std::size_t i = 0; i < slots; ++i) {
    streams_.emplace_back(
        StreamKey{seed, 0, RngStream::kExploration, static_cast<std::uint32_t>(first + i)});
  }
}

void AgentRng::Save(Checkpoint& checkpoint) const {
  std::vector<std::uint64_t> positions;
  positions.reserve(streams_.size());
  for (const RandomStream& stream : streams_) positions.push_back(stream.position());
  checkpoint.SetArray("streams", positions);
}

void AgentRng::Load(const Checkpoint& checkpoint) {
  std::vector<std::uint64_t> positions;
  checkpoint.GetArray("streams", streams_.size(), positions);
  for (std::size_t i = 0; i < streams_.size(); ++i) streams_[i].Seek(positions[i]);
}

}  // namespace aquafarm::agents
