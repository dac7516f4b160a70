// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Charts as map_server has them: a YAML file beside a picture.
///
///   image: chart.pgm        PGM, PNG or BMP; dark is occupied
///   resolution: 200         metres a pixel
///   origin: [0, 0, 0]       x, y of the south-west corner [m], yaw [rad]
///   negate: 0               1: light is occupied
///   occupied_thresh: 0.65   above: occupied; below free_thresh: free; between: unknown
///   free_thresh: 0.196
///   mode: trinary           scale: between the two in proportion; raw: pixels are 0 to 100
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

/// Reads a map; its image is looked for beside it.
/// @throws InputError with the file, the line and the key, or the place in the picture
MapFile LoadMap(const std::string& yaml_path);

/// Writes NAME.yaml and NAME.pgm beside it, each under another name first: 254 free, 0 occupied
/// (from 65), 205 unknown, as map_saver does.
/// @throws InputError when a file cannot be written
void SaveMap(const MapFile& map, const std::string& yaml_path);

/// Occupied cells as land, free ones as water, those between in proportion; unknown is land: no
/// ship shall go there. [decided]
/// @throws InputError for a map that is turned: a ranch's grid points north
LandShare ShareOfLand(const MapFile& map);

/// The land and rocks of a scenario's first episode as a map.
MapFile ToMap(const Scenario& scenario);

}  // namespace aquafarm
