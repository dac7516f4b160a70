// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Charts in the format of map_server: a YAML file and an image.
///
///   image: chart.pgm        PGM, PNG or BMP; dark is occupied
///   resolution: 200         metres per pixel
///   origin: [0, 0, 0]       x, y of the south-west corner [m], yaw [rad]
///   negate: 0               1: light is occupied
///   occupied_thresh: 0.65   a pixel with a higher occupancy is occupied
///   free_thresh: 0.196      a pixel with a lower occupancy is free
///   mode: trinary           between the thresholds: unknown (trinary), or linear (scale)
///
/// With negate: 0, the occupancy of a white pixel is 0 and that of a black pixel is 1. With mode:
/// scale, pixels between the thresholds are unknown unless they are opaque. With mode: raw, grey
/// values from 0 to 100 are the occupancy in percent, and larger values are unknown. Source:
/// wiki.ros.org/map_server

#include <array>
#include <string>

#include "aquafarm/charts/chart.h"

namespace aquafarm {

struct MapFile {
  Grid<std::int8_t> occupancy;  ///< [H, W], row 0 in the south; 0 free … 100 occupied, -1 unknown
  double cell_size_m{1.0};
  std::array<double, 3> origin{};  ///< x, y [m], yaw [rad] of the south-west corner
};

/// Reads a map. A relative image path is resolved against the folder of the YAML file.
/// @throws InputError whose message contains the YAML file, the line and the key, or the image file
MapFile LoadMap(const std::string& yaml_path);

/// Writes `yaml_path` and, next to it, the image with the extension .pgm. Each file has a temporary
/// name until it is complete. The image has the grey values of map_saver: 254 for an occupancy of 0
/// to 19, 0 for 65 and above, and 205 for 20 to 64 and for unknown.
/// @throws InputError if a file cannot be written
void SaveMap(const MapFile& map, const std::string& yaml_path);

/// Returns the land share of each cell: its occupancy divided by 100. Unknown cells are land,
/// because ships must not enter them (our choice, see docs/model.md).
/// @throws InputError for a rotated map, because the grid of a ranch points north
LandShare ShareOfLand(const MapFile& map);

/// Returns the islands and rocks of a scenario as a map, with 100 for land and rocks and 0 for
/// water. The layout is that of episode 0 with the seed Scenario::layout_seed.
/// @throws InputError if the layout cannot be drawn
MapFile ToMap(const Scenario& scenario);

}  // namespace aquafarm
