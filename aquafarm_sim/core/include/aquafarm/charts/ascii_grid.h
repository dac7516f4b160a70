// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Elevations as an ASCII grid. Each header line is a key and a number, in either order: "ncols 60"
/// or "60 ncols". The keys are ncols, nrows, cellsize, NODATA_value (default -9999), one key for
/// the position in x and one for the position in y. In x, xllcorner or xll is the west edge of the
/// grid; xllcenter or xlower is the centre of the first column. The keys for y are analogous. The
/// values follow row by row from the north. They may be divided into lines in any way.

#include <array>
#include <string>

#include "aquafarm/charts/chart.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

struct AsciiGrid {
  Grid<float> value;   ///< [H, W], row 0 in the south; NaN where there is no data
  double west{};       ///< x of the centre of the south-west cell
  double south{};      ///< y of the centre of the south-west cell
  double cell_size{};  ///< distance between neighbouring centres [degrees or metres]
  /// Returns whether coordinates are in degrees; if not, they are in metres. They are in degrees if
  /// `cell_size` is below 1, |west| is at most 720 and |south| is at most 180. The limits 720 and
  /// 180 are twice the largest valid values, so that the parser reports a mistyped corner in
  /// degrees as an error.
  bool IsGeographic() const;
  /// For a grid in degrees: returns whether a position is inside the grid, even where the grid has
  /// no data. Longitudes are compared modulo 360.
  bool Covers(GeoPoint place) const;
  /// For a grid in degrees: returns the column and row of the cell nearest to a position. For a
  /// position outside the grid, at least one of them is out of range.
  std::array<long, 2> Nearest(GeoPoint place) const;
};

/// Parses a text. @throws InputError "bay.asc:5: CELLSIZE: got 0, expected …"
AsciiGrid ParseAsciiGrid(const std::string& text, const std::string& origin_name);
/// Does the same as ParseAsciiGrid, for a file. @throws InputError also if the file cannot be read
AsciiGrid LoadAsciiGrid(const std::string& path);

/// Returns the land share [height, width] of the cells of a ranch, from a grid in degrees. Each
/// cell has 5 × 5 sample points, and each point gets the nearest value of the grid. A point is land
/// if this value is above `sea_level` or missing, or if the point is outside the grid.
/// @param sea_level in the unit of the values
LandShare ShareOfLand(const AsciiGrid& grid, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height, float sea_level);
/// Returns the land share of each cell of a grid in metres: 1 if its value is above `sea_level` or
/// missing, else 0. The cells of the grid are the cells of the ranch.
LandShare ShareOfLand(const AsciiGrid& grid, float sea_level);

}  // namespace aquafarm
