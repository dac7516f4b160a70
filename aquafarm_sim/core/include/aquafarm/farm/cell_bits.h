// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace aquafarm {

/// Bits of a chart cell. A cell without bits is open water.
enum CellBits : std::uint8_t {
  kIslandBit = 1,
  kRockBit = 2,
  kPortBit = 4,        ///< a port on water
  kDeviceSiteBit = 8,  ///< water where a device was deployed at the start of the episode
};
/// Bits of cells that ships cannot enter.
inline constexpr std::uint8_t kBlockedBits = kIslandBit | kRockBit;

}  // namespace aquafarm
