# SPDX-License-Identifier: BSD-3-Clause
"""For catkin alone, which reads no pyproject.toml: the folder of the Python packages."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_core", "aquafarm_gym"], package_dir={"": "python"}))
