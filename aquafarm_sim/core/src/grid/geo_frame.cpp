// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/grid/geo_frame.h"

#include <GeographicLib/LocalCartesian.hpp>

namespace aquafarm {

std::array<double, 2> GeoFrame::ToGrid(GeoPoint point) const {
  const GeographicLib::LocalCartesian plane(origin_.latitude, origin_.longitude);
  double east = 0.0;
  double north = 0.0;
  double up = 0.0;
  plane.Forward(point.latitude, point.longitude, 0.0, east, north, up);
  return {east / cell_size_m_, north / cell_size_m_};
}

bool GeoFrame::Faces(GeoPoint point) const {
  const GeographicLib::LocalCartesian plane(origin_.latitude, origin_.longitude);
  double east = 0.0;
  double north = 0.0;
  double up = 0.0;
  plane.Forward(point.latitude, point.longitude, 0.0, east, north, up);
  constexpr double kHalfRadius_m = 6.371e6 / 2.0;  // Earth: 6371 km; 1 - cos(60 degrees) = 1/2
  return up > -kHalfRadius_m;
}

GeoPoint GeoFrame::ToGeo(double x, double y) const {
  const GeographicLib::LocalCartesian plane(origin_.latitude, origin_.longitude);
  GeoPoint point;
  double height = 0.0;
  plane.Reverse(x * cell_size_m_, y * cell_size_m_, 0.0, point.latitude, point.longitude, height);
  return point;
}

}  // namespace aquafarm
