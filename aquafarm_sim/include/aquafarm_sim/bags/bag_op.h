// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace aquafarm_sim {

/// Type of a record of a bag (format 2.0, http://wiki.ros.org/Bags/Format/2.0).
enum class BagOp : std::uint8_t {
  kMessage = 2,
  kBag = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

}  // namespace aquafarm_sim
