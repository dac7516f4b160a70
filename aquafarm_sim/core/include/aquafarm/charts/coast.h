// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Coastlines as GeoJSON (RFC 7946): Polygon and MultiPolygon, alone, in Features, collections of
/// either, or GeometryCollections. Other geometries are passed over.

#include <string>
#include <vector>

#include "aquafarm/charts/chart.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

/// A closed line; the last point is the first.
using CoastRing = std::vector<GeoPoint>;
/// A shore, then holes (lakes).
using CoastPolygon = std::vector<CoastRing>;

struct Coast {
  std::vector<CoastPolygon> polygons;
  std::vector<std::string> warnings;  ///< "coast.json:3: features[0]…: ring crosses itself, …"
};

/// Reads a GeoJSON text. A ring that crosses or runs along itself, or has too many lines to tell,
/// is kept with a warning: what lies inside it an odd number of times is land.
/// @throws InputError "coast.json:7: features[0].geometry.coordinates[0]: the ring is open, …"
Coast ParseCoast(const std::string& text, const std::string& origin_name);
/// The same of a file. @throws InputError also when it cannot be read
Coast LoadCoast(const std::string& path);

/// How much of each cell of a width × height grid is land, by 5 × 5 samples a cell.
LandShare ShareOfLand(const Coast& coast, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height);

}  // namespace aquafarm
