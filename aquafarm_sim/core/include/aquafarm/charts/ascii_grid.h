// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Heights as an ASCII grid: "ncols 60" or "60 ncols", nrows, xllcorner or xllcenter (xlower), the
/// same of y, cellsize, NODATA_value, then the values row by row from the north, any number a line.

#include <string>

#include "aquafarm/charts/chart.h"
#include "aquafarm/grid/geo_frame.h"

namespace aquafarm {

struct AsciiGrid {
  Grid<float> value;  ///< [H, W], row 0 in the south; NaN where there is no data
  double west{};      ///< of the centre of the south-west cell
  double south{};
  double cell_size{};
  /// Whether places are degrees: cells are smaller than one and the corner is no further off than a
  /// slip of degrees would be. Else metres.
  bool IsGeographic() const;
};

/// @throws InputError "bay.asc:3: cellsize: got '0', expected …"
AsciiGrid ParseAsciiGrid(const std::string& text, const std::string& origin_name);
/// The same of a file. @throws InputError also when it cannot be read
AsciiGrid LoadAsciiGrid(const std::string& path);

/// Land is what lies higher than `sea_level`, or has no data. Of a grid in degrees the nearest
/// values at 5 × 5 points of each cell of the ranch are taken.
LandShare ShareOfLand(const AsciiGrid& grid, const GeoFrame& frame, std::int32_t width,
                      std::int32_t height, float sea_level);
/// A grid in metres as it is, a value a cell.
LandShare ShareOfLand(const AsciiGrid& grid, float sea_level);

}  // namespace aquafarm
