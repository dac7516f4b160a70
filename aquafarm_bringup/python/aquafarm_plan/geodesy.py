# SPDX-License-Identifier: BSD-3-Clause
"""Tangent plane (east, north) on the WGS 84 ellipsoid, as aquafarm/grid/geo_frame.h in C++."""
from math import atan2, cos, degrees, hypot, radians, sin, sqrt

_A, _F = 6378137.0, 1 / 298.257223563  # WGS 84: semi-major axis [m], flattening
_E2 = _F * (2 - _F)


class LocalPlane:
    """Converts between positions [degrees] and the tangent plane at an origin [m]."""

    def __init__(self, latitude, longitude):
        self._origin = _to_ecef(latitude, longitude)
        lat, lon = radians(latitude), radians(longitude)
        self._axes = ((-sin(lon), cos(lon), 0.0),                                   # east
                      (-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat)),       # north
                      (cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat)))         # up

    def to_plane(self, latitude, longitude):
        """(east, north) of a point on the ellipsoid; its height above the plane is dropped."""
        way = [a - b for a, b in zip(_to_ecef(latitude, longitude), self._origin)]
        east, north, _ = (sum(a * b for a, b in zip(axis, way)) for axis in self._axes)
        return east, north

    def to_geo(self, east, north):
        """(latitude, longitude) of the point on the ellipsoid below a point on the plane.

        Exact inverse of to_plane. GeoFrame::ToGeo of the C++ core drops the height along the
        ellipsoid's normal instead: at 25 km from the origin the two differ by 0.2 m.
        """
        up = 0.0
        for _ in range(6):  # each round shrinks the height by the square of the distance / radius
            point = [start + sum(a * b for a, b in zip((east, north, up), column))
                     for start, column in zip(self._origin, zip(*self._axes))]
            latitude, longitude, height = _from_ecef(*point)
            up -= height
        return latitude, longitude


def _from_ecef(x, y, z):
    """Latitude, longitude [degrees] and height [m] by fixed-point iteration of the latitude."""
    across = hypot(x, y)
    lat = atan2(z, across * (1 - _E2))
    for _ in range(6):  # each round gains more than two digits
        lat = atan2(z + _E2 * _normal(lat) * sin(lat), across)
    return degrees(lat), degrees(atan2(y, x)), across / cos(lat) - _normal(lat)


def _normal(lat):
    return _A / sqrt(1 - _E2 * sin(lat)**2)


def _to_ecef(latitude, longitude):
    lat, lon = radians(latitude), radians(longitude)
    n = _normal(lat)
    return n * cos(lat) * cos(lon), n * cos(lat) * sin(lon), n * (1 - _E2) * sin(lat)
