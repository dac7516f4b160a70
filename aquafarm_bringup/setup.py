# SPDX-License-Identifier: BSD-3-Clause
"""Lists the Python packages for catkin. Do not run it directly."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["aquafarm_bringup", "aquafarm_plan", "aquafarm_report"],
                                  package_data={"aquafarm_plan": ["plan.schema.json", "templates/*"],
                                                "aquafarm_report": ["templates/*"]},
                                  package_dir={"": "python"}))
