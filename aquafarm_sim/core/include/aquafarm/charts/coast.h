// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Coastlines as GeoJSON (RFC 7946): Polygon and MultiPolygon, as single geometries or inside
/// Features, FeatureCollections or GeometryCollections. Other geometries are skipped.

#include <string>
#include <vector>

#include "aquafarm/charts/chart.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

/// A closed line; the last point equals the first.
using CoastRing = std::vector<GeoPoint>;
/// An outer ring (shore), followed by holes (lakes).
using CoastPolygon = std::vector<CoastRing>;

struct Coast {
  std::vector<CoastPolygon> polygons;
  std::vector<std::string> warnings;  ///< "coast.json:3: features[0]…: ring crosses itself, …"
};

/// Parses a GeoJSON text. A ring that crosses or overlaps itself, or has too many segments to
/// check, is kept with a warning; the even-odd rule then decides what is land.
/// @throws InputError "coast.json:7: features[0].geometry.coordinates[0]: the ring is open, …"
Coast ParseCoast(const std::string& text, const std::string& origin_name);
/// Reads a file as ParseCoast does. @throws InputError also when it cannot be read
Coast LoadCoast(const std::string& path);

/// Returns the fraction of land of each cell of a width × height grid, from 5 × 5 samples per cell.
LandShare ShareOfLand(const Coast& coast, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height);

}  // namespace aquafarm
