# SPDX-License-Identifier: BSD-3-Clause
"""Base class of the environments with one farm, and functions for the results of one agent."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from aquafarm_gym import spaces
from aquafarm_gym.episodes import NO_SUMMARY, Episodes, summary_of
from aquafarm_gym.farms import observation_of
from aquafarm_gym.rendering import Pictures, Window, check_render_mode, html_of


def observation_at(name: str, array: npt.NDArray[Any], agent: int) -> Any:
    """Returns a copy of the observation of an agent. name: type of the observation. array: the
    observations of all agents, [1, S, …]."""
    entry = array[0, agent]
    return np.int64(entry) if name == "index" else entry.copy()


def info_at(farms: Any, agent: int) -> dict[str, Any]:
    """Returns the info of an agent, as reset and step return it."""
    buffers = farms.buffers
    over = buffers["end_reasons"][0] != 0
    summary = summary_of(farms.finished()[0]) if over else NO_SUMMARY.copy()
    return {"action_mask": spaces.action_mask(buffers["legal"][0, agent]),
            "outcome": int(buffers["outcomes"][0, agent]), "reason": summary["reason"],
            "is_success": summary["success"], "summary": summary}


class SingleFarm:
    """Base class of the environments with one farm: rendering, copies and pickles."""

    farms: Any
    observation: str
    render_mode: str | None
    picture_size: tuple[int, int]
    picture_layers: str
    picture_style: str

    def __init__(self, farms: Any, observation: str, render_mode: str | None,
                 picture_size: tuple[int, int], picture_layers: str, picture_style: str) -> None:
        self.farms = farms
        self.observation = observation
        self.render_mode = check_render_mode(render_mode, farms)
        self.picture_size, self.picture_layers = picture_size, picture_layers
        self.picture_style = picture_style
        self._episodes = Episodes()
        self._attach()

    def _attach(self) -> None:
        """Sets the members that refer to the arrays of the farms."""
        self._buffers = self.farms.buffers
        self._observation = observation_of(self.farms, self.observation)
        self._pictures = Pictures(self.farms, self.picture_size, self.picture_layers,
                                  self.picture_style)
        self._window = Window(self._pictures, self.farms)

    def _picture(self) -> Any:
        """Returns a picture (`rgb_array`) or text (`ansi`); None in mode `human` and without a
        mode."""
        if self.render_mode == "rgb_array":
            return self._pictures.draw()
        return str(self.farms.text(0)) if self.render_mode == "ansi" else None

    def close(self) -> None:
        """Closes the window and the farms."""
        self._window.close()
        self.farms.close()

    def _repr_html_(self) -> str:
        return html_of(self.farms, self._pictures, [0])

    def __getstate__(self) -> dict[str, Any]:
        views = ("_buffers", "_observation", "_pictures", "_window")
        return {name: value for name, value in self.__dict__.items() if name not in views}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._attach()
