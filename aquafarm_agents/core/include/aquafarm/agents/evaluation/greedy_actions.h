// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What a policy would do, and what it thinks that is worth, if ship 0 were elsewhere: the arrows
/// of Fig. 11 and the map of V_π.

#include <atomic>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "aquafarm/agents/environment/policy.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// The best action in a cell.
struct BestMove {
  Cell cell{};
  std::uint8_t action{};
  float value{std::numeric_limits<float>::quiet_NaN()};  ///< NaN: the policy holds no values
};

/// Farms with more cells get no best moves.
inline constexpr std::int32_t kMaxCells = 10000;

/// Why farms of a scenario get no best moves, in words; empty: they do.
std::string WhyNoBestMoves(const Scenario& scenario);

/// The greedy action of ship 0 in every free cell of a farm as it stands, south-west first, row by
/// row; other ships stay where they are.
/// @param policy is begun anew: one with a memory is asked with an empty one
/// @param stop ends it early, with the cells done so far; null: never
/// @throws InputError when the policy does not fit
std::vector<BestMove> BestMoves(const Farm& farm, std::uint8_t encodings, Policy& policy,
                                const std::atomic<bool>* stop = nullptr);

}  // namespace aquafarm::agents
