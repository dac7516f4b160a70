// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Distances by water: numbers of moves over cells without rocks and islands.

#include <cstdint>
#include <vector>

#include "aquafarm/farm/layout.h"

namespace aquafarm::agents {

/// Mildest risk of any disaster or sea. Every risk that is not 0 is in [-20, -5] (paper §2.1, see
/// docs/model.md).
inline constexpr double kMildestRisk = -5.0;

/// Returns the min moves from any of `sources` to each cell, [H, W] row-major; kUnreachable for a
/// cell that no source reaches.
std::vector<std::int32_t> WaterDistance(const Layout& layout, const std::vector<Cell>& sources);

}  // namespace aquafarm::agents
