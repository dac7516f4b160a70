// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <netcdf.h>

#include <array>
#include <string>
#include <vector>

namespace aquafarm {

/// Writes a netCDF file with one field along lat and lon.
/// @param kind format of the file, such as NC_64BIT_DATA
inline void WriteSea(const std::string& path, const std::string& name,
                     const std::vector<double>& latitude, const std::vector<double>& longitude,
                     const std::vector<float>& values, int kind = 0) {
  int file = 0;
  std::array<int, 2> dims{};
  std::array<int, 3> variables{};
  nc_create(path.c_str(), NC_CLOBBER | kind, &file);
  nc_def_dim(file, "lat", latitude.size(), &dims[0]);
  nc_def_dim(file, "lon", longitude.size(), &dims[1]);
  nc_def_var(file, "lat", NC_DOUBLE, 1, &dims[0], &variables[0]);
  nc_def_var(file, "lon", NC_DOUBLE, 1, &dims[1], &variables[1]);
  nc_def_var(file, name.c_str(), NC_FLOAT, 2, dims.data(), &variables[2]);
  nc_put_att_text(file, variables[2], "units", 4, "degC");
  nc_enddef(file);
  nc_put_var_double(file, variables[0], latitude.data());
  nc_put_var_double(file, variables[1], longitude.data());
  nc_put_var_float(file, variables[2], values.data());
  nc_close(file);
}

/// Writes a field of 1600 x 1600 values of 17 (10.2 MB), 0.001 degrees apart, starting at 30 N
/// 122 E.
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
