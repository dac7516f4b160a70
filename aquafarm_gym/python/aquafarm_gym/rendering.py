# SPDX-License-Identifier: BSD-3-Clause
"""The render modes of all environments: text, pictures and a window."""
from __future__ import annotations

import base64
import html
import importlib.util
import os
import struct
import sys
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

SIZE: tuple[int, int] = (800, 640)
LAYERS: str = "trail,risk,labels"
STYLE: str = "dark"
MODES: tuple[str, ...] = ("ansi", "human", "rgb_array")
# The modes that this installation supports. A wheel built without OpenCV cannot draw pictures.
OFFERED: tuple[str, ...] = (MODES if importlib.util.find_spec("aquafarm_core._pictures")
                            else ("ansi", "human"))
FPS: int = 4
Pixels = npt.NDArray[np.uint8]


def check_render_mode(render_mode: str | None, farms: Any,
                      modes: tuple[str, ...] = MODES) -> str | None:
    """Returns the mode. Raises ValueError if it is unknown or the farms cannot be rendered, and
    ImportError if the mode is rgb_array and this installation cannot draw pictures."""
    if render_mode not in (None, *modes):
        raise ValueError(f"render_mode: got {render_mode!r}, expected {', '.join(modes)} or None")
    if render_mode is not None and not hasattr(farms, "text"):
        raise ValueError(f"render_mode: got '{render_mode}' for farms behind ROS, expected None; "
                         "watch them in rviz")
    if render_mode == "rgb_array":
        import aquafarm_core.pictures  # noqa: F401
    return render_mode


class Pictures:
    """Draws the farms of a backend. Each farm has its own painter, which keeps the trails of its
    ships."""

    def __init__(self, farms: Any, size: tuple[int, int] = SIZE, layers: str = LAYERS,
                 style: str = STYLE) -> None:
        """size: width and height [pixels], each in [160, 4096]. layers, style: as in ./aquafarm
        render."""
        self._farms = farms
        self._size = size
        self._layers, self._style = layers, style
        self._painters: dict[int, Any] = {}

    def draw(self, farm: int = 0) -> Pixels:
        """Returns a picture of a farm in its present state, uint8 [height, width, 3], RGB."""
        if farm not in self._painters:
            from aquafarm_core.pictures import Painter
            self._painters[farm] = Painter(*self._size, self._layers, self._style)
        pixels: Pixels = self._painters[farm].draw(self._farms.batch, farm)
        return pixels


class Window:
    """Shows the first farm in a pygame window. Prints the farm as text if pygame, OpenCV or a
    reachable display is missing."""

    def __init__(self, pictures: Pictures, farms: Any) -> None:
        self._pictures, self._farms = pictures, farms
        self._screen: Any = None
        self._clock: Any = None
        self._works = has_display()

    def show(self) -> None:
        """Shows the present state. With a window, returns at the earliest 1/FPS seconds after the
        previous picture."""
        if self._works and self._screen is None:
            self._works = self._open()
        if not self._works:
            print(self._farms.text(0))
            return
        import pygame
        surface = pygame.surfarray.make_surface(self._pictures.draw().swapaxes(0, 1))
        self._screen.blit(surface, (0, 0))
        pygame.event.pump()
        pygame.display.flip()
        self._clock.tick(FPS)

    def _open(self) -> bool:
        try:
            import aquafarm_core.pictures  # noqa: F401
            import pygame
        except ImportError as error:
            return self._refuse(error)
        picture = self._pictures.draw()
        try:
            pygame.display.init()
            self._screen = pygame.display.set_mode((picture.shape[1], picture.shape[0]))
        except pygame.error as error:  # for example, the X server cannot be reached
            pygame.display.quit()
            return self._refuse(error)
        pygame.display.set_caption(f"aquafarm: {self._farms.name}")
        self._clock = pygame.time.Clock()
        return True

    @staticmethod
    def _refuse(error: Exception) -> bool:
        print(f"render_mode human: prints text, because: {error}", file=sys.stderr)
        return False

    def close(self) -> None:
        """Closes the window."""
        if self._screen is not None:
            import pygame
            pygame.display.quit()
            self._screen = None


def has_display() -> bool:
    """Returns whether a window can probably be opened. On Linux, DISPLAY, WAYLAND_DISPLAY or
    SDL_VIDEODRIVER must be set. Always returns True on other systems."""
    if sys.platform != "linux":
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"))


def png_of(pixels: Pixels) -> bytes:
    """Returns a PNG file (ISO/IEC 15948) of an RGB picture, uint8 [height, width, 3]."""
    height, width = pixels.shape[:2]
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # per row: filter type 0 (none), pixels
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(
            ">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
            + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


def html_of(farms: Any, pictures: Pictures | None, numbers: range | list[int]) -> str:
    """Returns farms as HTML for a notebook: pictures, or text if this installation cannot draw
    pictures. Farms behind ROS are shown by their repr. numbers: indices of the farms to show."""
    if not hasattr(farms, "text"):
        return f"<pre>{html.escape(repr(farms))}</pre>"
    parts = []
    for farm in numbers:
        try:
            if pictures is None:
                pictures = Pictures(farms)
            data = base64.b64encode(png_of(pictures.draw(farm))).decode()
            parts.append(f'<img alt="farm {farm} of {html.escape(farms.name)}" '
                         f'src="data:image/png;base64,{data}">')
        except ImportError:
            parts.append(f'<pre style="line-height: 1.1">{html.escape(farms.text(farm))}</pre>')
    return "".join(parts)
