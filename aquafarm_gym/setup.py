# SPDX-License-Identifier: BSD-3-Clause
"""Lists the Python packages for catkin. Wheels are built from pyproject.toml."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_core", "aquafarm_gym"], package_dir={"": "python"}))
