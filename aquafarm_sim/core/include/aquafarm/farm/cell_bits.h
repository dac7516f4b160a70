// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace aquafarm {

/// Bits of a chart cell; 0 is open water.
enum CellBits : std::uint8_t {
  kIslandBit = 1,
  kRockBit = 2,
  kPortBit = 4,        ///< water
  kDeviceSiteBit = 8,  ///< water; a device was deployed here at the start of the episode
};
inline constexpr std::uint8_t kBlockedBits = kIslandBit | kRockBit;

}  // namespace aquafarm
