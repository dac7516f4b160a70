// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The name and the pattern with which pictures show each kind of disaster (DisasterState.kind).

#include <cstddef>
#include <cstdint>
#include <string>

namespace aquafarm_viz {

/// Returns the number of kinds.
std::size_t DisasterKindCount();

/// Returns the name of a kind, such as "red tide"; "disaster" for an unknown kind.
std::string DisasterName(std::uint8_t kind);

/// Returns the distance of a pixel to the nearest line of a kind's pattern [pixels], or to the
/// nearest dot in the nearest row of dots. For the kind wave, it is the distance along y. It is 0
/// within 0.8 pixels of the centre of a dot. The pattern repeats after two periods on both axes. An
/// unknown kind has the pattern of the last kind.
/// @param period distance between lines along an axis [pixels]
float DistanceToPattern(std::uint8_t kind, int x, int y, int period);

}  // namespace aquafarm_viz
