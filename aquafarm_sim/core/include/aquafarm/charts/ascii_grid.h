// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Elevations as an ASCII grid. The header has "ncols 60" or "60 ncols", nrows, xllcorner or
/// xllcenter (or xlower), the same keys for y, cellsize and NODATA_value. The values follow row by
/// row from the north, with any number of values per line.

#include <array>
#include <string>

#include "aquafarm/charts/chart.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

struct AsciiGrid {
  Grid<float> value;  ///< [H, W], row 0 in the south; NaN where there is no data
  double west{};      ///< x of the centre of the south-west cell
  double south{};     ///< y of the centre of the south-west cell
  double cell_size{};
  /// Returns whether coordinates are in degrees: cells are smaller than 1 and the corner is within
  /// twice the range of degrees, so that typing errors are detected. If false, they are in metres.
  bool IsGeographic() const;
  /// Whether a grid in degrees has a value at a place; longitudes are equal modulo 360.
  bool Covers(GeoPoint place) const;
  /// The column and row of the value nearest to a place; outside the grid: beyond its columns or
  /// rows.
  std::array<long, 2> Nearest(GeoPoint place) const;
};

/// Parses a text. @throws InputError "bay.asc:3: cellsize: got '0', expected …"
AsciiGrid ParseAsciiGrid(const std::string& text, const std::string& origin_name);
/// Reads a file as ParseAsciiGrid does. @throws InputError also when it cannot be read
AsciiGrid LoadAsciiGrid(const std::string& path);

/// Returns the land share of a grid in degrees. Values above `sea_level` or without data are land.
/// Each cell of the ranch uses the nearest values at 5 × 5 points.
LandShare ShareOfLand(const AsciiGrid& grid, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height, float sea_level);
/// Returns the land share of a grid in metres, one value per cell of the ranch.
LandShare ShareOfLand(const AsciiGrid& grid, float sea_level);

}  // namespace aquafarm
