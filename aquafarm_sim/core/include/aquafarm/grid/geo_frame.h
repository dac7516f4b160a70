// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Geographic reference of the grid: the tangent plane of the WGS 84 ellipsoid at the centre of
/// cell (0, 0), with x east and y north, in cells.

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
  /// @param origin centre of cell (0, 0) @param cell_size_m above 0
  GeoFrame(GeoPoint origin, double cell_size_m) : origin_(origin), cell_size_m_(cell_size_m) {}

  /// Projects a point on the ellipsoid orthogonally onto the plane and returns its (x, y) [cells].
  std::array<double, 2> ToGrid(GeoPoint point) const;
  /// Returns whether a point is within about 60 degrees of arc of the origin. A point more than 90
  /// degrees away is on the far side of the Earth, and ToGrid could project it into the ranch.
  bool Faces(GeoPoint point) const;
  /// Returns the latitude and longitude of a point (x, y) on the plane [cells]. Its height above
  /// the ellipsoid is ignored.
  GeoPoint ToGeo(double x, double y) const;

 private:
  GeoPoint origin_;
  double cell_size_m_;
};

}  // namespace aquafarm
