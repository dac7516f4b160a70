// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Distances by water, in moves of a ship over free cells.

#include <cstdint>
#include <vector>

#include "aquafarm/farm/layout.h"

namespace aquafarm::agents {

/// Of any disaster or sea: a scenario's risks are in [-20, -5].
inline constexpr double kMildestRisk = -5.0;

/// Moves from the nearest of `sources` to every cell, [H, W] row-major; kUnreachable on land.
std::vector<std::int32_t> WaterDistance(const Layout& layout, const std::vector<Cell>& sources);

}  // namespace aquafarm::agents
