// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// How pictures show each kind of disaster (DisasterState.kind): its name and its pattern of lines.

#include <cstddef>
#include <cstdint>
#include <string>

namespace aquafarm_viz {

/// Number of kinds.
std::size_t DisasterKindCount();

/// The name of a kind, such as "red tide"; "disaster" for an unknown one.
std::string DisasterName(std::uint8_t kind);

/// Distance of a pixel to the nearest line of a kind's pattern [pixels]. The pattern repeats after
/// two periods on both axes. An unknown kind has the pattern of the last one.
/// @param period distance between lines [pixels]
float DistanceToPattern(std::uint8_t kind, int x, int y, int period);

}  // namespace aquafarm_viz
