# SPDX-License-Identifier: BSD-3-Clause
"""Computes the coast around a ranch for the drawing of the storm's region."""
import pathlib

import numpy as np
from matplotlib.path import Path
from matplotlib.transforms import Bbox

from .geodesy import LocalPlane

LEAST_KM = 300.0  # min width of a drawing with the coast; smaller drawings would show its errors


def source():
    """Returns the path of coast.csv (see aquafarm_viz/data/README.md); None without ROS, or if ROS
    does not find the package aquafarm_viz."""
    try:
        import rospkg
    except ImportError:
        return None
    try:
        return pathlib.Path(rospkg.RosPack().get_path("aquafarm_viz")) / "data" / "coast.csv"
    except rospkg.ResourceNotFound:
        return None


def rings(origin, cell_size_m, box):
    """Returns the land within a box as closed rings, each an array of corners (x, y) [cells].

    Corners within 60 degrees of `origin`, the position of cell [0, 0], are projected onto the
    tangent plane at `origin`. The other corners are left out.
    @param box  (west, south, east, north) [cells]
    """
    path = source()
    if path is None:
        return []
    result = []
    for line in path.read_text(encoding="ascii").splitlines():
        corners = np.fromstring(line, dtype=float, sep=",")[1:].reshape(-1, 2) / 100.0
        points = _project(origin, corners) / cell_size_m
        if len(points) < 3:
            continue
        low, high = points.min(axis=0), points.max(axis=0)
        if low[0] > box[2] or high[0] < box[0] or low[1] > box[3] or high[1] < box[1]:
            continue
        outline = Path(points, closed=False)
        clipped = outline.clip_to_bbox(Bbox.from_extents(*box)).vertices
        if len(clipped) >= 3:
            result.append(clipped)
    return result


def _project(origin, corners):
    """Returns (east, north) [m] of the corners (longitude, latitude) [degrees] that are within 60
    degrees of the origin."""
    lon = np.radians(corners[:, 0] - origin["longitude"])
    lat, lat0 = np.radians(corners[:, 1]), np.radians(origin["latitude"])
    near = np.sin(lat0) * np.sin(lat) + np.cos(lat0) * np.cos(lat) * np.cos(lon) > 0.5
    plane = LocalPlane(origin["latitude"], origin["longitude"])
    return np.array([plane.to_plane(latitude, longitude)
                     for longitude, latitude in corners[near]]).reshape(-1, 2)
