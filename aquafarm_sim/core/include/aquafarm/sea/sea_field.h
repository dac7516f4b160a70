// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Fields of the sea from netCDF files (CF conventions): temperature, salinity, waves, currents.
///
///   value(time, depth, lat, lon) ── nearest time and depth ── window around the ranch ── Layer
///
/// Packed values are unpacked with scale_factor and add_offset. A value becomes NaN (land or
/// unknown) if its packed form equals _FillValue or missing_value, lies outside valid_range or
/// valid_min … valid_max (by default -1e30 … 1e30), or is above 9.9e35 in magnitude. Without
/// _FillValue, netCDF's default for the type applies. Latitude and longitude may ascend or descend.
/// Longitude may be in [-180, 180] or [0, 360]. Depth may be positive down or up. Curvilinear grids
/// cause an error.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm {

/// Value of a field on land and where the file has no value.
inline constexpr float kNoSeaValue = std::numeric_limits<float>::quiet_NaN();

/// Selects the field to read from a file.
struct SeaFieldChoice {
  std::string variable;  ///< name or standard_name
  /// UTC [s since 1970]; selects the nearest time. If unset, selects the first time of the file.
  std::optional<std::int64_t> time;
  double depth_m{};  ///< depth below the surface; selects the nearest depth
};

/// A field on the grid of the file, cropped to a ranch.
struct SeaField {
  std::string name;                  ///< name of the variable
  std::string units;                 ///< the variable's attribute `units`; "" if absent
  std::optional<std::int64_t> time;  ///< UTC [s since 1970]; nullopt if the field has no time axis
  std::optional<double> depth_m;     ///< depth below the surface; nullopt if unknown
  std::vector<double> latitude;      ///< ascending [degrees]
  std::vector<double> longitude;     ///< ascending [degrees], shifted by 0 or ±360
  Grid<float> value;                 ///< [latitude, longitude]; NaN: land or unknown
  /// Southernmost, northernmost, westernmost and easternmost coordinate of the whole field
  /// [degrees]. West and east are shifted as `longitude` is.
  std::array<double, 4> extent{};
};

/// A field on the cells of a ranch, [H, W]; NaN where the field has no value nearby.
using Layer = Grid<float>;

/// Reads the part of a field around a ranch of width × height cells. If the ranch is outside the
/// field, reads the values of the field that are nearest to the ranch.
/// @throws InputError for an unusable file or variable, for example "sea.nc: so: no such variable;
///         available: …". A build without netCDF (CMake: AQUAFARM_WITH_NETCDF=OFF) always throws.
SeaField LoadSeaField(const std::string& path, const SeaFieldChoice& choice, const GeoFrame& frame,
                      std::int32_t width, std::int32_t height);

/// Interpolates the field bilinearly at the centre of each cell: a weighted mean of four values.
/// NaN values are left out of the mean. A cell is NaN if all values with a weight above 0 are NaN.
/// It is also NaN if its centre is outside the field by more than half a mean grid step, or by more
/// than 0.5 degrees along an axis with a single value.
Layer ToLayer(const SeaField& field, const GeoFrame& frame, std::int32_t width,
              std::int32_t height);

}  // namespace aquafarm
