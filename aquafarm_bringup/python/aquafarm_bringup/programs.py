# SPDX-License-Identifier: BSD-3-Clause
"""Finds the programs of the workspace."""


def find_program(package, name):
    """Returns the path of a program; None if the package is not in the environment or the program
    is not built."""
    import roslib.packages  # imported here, because some callers may run without ROS
    import rospkg
    try:
        found = roslib.packages.find_node(package, name)
    except rospkg.ResourceNotFound:
        return None
    return found[0] if found else None
