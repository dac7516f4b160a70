// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Ends loops of a trained policy on entity tokens (token_layout.h). A greedy policy repeats itself
/// for ever if it chooses the same actions in the same situations, for example in a bay whose way
/// out is long and leads away from the port.
///
///   situation   cell, load and remaining devices
///   loop        a situation occurs for the max_visits-th time in an episode
///   way out     the route to the nearest target (RouteRule) while it has no more risk per step
///               than the safest cell near the ship, until a device is picked up or dropped off.
///               Under a ring over the whole ranch a ship that waits pays as much as one that
///               works.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "ppo/route_rule.h"

namespace aquafarm::agents {

class LoopGuard {
 public:
  /// @param slots farms × agents @param max_visits at least 1
  /// @throws InputError if the features are not entity tokens
  LoopGuard(const EnvironmentSpec& spec, std::size_t slots, std::int32_t max_visits);

  /// Records an observation and returns the action that leads out of a loop, if the ship is in one.
  /// @param tokens one row of features @param is_first an episode begins with this observation
  std::optional<std::uint8_t> ActionOf(std::size_t slot, const float* tokens, bool is_first,
                                       ActionMask allowed);

 private:
  struct Episode {
    std::unordered_map<std::uint64_t, std::int32_t> visits;  // by situation
    std::uint64_t task{};                                    // load and remaining devices
    bool is_loop{};
  };

  std::vector<std::size_t> task_features_;
  std::vector<std::size_t> cell_features_;
  const std::int32_t max_visits_;
  RouteRule rule_;
  std::vector<Episode> episodes_;  // of each slot
};

}  // namespace aquafarm::agents
