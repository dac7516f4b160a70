// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Greedy action and value estimate of a policy for each cell in which ship 0 can be placed. Fig.
/// 11 of the paper shows such actions as arrows. A map of V_π shows the values.

#include <atomic>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Greedy action in a cell.
struct GreedyAction {
  Cell cell{};
  std::uint8_t action{};
  float value{std::numeric_limits<float>::quiet_NaN()};  ///< NaN if the policy has no values
};

/// Max number of cells of a farm for which GreedyActions is supported.
inline constexpr std::int32_t kMaxCells = 10000;

/// Returns the reason why GreedyActions does not support the farms of a scenario; empty if it
/// supports them.
std::string WhyNoBestMoves(const Scenario& scenario);

/// Returns the greedy action of ship 0 in every free cell of a farm in its present state, row by
/// row from the south-west. Other ships keep their cells. Empty if WhyNoBestMoves returns a reason
/// or if ship 0 is not active.
/// @param policy is reset before it acts, so that a recurrent policy starts from an empty state
/// @param stop may be set by a signal handler; the function then returns only the cells computed so
///   far. Null if it cannot be stopped
/// @throws InputError if the scenario does not support the observation types
std::vector<GreedyAction> GreedyActions(const Farm& farm, std::uint8_t observation_types,
                                        Policy& policy, const std::atomic<bool>* stop = nullptr);

}  // namespace aquafarm::agents
