// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/grid/grid.h"

namespace aquafarm::internal {

/// A greyscale image, row 0 at the top.
struct MapImage {
  Grid<std::uint8_t> grey;   ///< mean of the colours
  Grid<std::uint8_t> alpha;  ///< empty if every pixel is opaque
};

/// Max width and height of an image [pixels].
inline constexpr std::int32_t kMaxMapSide = 16384;

/// Reads PGM (P2, P5), PNG and BMP; the content decides the format. The size in the header is
/// checked before memory is allocated.
/// @throws InputError "chart.pgm: got 12 bytes of pixels, expected 65536 x 65536 …"
MapImage ParseMapImage(const std::string& bytes, const std::string& origin_name);

}  // namespace aquafarm::internal
