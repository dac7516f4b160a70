# SPDX-License-Identifier: BSD-3-Clause
"""For catkin alone: where the Python package lies."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_report"], package_dir={"": "python"}))
