// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Coastlines as GeoJSON (RFC 7946): Polygon and MultiPolygon, as single geometries or inside
/// Features, FeatureCollections or GeometryCollections. Points and lines are skipped.

#include <string>
#include <vector>

#include "aquafarm/charts/chart.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

/// A closed line whose last point equals its first.
using CoastRing = std::vector<GeoPoint>;
/// An outer ring (the shore), followed by its holes (lakes).
using CoastPolygon = std::vector<CoastRing>;

struct Coast {
  std::vector<CoastPolygon> polygons;
  std::vector<std::string> warnings;  ///< "coast.json:3: features[0]…: the ring crosses itself; …"
};

/// Parses a GeoJSON text. A ring that crosses or overlaps itself is kept, with a warning. This
/// check stops, with a warning, after 50 million comparisons of segments in a file.
/// @throws InputError "coast.json:7: features[0].geometry.coordinates[0]: got an open ring, …";
///   also if there is no polygon
Coast ParseCoast(const std::string& text, const std::string& origin_name);
/// Does the same as ParseCoast, for a file. @throws InputError also if the file cannot be read
Coast LoadCoast(const std::string& path);

/// Returns the land share [height, width] from 5 × 5 sample points per cell. A point is land if it
/// is inside a polygon. The even-odd rule is applied to all rings of a polygon together.
LandShare ShareOfLand(const Coast& coast, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height);

}  // namespace aquafarm
