# SPDX-License-Identifier: BSD-3-Clause
"""The tangent plane (east, north) of the WGS 84 ellipsoid, as in aquafarm/grid/geo_frame.h
(C++)."""
from math import atan2, cos, degrees, hypot, radians, sin, sqrt

_A, _F = 6378137.0, 1 / 298.257223563  # WGS 84: semi-major axis [m], flattening
_E2 = _F * (2 - _F)


class LocalPlane:
    """Converts between (latitude, longitude) [degrees] and (east, north) [m] in the tangent plane
    at an origin."""

    def __init__(self, latitude, longitude):
        self._origin = _to_ecef(latitude, longitude)
        lat, lon = radians(latitude), radians(longitude)
        self._axes = ((-sin(lon), cos(lon), 0.0),                                   # east
                      (-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat)),       # north
                      (cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat)))         # up

    def to_plane(self, latitude, longitude):
        """Returns (east, north) [m] of a point on the ellipsoid. Its height above the plane is
        ignored."""
        way = [a - b for a, b in zip(_to_ecef(latitude, longitude), self._origin)]
        east, north, _ = (sum(a * b for a, b in zip(axis, way)) for axis in self._axes)
        return east, north

    def to_geo(self, east, north):
        """Returns (latitude, longitude) of the point on the ellipsoid that to_plane maps to (east,
        north).

        GeoFrame::ToGeo of the C++ core instead projects the point of the plane along the
        ellipsoid's normal. At 25 km from the origin the two results differ by 0.2 m.
        """
        up = 0.0
        for _ in range(6):  # each round multiplies the error by about (distance / radius)²
            point = [start + sum(a * b for a, b in zip((east, north, up), column))
                     for start, column in zip(self._origin, zip(*self._axes))]
            latitude, longitude, height = _from_ecef(*point)
            up -= height
        return latitude, longitude


def _from_ecef(x, y, z):
    """Returns latitude, longitude [degrees] and height [m], by fixed-point iteration of the
    latitude."""
    across = hypot(x, y)
    lat = atan2(z, across * (1 - _E2))
    for _ in range(6):  # each round adds more than two correct digits
        lat = atan2(z + _E2 * _normal(lat) * sin(lat), across)
    return degrees(lat), degrees(atan2(y, x)), across / cos(lat) - _normal(lat)


def _normal(lat):
    return _A / sqrt(1 - _E2 * sin(lat)**2)


def _to_ecef(latitude, longitude):
    lat, lon = radians(latitude), radians(longitude)
    n = _normal(lat)
    return n * cos(lat) * cos(lon), n * cos(lat) * sin(lon), n * (1 - _E2) * sin(lat)
