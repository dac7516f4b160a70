// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Distances by water, in moves of a ship over free cells.

#include <cstdint>
#include <vector>

#include "aquafarm/layout.h"

namespace aquafarm::agents {

/// Stands for a cell that cannot be reached.
inline constexpr std::int32_t kUnreachable = 1 << 28;

/// Moves from the nearest of `sources` to every cell, [H, W] row-major; breadth first.
std::vector<std::int32_t> WaterDistance(const Layout& layout, std::int32_t width,
                                        std::int32_t height, const std::vector<Cell>& sources);

}  // namespace aquafarm::agents
