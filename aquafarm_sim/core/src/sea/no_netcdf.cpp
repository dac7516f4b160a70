// SPDX-License-Identifier: BSD-3-Clause
// Replaces sea_field.cpp in a build without netCDF (AQUAFARM_WITH_NETCDF=OFF).
#include "aquafarm/base/check.h"
#include "aquafarm/sea/sea_field.h"

namespace aquafarm {

SeaField LoadSeaField(const std::string& path, const SeaFieldChoice& choice, const GeoFrame& frame,
                      std::int32_t width, std::int32_t height) {
  static_cast<void>(frame);
  static_cast<void>(width);
  static_cast<void>(height);
  throw InputError(path + ": got variable '" + choice.variable +
                   "' of a netCDF file, expected no sea field: this build of aquafarm reads no "
                   "netCDF; rebuild with -DAQUAFARM_WITH_NETCDF=ON and libnetcdf-dev");
}

}  // namespace aquafarm
