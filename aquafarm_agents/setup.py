# SPDX-License-Identifier: BSD-3-Clause
"""Describes the folder of the Python packages to catkin. No other tool uses this file."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_benchmark"], package_dir={"": "python"}))
