// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Generated ranches. A scenario with the key `family` describes a family of ranches, and every
/// episode draws another ranch of the family. The other keys of the scenario apply to every ranch,
/// except those that DrawRanch draws.

#include <cstdint>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Max length of an episode on a ranch without the scenario's own disasters [steps].
inline constexpr std::int32_t kMaxRanchSteps = 3000;

/// Draws the ranch of an episode; a pure function of its arguments. The ranch has a fixed layout
/// and no family, so ToYaml writes it as an ordinary scenario.
///
///   map          width and height; ports; island blocks, which may overlap; rocks in proportion to
///                the number of cells; a coast along one side on coast_share of the ranches
///   ships        capacity
///   devices      placed at random, in rows or evenly; kinds in turn, starting with a random kind
///   damage       exposure_damage
///   disasters    of all kinds, with one to three rings; they wander, and some grow or shrink.
///                storm_share of the ranches have the scenario's own disasters instead.
///   step_limit   a rough estimate of the time in which one ship fetches all devices, times a
///                random factor in [1, 2]. Each generated disaster lasts step_limit steps. Ranches
///                with the scenario's own disasters keep the step_limit of the scenario.
///
/// @param family scenario with Scenario::family
/// @param attempt 0 for the first ranch. If the layout of this ranch cannot be drawn, the caller
///   draws another ranch with attempt 1, and so on.
/// @throws InputError if the parts of the ranch do not fit on its map
Scenario DrawRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode,
                   std::uint32_t attempt);

}  // namespace aquafarm
