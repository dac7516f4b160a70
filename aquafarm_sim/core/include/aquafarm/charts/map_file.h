// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Charts in the format of map_server: a YAML file and an image in the same folder.
///
///   image: chart.pgm        PGM, PNG or BMP; dark is occupied
///   resolution: 200         metres per pixel
///   origin: [0, 0, 0]       x, y of the south-west corner [m], yaw [rad]
///   negate: 0               1: light is occupied
///   occupied_thresh: 0.65   above: occupied; below free_thresh: free; between: unknown
///   free_thresh: 0.196
///   mode: trinary           scale: linear between the two; raw: pixels are 0 to 100
///
/// (wiki.ros.org/map_server)

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
/// @throws InputError with the file, the line and the key, or the position in the image
MapFile LoadMap(const std::string& yaml_path);

/// Writes NAME.yaml and NAME.pgm in the same folder, each first under a temporary name. Pixel
/// values are those of map_saver: 254 free, 0 occupied (from 65), 205 unknown.
/// @throws InputError when a file cannot be written
void SaveMap(const MapFile& map, const std::string& yaml_path);

/// Returns the land share of each cell: occupied is land, free is water, values between are
/// proportional. Unknown is land, because ships must not go there ([decided], see docs/model.md).
/// @throws InputError for a rotated map, because the grid of a ranch points north
LandShare ShareOfLand(const MapFile& map);

/// Returns the land and rocks of the first episode of a scenario as a map.
MapFile ToMap(const Scenario& scenario);

}  // namespace aquafarm
