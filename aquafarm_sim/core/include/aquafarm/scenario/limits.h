// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The limits that every scenario keeps. Each number is defined here and only here.

namespace aquafarm {

/// Most rings (radius and risk pairs) that one disaster may have.
inline constexpr int kMaxRings = 4;
/// Largest farm on a side [cells].
inline constexpr int kMaxSide = 4096;

}  // namespace aquafarm
