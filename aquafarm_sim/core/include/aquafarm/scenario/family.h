// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Generated ranches: a scenario with `family` describes a family of ranches, of which every
/// episode draws another one. The scenario's other keys hold for all of them.

#include <cstdint>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Max length of an episode on a ranch with generated disasters [steps].
inline constexpr std::int32_t kMaxRanchSteps = 3000;

/// Draws the ranch of an episode, a pure function of its arguments. Its layout is fixed, so its
/// file (ToYaml) is an ordinary scenario. Evaluation seeds (rng.h) draw other ranches than training
/// seeds.
///
///   map          width and height; island blocks, of which some overlap, and on a share of ranches
///                a coast along one side; rocks in proportion to the cells
///   devices      at random, in rows or evenly spread; kinds in random order
///   disasters    of all kinds, with one to three rings, that wander, grow or shrink; or, on
///                storm_share of the ranches, the scenario's own disasters, such as archive storms
///   duration     enough for all trips of the ships, times a factor in [1, 2]
///
/// @param family with Scenario::family @param attempt a ranch without a valid layout is drawn again
///   with the next attempt
/// @throws InputError when its parts do not fit its map
Scenario DrawRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode,
                   std::uint32_t attempt);

}  // namespace aquafarm
