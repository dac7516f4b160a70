# SPDX-License-Identifier: BSD-3-Clause
from typing import SupportsIndex

import numpy as np
import numpy.typing as npt

from aquafarm_core import FarmBatch

LAYERS: str
__all__ = ["LAYERS", "Painter"]

class Painter:
    """Draws the farms of a batch as ./aquafarm render does."""

    def __init__(self, width: SupportsIndex = 800, height: SupportsIndex = 640,
                 layers: str = "trail,risk,labels", style: str = "dark") -> None: ...
    def draw(self, batch: FarmBatch, farm: SupportsIndex = 0) -> npt.NDArray[np.uint8]: ...
