// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/grid/grid.h"

namespace aquafarm::internal {

/// A greyscale image [height, width], row 0 at the top.
struct MapImage {
  Grid<std::uint8_t> grey;   ///< mean of the colours, 0 black to 255 white
  Grid<std::uint8_t> alpha;  ///< 255 is opaque; empty if the image has no alpha channel
};

/// Max width and height of an image [pixels].
inline constexpr std::int32_t kMaxMapSide = 16384;

/// Reads PGM (P2, P5), PNG or BMP; the content determines the format. Checks the size in the header
/// before it allocates memory.
/// @throws InputError "chart.pgm:3: got 12 bytes of pixels, expected 64 x 64 of 1 byte"
MapImage ParseMapImage(const std::string& bytes, const std::string& origin_name);

}  // namespace aquafarm::internal
