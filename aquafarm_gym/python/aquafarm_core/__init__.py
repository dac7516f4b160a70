# SPDX-License-Identifier: BSD-3-Clause
"""The C++ core: scenarios, batches of farms that write into NumPy arrays, planners and policies.

    batch = FarmBatch(Scenario.load("my.yaml"), farms=1024, write=["rewards", "planes"])
    batch.reset(seed=7)
    batch.step(numpy.zeros((1024, 1), numpy.uint8))
    batch.buffers["rewards"]
    batch.step(Policy("planner", batch.scenario, farms=1024).act(batch))
"""
import pathlib
import pkgutil

import numpy

# In a CMake build folder and in a catkin devel space, the native module is in another folder than
# the sources.
__path__ = pkgutil.extend_path(__path__, __name__)

try:
    from aquafarm_core import _native  # noqa: E402
except ImportError as error:
    raise ImportError(
        f"aquafarm_core: got no native module for this Python from {list(__path__)} ({error}), "
        "expected one; pip install ./aquafarm_gym, or build it as docs/python.md says") from error
from aquafarm_core._abi import numpy_fault  # noqa: E402

_fault = numpy_fault(_native, numpy)
if _fault:
    raise ImportError(_fault)

from aquafarm_core._native import (  # noqa: E402
    ACTIONS, ADDED_COLUMNS, DEVICE_KINDS, DISASTER_KINDS, EPISODE_COLUMNS, HOLD, NO_EPISODE,
    OPTIMISED, OUTCOMES, PLANES, REASONS, STEP_LIMIT, TERMS, VERSION, FarmBatch, Planner, Policy,
    Scenario, team_bound)

__version__ = VERSION
for _type in (FarmBatch, Planner, Policy, Scenario):
    _type.__module__ = __name__  # the module in which pickle looks for the type


def _shipped(name, package, source):
    """Returns the folder of shipped files in the wheel or install space, or else `source`."""
    native = pathlib.Path(_native.__file__).resolve().parent
    prefixes = list(native.parents)[3:4]  # empty if there are at most 3 parents
    for folder in (native / name, *(one / "share" / package / name for one in prefixes)):
        if folder.is_dir():
            return str(folder)
    return source


SCENARIO_FOLDER = _shipped("scenarios", "aquafarm_sim", _native.SOURCE_SCENARIO_FOLDER)
_native._set_policy_folder(
    _shipped("policies", "aquafarm_agents", _native.SOURCE_POLICY_FOLDER))

__all__ = ["ACTIONS", "ADDED_COLUMNS", "DEVICE_KINDS", "DISASTER_KINDS", "EPISODE_COLUMNS", "HOLD",
           "NO_EPISODE", "OPTIMISED", "OUTCOMES", "PLANES", "REASONS", "SCENARIO_FOLDER",
           "STEP_LIMIT", "TERMS", "VERSION", "FarmBatch", "Planner", "Policy", "Scenario",
           "team_bound"]
