// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for charts: the first byte selects an image, a coast or a grid of elevations.
#include <cstddef>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/charts/ascii_grid.h"
#include "aquafarm/charts/coast.h"
#include "charts/map_image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aquafarm;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const GeoFrame frame({30.0, 122.0}, 1000.0);
  const char first = bytes.empty() ? ' ' : bytes[0];
  try {
    if (first == 'P' || first == 'B' || first == '\x89') {
      internal::ParseMapImage(bytes, "fuzz");
    } else if (first == '{' || first == '[') {
      ShareOfLand(ParseCoast(bytes, "fuzz"), frame, 12, 8);
    } else {
      ShareOfLand(ParseAsciiGrid(bytes, "fuzz"), frame, 6, 4, 0.0F);
    }
  } catch (const InputError&) {  // expected for invalid input; any other failure is a bug
  }
  return 0;
}
