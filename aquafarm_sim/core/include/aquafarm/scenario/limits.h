// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Limits of scenarios and farms.

#include <cstdint>

namespace aquafarm {

/// Max number of rings (radius and risk pairs) of one disaster.
inline constexpr int kMaxRings = 4;
/// Max width and height of a farm [cells].
inline constexpr int kMaxSide = 4096;
/// Max number of disasters of a farm, including those added by bulletins.
inline constexpr std::int32_t kMaxDisasters = 64;
/// Max number of rescue ships of a farm.
inline constexpr std::int32_t kMaxShips = 64;
/// Max number of farms of one simulator node.
inline constexpr std::int32_t kMaxFarms = 4096;
/// Bounds of the risk in a disaster's rings, [kWorstRisk, kMildestRisk] (paper §2.1, see
/// docs/model.md).
inline constexpr float kWorstRisk = -20.0F;
inline constexpr float kMildestRisk = -5.0F;

}  // namespace aquafarm
