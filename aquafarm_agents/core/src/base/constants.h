// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace aquafarm::agents {

/// Seconds per hour.
inline constexpr std::int64_t kHour_s = 3600;
/// Half the width of the central 95 % interval of a normal distribution, in standard deviations.
inline constexpr double kNormal95 = 1.96;

}  // namespace aquafarm::agents
