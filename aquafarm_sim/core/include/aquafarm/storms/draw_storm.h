// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws the storm of an episode from the storms of a scenario.

#include <cstdint>
#include <vector>

#include "aquafarm/scenario/scenario.h"
#include "aquafarm/tracks/place_storm.h"

namespace aquafarm {

/// A storm of an archive and its random changes in one episode: position, time, wind and size.
struct DrawnStorm {
  const ArchivedStorm* storm{};
  StormErrors errors;
};

/// Returns the storms from which a seed draws. An evaluation seed (rng.h) draws from the evaluation
/// years, and any other seed from the years for training.
const std::vector<ArchivedStorm>& StormsOf(const StormsSpec& storms, std::uint64_t seed);

/// Draws one of the storms of StormsOf, all with equal probability, and its changes. The time of
/// the closest approach to (x, y) is storms.approach_h hours after step 0, shifted by at most
/// perturbation.start_h hours to either side.
/// @param disaster id of the disaster
/// @param x, y middle of the farm [cells]
DrawnStorm DrawStorm(const StormsSpec& storms, std::uint64_t seed, std::uint64_t episode,
                     std::int32_t disaster, double x, double y);

}  // namespace aquafarm
