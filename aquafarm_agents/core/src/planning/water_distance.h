// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Distances by water: number of moves over free cells.

#include <cstdint>
#include <vector>

#include "aquafarm/farm/layout.h"

namespace aquafarm::agents {

/// Mildest risk of any disaster or sea field: the risks of a scenario are in [-20, -5].
inline constexpr double kMildestRisk = -5.0;

/// Returns the moves from the nearest of `sources` to every cell, [H, W] row-major; kUnreachable on
/// land.
std::vector<std::int32_t> WaterDistance(const Layout& layout, const std::vector<Cell>& sources);

}  // namespace aquafarm::agents
