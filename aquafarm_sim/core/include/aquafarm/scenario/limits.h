// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Limits of every scenario. Each number is defined only here.

namespace aquafarm {

/// Max number of rings (radius and risk pairs) of one disaster.
inline constexpr int kMaxRings = 4;
/// Max width and height of a farm [cells].
inline constexpr int kMaxSide = 4096;

}  // namespace aquafarm
