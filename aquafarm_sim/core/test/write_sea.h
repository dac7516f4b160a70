// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <netcdf.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm {

/// Writes a netCDF file with one field along lat and lon.
/// @param values [latitude, longitude]
/// @param kind format of the file, such as NC_64BIT_DATA
/// @param time_h time of the field [hours since 1970]; nullopt: the file has no time
inline void WriteSea(const std::string& path, const std::string& name,
                     const std::vector<double>& latitude, const std::vector<double>& longitude,
                     const std::vector<float>& values, int kind = 0,
                     std::optional<double> time_h = std::nullopt) {
  int file = 0;
  std::array<int, 3> dims{};  // lat, lon, and time before them
  std::array<int, 4> variables{};
  nc_create(path.c_str(), NC_CLOBBER | kind, &file);
  nc_def_dim(file, "lat", latitude.size(), &dims[0]);
  nc_def_dim(file, "lon", longitude.size(), &dims[1]);
  nc_def_var(file, "lat", NC_DOUBLE, 1, &dims[0], &variables[0]);
  nc_def_var(file, "lon", NC_DOUBLE, 1, &dims[1], &variables[1]);
  if (time_h) {
    nc_def_dim(file, "time", 1, &dims[2]);
    nc_def_var(file, "time", NC_DOUBLE, 1, &dims[2], &variables[3]);
    nc_put_att_text(file, variables[3], "units", 28, "hours since 1970-01-01 00:00");
  }
  const std::array<int, 3> shape{dims[2], dims[0], dims[1]};
  nc_def_var(file, name.c_str(), NC_FLOAT, time_h ? 3 : 2, shape.data() + (time_h ? 0 : 1),
             &variables[2]);
  nc_put_att_text(file, variables[2], "units", 4, "degC");
  nc_enddef(file);
  nc_put_var_double(file, variables[0], latitude.data());
  nc_put_var_double(file, variables[1], longitude.data());
  if (time_h) nc_put_var_double(file, variables[3], &*time_h);
  nc_put_var_float(file, variables[2], values.data());
  nc_close(file);
}

/// Writes a field of 1600 x 1600 values (10.2 MB), all equal to 17. They are 0.001 degrees apart,
/// from 30 N 122 E on.
inline void WriteSeaOfTenMegabytes(const std::string& path) {
  constexpr std::size_t kSide = 1600;
  std::vector<double> latitude(kSide);
  std::vector<double> longitude(kSide);
  for (std::size_t i = 0; i < kSide; ++i) {
    latitude[i] = 30.0 + 0.001 * static_cast<double>(i);
    longitude[i] = latitude[i] + 92.0;
  }
  WriteSea(path, "t", latitude, longitude, std::vector<float>(kSide * kSide, 17.0F));
}

}  // namespace aquafarm
