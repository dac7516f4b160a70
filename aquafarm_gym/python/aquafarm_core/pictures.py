# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of farms, drawn with the code of ./aquafarm render and of the image topic.

    painter = Painter(800, 640, "trail,risk,labels")
    painter.draw(batch, farm=0)                     # uint8 [640, 800, 3], RGB
"""
from aquafarm_core import _native  # noqa: F401  (defines FarmBatch)

try:
    from aquafarm_core._pictures import LAYERS, Painter
except ImportError as error:
    raise ImportError(
        f"aquafarm_core: got no module that draws pictures ({error}), expected one; install OpenCV "
        "and FreeType (Debian: libopencv-dev libfreetype-dev fonts-dejavu-core) and run pip "
        "install ./aquafarm_gym again, or use render_mode='ansi'") from error

Painter.__module__ = __name__

__all__ = ["LAYERS", "Painter"]
