# SPDX-License-Identifier: BSD-3-Clause
"""For catkin alone: where the Python packages lie."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_benchmark"], package_dir={"": "python"}))
