// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Names of winds by their speed, as in marine warnings and the Beaufort scale.

#include <cstdint>
#include <string>

namespace aquafarm {

inline constexpr std::int32_t kHurricaneForce_kt = 64;  ///< lowest wind of hurricane force

/// Returns the name of a wind: "hurricane force" from 64 kt, "storm" from 48, "gale" from 34, "near
/// gale" from 28, else "wind".
const char* WindName(std::int32_t wind_kt);

/// Returns the name of the ring in which the wind is at least `wind_kt`, such as "gale (34 kt)".
std::string RingName(std::int32_t wind_kt);

}  // namespace aquafarm
