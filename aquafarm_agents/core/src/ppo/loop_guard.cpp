// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/loop_guard.h"

#include <string>

#include "aquafarm/agents/base/text.h"
#include "aquafarm/base/hash.h"

namespace aquafarm::agents {

LoopGuard::LoopGuard(const EnvironmentSpec& spec, std::size_t slots, std::int32_t max_visits)
    : max_visits_(max_visits), rule_(LayoutOfTokens(spec.feature_names)), episodes_(slots) {
  for (std::size_t i = 0; i < spec.feature_names.size(); ++i) {
    const std::string& name = spec.feature_names[i];
    const bool is_device = name.rfind("device", 0) == 0;
    const bool is_port = name.rfind("port", 0) == 0;
    const bool is_state = EndsWith(name, ".deployed") || EndsWith(name, ".aboard");
    if (name == "ship.free_capacity" || (is_device && is_state)) task_features_.push_back(i);
    // Ports do not move: their relative positions identify the cell of the ship. The features are
    // clamped at 64 cells. At greater distances from all ports, several cells look the same.
    if (is_port && (EndsWith(name, ".east") || EndsWith(name, ".north"))) {
      cell_features_.push_back(i);
    }
  }
}

std::optional<std::uint8_t> LoopGuard::ActionOf(std::size_t slot, const float* tokens,
                                                bool is_first, ActionMask allowed) {
  Episode& episode = episodes_[slot];
  Hasher hasher;
  for (const std::size_t i : task_features_) hasher.Add(tokens[i], 0.0F);
  const std::uint64_t task = hasher.value();
  for (const std::size_t i : cell_features_) hasher.Add(tokens[i], 0.0F);
  if (is_first || task != episode.task) {
    episode.visits.clear();
    episode.task = task;
    episode.is_loop = false;
  }
  if (++episode.visits[hasher.value()] >= max_visits_) episode.is_loop = true;
  if (!episode.is_loop) return std::nullopt;
  return rule_.SafeActionOf(tokens, allowed);
}

}  // namespace aquafarm::agents
