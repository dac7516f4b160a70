// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Linear interpolation between two points of a track.

namespace aquafarm::internal {

inline constexpr double kHour_s = 3600.0;

/// Returns the value at `part` (0 to 1) of the line from `a` to `b`.
inline double Between(double a, double b, double part) { return a + (b - a) * part; }

}  // namespace aquafarm::internal
