// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Fields of the sea from netCDF files (CF conventions): temperature, salinity, waves, currents.
///
///   value(time, depth, lat, lon) ── nearest time and depth ── window around the ranch ── Layer
///
/// Packed numbers are unpacked (scale_factor, add_offset); _FillValue or netCDF's default for the
/// type, missing_value and values outside of valid_range or valid_min … valid_max, compared as they
/// are stored, are land or unknown: NaN. Latitude may run either way,
/// longitude be -180 … 180 or 0 … 360, depth count down or up. Curvilinear grids are refused.

#include <optional>
#include <string>
#include <vector>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm {

/// What to read of a file.
struct SeaFieldChoice {
  std::string variable;              ///< name, or standard_name
  std::optional<std::int64_t> time;  ///< UTC; the nearest is taken; none: the first
  double depth_m{};                  ///< below the surface; the nearest is taken
};

/// A field on the file's own grid, cut to a ranch.
struct SeaField {
  std::string name;                  ///< of the variable
  std::string units;                 ///< as the file says
  std::optional<std::int64_t> time;  ///< of the values, UTC; none: the file has no time
  std::optional<double> depth_m;     ///< of the values; none: the file has none, or not in metres
  std::vector<double> latitude;      ///< ascending [degrees]
  std::vector<double> longitude;     ///< ascending [degrees], near those of the ranch
  Grid<float> value;                 ///< [latitude, longitude]; NaN: land or unknown
};

/// A field on the cells of a ranch, [H, W]; NaN where the field has no value nearby.
using Layer = Grid<float>;

/// Reads the part of a field around a ranch of width × height cells.
/// @throws InputError "sea.nc: so: there is no such variable; there are: …"
SeaField LoadSeaField(const std::string& path, const SeaFieldChoice& choice, const GeoFrame& frame,
                      std::int32_t width, std::int32_t height);

/// The field at each cell's centre: bilinear between four values, or the mean of those that are
/// there weighted the same.
Layer ToLayer(const SeaField& field, const GeoFrame& frame, std::int32_t width,
              std::int32_t height);

}  // namespace aquafarm
