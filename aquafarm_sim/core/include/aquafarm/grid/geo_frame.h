// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Geographic reference of the grid: the tangent plane (ENU) at the centre of cell (0, 0) on the
/// WGS 84 ellipsoid, with x east and y north, in cells.

#include <array>

namespace aquafarm {

/// A geographic position, WGS 84 [degrees].
struct GeoPoint {
  double latitude{};
  double longitude{};
};

/// Converts between WGS 84 positions and grid coordinates.
class GeoFrame {
 public:
  /// @param cell_size_m above 0
  GeoFrame(GeoPoint origin, double cell_size_m) : origin_(origin), cell_size_m_(cell_size_m) {}

  /// Returns (x, y) of a point on the ellipsoid [cells]; its height above the plane is dropped.
  std::array<double, 2> ToGrid(GeoPoint point) const;
  /// Returns whether a point is within 60 degrees of the origin. Points more than 90 degrees away
  /// would be projected back onto the ranch.
  bool Faces(GeoPoint point) const;
  /// Returns the geographic position of a point on the plane [cells]; its height above the
  /// ellipsoid is dropped.
  GeoPoint ToGeo(double x, double y) const;

 private:
  GeoPoint origin_;
  double cell_size_m_;
};

}  // namespace aquafarm
