// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where the grid lies on the globe: the tangent plane (ENU) at the centre of cell (0, 0) on the
/// WGS 84 ellipsoid, x east and y north, in cells.

#include <array>

namespace aquafarm {

/// A place on the globe, WGS 84 [degrees].
struct GeoPoint {
  double latitude{};
  double longitude{};
};

/// Turns WGS 84 positions into grid coordinates and back.
class GeoFrame {
 public:
  /// @param cell_size_m above 0
  GeoFrame(GeoPoint origin, double cell_size_m) : origin_(origin), cell_size_m_(cell_size_m) {}

  /// Returns (x, y) of a point of the ellipsoid [cells]; its height over the plane is dropped.
  std::array<double, 2> ToGrid(GeoPoint point) const;
  /// Whether a point is within 60 degrees of the origin. Beyond a quarter of the globe the plane
  /// would fold it back onto the ranch.
  bool Faces(GeoPoint point) const;
  /// Returns the position of a point of the plane [cells]; its height over the ellipsoid is
  /// dropped.
  GeoPoint ToGeo(double x, double y) const;

 private:
  GeoPoint origin_;
  double cell_size_m_;
};

}  // namespace aquafarm
