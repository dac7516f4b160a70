// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Generated ranches. A scenario with the key `family` describes a family of ranches, and every
/// episode draws another ranch of the family. The other keys of the scenario apply to every ranch,
/// unless DrawRanch draws their values.

#include <cstdint>

#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Max length of an episode on a ranch with generated disasters [steps].
inline constexpr std::int32_t kMaxRanchSteps = 3000;

/// Draws the ranch of an episode; a pure function of its arguments. The ranch has a fixed layout
/// and no family, so ToYaml writes it as an ordinary scenario. Evaluation seeds (rng.h) draw other
/// ranches than training seeds.
///
///   map          width and height; island blocks, which may overlap; on coast_share of the ranches
///                a coast along one side; rocks in proportion to the number of cells
///   devices      placed at random, in rows or evenly; kinds in turn, starting with a random kind
///   disasters    of all kinds, with one to three rings, that wander, grow or shrink; on
///                storm_share of the ranches the scenario's own disasters instead
///   duration     of episodes with generated disasters: the time that one ship needs to fetch all
///                devices, roughly estimated, times a random factor in [1, 2]
///
/// @param family scenario with Scenario::family
/// @param attempt from 0; if the layout of the ranch cannot be drawn, the caller draws another
///   ranch with the next attempt
/// @throws InputError if the parts of the ranch do not fit on its map
Scenario DrawRanch(const Scenario& family, std::uint64_t seed, std::uint64_t episode,
                   std::uint32_t attempt);

}  // namespace aquafarm
