# SPDX-License-Identifier: BSD-3-Clause
"""What the environments of one farm return for one of its agents."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from aquafarm_gym import spaces
from aquafarm_gym.episodes import NO_SUMMARY, summary_of


def observation_at(name: str, array: npt.NDArray[Any], agent: int) -> Any:
    """Returns a copy of the observation `name` of an agent; array: [1, S, ...]."""
    entry = array[0, agent]
    return np.int64(entry) if name == "index" else entry.copy()


def info_at(farms: Any, agent: int) -> dict[str, Any]:
    """Returns the info of an agent after reset and step."""
    buffers = farms.buffers
    over = buffers["end_reasons"][0] != 0
    summary = summary_of(farms.finished()[0]) if over else NO_SUMMARY.copy()
    return {"action_mask": spaces.action_mask(buffers["legal"][0, agent]),
            "outcome": int(buffers["outcomes"][0, agent]), "reason": summary["reason"],
            "is_success": summary["success"], "summary": summary}
