# SPDX-License-Identifier: BSD-3-Clause
"""Folder of the Python packages, for catkin. Wheels are built by pyproject.toml."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_core", "aquafarm_gym"], package_dir={"": "python"}))
