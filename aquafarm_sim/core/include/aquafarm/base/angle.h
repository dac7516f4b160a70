// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm {

inline constexpr double kPi = 3.14159265358979323846;
/// Radians in one degree: degrees × kRadiansPerDegree = radians.
inline constexpr double kRadiansPerDegree = kPi / 180.0;

}  // namespace aquafarm
