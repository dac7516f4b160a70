// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Ends loops of a trained policy on entity tokens (token_layout.h). A greedy policy that returns
/// to the same situation may repeat itself until the episode ends, for example in a bay whose exit
/// is far away and leads away from the port.
///
///   situation   cell, load and remaining devices
///   loop        a situation occurs for the max_visits-th time since the load or the remaining
///               devices changed
///   exit        until the load or the remaining devices change, the ship follows the route to the
///               target with the least cost (RouteRule), but only in steps in which the route has
///               no more risk per step than the safest cell near the ship. (If the risk is the same
///               everywhere, the ship follows the route.)

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

  /// Records an observation of a slot. Returns the action of the exit if the ship is in a loop and
  /// the route is safe; else nullopt.
  /// @param tokens one row of features
  /// @param is_first whether an episode begins with this observation
  /// @param allowed mask of the actions to choose from
  std::optional<std::uint8_t> ActionOf(std::size_t slot, const float* tokens, bool is_first,
                                       ActionMask allowed);

 private:
  struct Episode {
    std::unordered_map<std::uint64_t, std::int32_t> visits;  // by hash of the situation
    std::uint64_t task{};                                    // hash of load and remaining devices
    bool is_loop{};
  };

  std::vector<std::size_t> task_features_;  // features that identify load and remaining devices
  std::vector<std::size_t> cell_features_;  // features that identify the ship's cell
  const std::int32_t max_visits_;
  RouteRule rule_;
  std::vector<Episode> episodes_;  // by slot
};

}  // namespace aquafarm::agents
