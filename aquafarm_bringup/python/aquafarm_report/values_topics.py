# SPDX-License-Identifier: BSD-3-Clause
"""Publishes V_π, the return from each start cell in rollouts of a policy, on the topics that rviz,
the viz node and bags use."""
import numpy as np
import rosgraph
import rospy
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import PointCloud2, PointField

from aquafarm_report.values import ValuesError

FRAME = "map"
NO_ACTION = 255  # rollout values contain returns but no actions


def to_grid(values, cell_size_m, stamp):
    """Returns a grid of values scaled from 0 (lowest) to 100 (highest); -1 where they are
    undefined.

    values: [H, W], rows from the south, NaN where undefined
    """
    grid = OccupancyGrid()
    grid.header.frame_id = FRAME
    grid.header.stamp = grid.info.map_load_time = stamp
    grid.info.resolution = cell_size_m
    grid.info.height, grid.info.width = values.shape
    grid.info.origin.position.x = grid.info.origin.position.y = -0.5 * cell_size_m
    grid.info.origin.orientation.w = 1.0
    known = np.isfinite(values)
    shares = np.full(values.shape, -1, dtype=np.int8)
    if known.any():
        low, high = values[known].min(), values[known].max()
        shares[known] = np.rint(100.0 * (values[known] - low) / max(high - low, 1e-12))
    grid.data = shares.ravel().tolist()
    return grid


def to_points(values, cell_size_m, stamp):
    """Returns a point for each cell with a value: x, y, z [m], value (not scaled), action."""
    rows, columns = np.nonzero(np.isfinite(values))
    points = np.zeros(len(rows), dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"),
                                        ("value", "<f4"), ("action", "u1")])
    points["x"], points["y"] = columns * cell_size_m, rows * cell_size_m
    points["value"] = values[rows, columns]
    points["action"] = NO_ACTION
    cloud = PointCloud2()
    cloud.header.frame_id = FRAME
    cloud.header.stamp = stamp
    cloud.height, cloud.width = 1, len(points)
    cloud.point_step = points.dtype.itemsize
    cloud.row_step = cloud.point_step * cloud.width
    cloud.is_dense = True
    for name, (kind, offset) in points.dtype.fields.items():
        datatype = PointField.UINT8 if kind.itemsize == 1 else PointField.FLOAT32
        cloud.fields.append(PointField(name=name, offset=offset, datatype=datatype, count=1))
    cloud.data = points.tobytes()
    return cloud


def require_master():
    """Raises ValuesError without waiting if there is no ROS master."""
    if not rosgraph.is_master_online():
        raise ValuesError("--publish: cannot reach a ROS master at "
                          f"{rosgraph.rosenv.get_master_uri()}; start ./aquafarm sim first and "
                          "set ROS_MASTER_URI to its master")


def publish(values, cell_size_m, namespace):
    """Publishes the latched topics `values` and `values/points` in a namespace until Ctrl-C. Raises
    ValuesError if there is no ROS master."""
    require_master()
    rospy.init_node("values", anonymous=True)
    stamp = rospy.Time.from_sec(0)  # the values do not belong to a step
    name = f"{namespace.rstrip('/')}/values"
    grid = rospy.Publisher(name, OccupancyGrid, queue_size=1, latch=True)
    points = rospy.Publisher(f"{name}/points", PointCloud2, queue_size=1, latch=True)
    grid.publish(to_grid(values, cell_size_m, stamp))
    points.publish(to_points(values, cell_size_m, stamp))
    print(f"latched: {name}, {name}/points, until Ctrl-C", flush=True)
    rospy.spin()
