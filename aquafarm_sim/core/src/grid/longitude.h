// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm::internal {

/// Converts a longitude in [-180, 360] to (-180, 180] [degrees].
inline double NormalLongitude(double longitude) {
  if (longitude > 180.0) return longitude - 360.0;
  return longitude <= -180.0 ? longitude + 360.0 : longitude;
}

}  // namespace aquafarm::internal
