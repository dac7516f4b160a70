# SPDX-License-Identifier: BSD-3-Clause
"""The farm's core: scenarios, and batches of farms that write into NumPy arrays.

    batch = FarmBatch(Scenario.load("my.yaml"), farms=1024, write=["rewards", "planes"])
    batch.reset(seed=7)
    batch.step(numpy.zeros((1024, 1), numpy.uint8))
    batch.buffers["rewards"]
"""
import pathlib
import pkgutil

import numpy

# In a CMake build folder and a catkin devel space the native module is not next to the sources.
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
    ACTIONS, HOLD, OPTIMISED, OUTCOMES, PLANES, REASONS, STEP_LIMIT, TERMS, VERSION, FarmBatch,
    Scenario)

__version__ = VERSION
FarmBatch.__module__ = Scenario.__module__ = __name__  # where pickle finds them


def _scenario_folder():
    """Returns the folder of the shipped scenarios in the wheel, the install or the sources."""
    native = pathlib.Path(_native.__file__).resolve().parent
    for folder in (native / "scenarios", native.parents[3] / "share/aquafarm_sim/scenarios"):
        if folder.is_dir():
            return str(folder)
    return _native.SOURCE_SCENARIO_FOLDER


SCENARIO_FOLDER = _scenario_folder()

__all__ = ["ACTIONS", "HOLD", "OPTIMISED", "OUTCOMES", "PLANES", "REASONS", "SCENARIO_FOLDER",
           "STEP_LIMIT", "TERMS", "VERSION", "FarmBatch", "Scenario"]
