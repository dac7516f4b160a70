# SPDX-License-Identifier: BSD-3-Clause
"""The spaces of observations and actions. They are the same for farms in this process and farms
behind ROS."""
from typing import Any

import aquafarm_core as core
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

N_ACTIONS: int = len(core.ACTIONS)

# Bounds of the features by the last part of their names (FarmBatch.feature_names). Lengths are in
# units of the map's longer side. FAR bounds the position of a storm's centre, which may be far
# outside the map, and the reach of a storm, which may be far larger than the map.
FAR: float = 1e4
BOUNDS: dict[str, tuple[float, float]] = {
    "x": (-1, 1), "y": (-1, 1), "time_left": (-1, 1), "free_capacity": (0, 1),
    "risk_here": (-1, 0), "deployed": (0, 1), "aboard": (0, 1), "worth": (0, 100),
    "known": (0, 1), "motion_east": (-FAR, FAR), "motion_north": (-FAR, FAR), "reach": (0, FAR),
    "age": (0, FAR), "visible": (0, 1), "self": (0, 1), "way_east": (-1, 1), "way_north": (-1, 1),
    "way_steps": (0, 4), "energy_used": (0, FAR), "grade": (0, 1), "risk": (0, 1)}
# Last parts of the names of the one-hot features for the kind of a device or disaster (view.kinds).
KINDS: tuple[str, ...] = (*core.DEVICE_KINDS, *core.DISASTER_KINDS)
GROUP_BOUNDS: dict[str, tuple[float, float]] = {
    "blocked": (0, 1), "risk": (-1, 0), "course": (-1, 0)}


# Bound of the features of entity tokens (view.tokens, docs/generalist.md). Features whose names
# contain a word of UNCLAMPED are not clamped: device values, loads and risks.
TOKEN_BOUND: float = 4.0
UNCLAMPED: tuple[str, ...] = ("value", "worth", "aboard", "capacity", "risk", "course")


def feature_bounds(name: str, is_token: bool = False) -> tuple[float, float]:
    """Returns the min and max value of a feature. is_token: whether the farms have view.tokens."""
    if is_token:
        is_unclamped = any(word in name for word in UNCLAMPED)
        return (-FAR, FAR) if is_unclamped else (-TOKEN_BOUND, TOKEN_BOUND)
    group, _, part = name.rpartition(".")
    if group in GROUP_BOUNDS:
        return GROUP_BOUNDS[group]
    if part in ("east", "north"):
        return (-FAR, FAR) if group.startswith(("disaster", "slot")) else (-1, 1)
    if part.startswith(("east_", "north_")):  # a forecast position of a slot
        return (-FAR, FAR)
    return (0, 1) if part in KINDS else BOUNDS[part]


def action_space() -> spaces.Discrete:
    """Returns the space of the actions: eight moves, pickup, drop-off (aquafarm_core.ACTIONS)."""
    return spaces.Discrete(N_ACTIONS)


def observation_space(farms: Any, observation: str) -> spaces.Space[Any]:
    """Returns the space of one agent: Discrete for `index`, a bounded Box for `features` and
    `planes`."""
    if observation == "index":
        return spaces.Discrete(farms.state_count)
    if observation == "features":
        names = farms.feature_names
        has_tokens = "ship.time_left_short" in names  # exists only with view.tokens
        bounds = np.array([feature_bounds(name, has_tokens) for name in names], np.float32)
        return spaces.Box(bounds[:, 0], bounds[:, 1], dtype=np.float32)
    return spaces.Box(0, 255, (farms.plane_count, farms.height, farms.width), np.uint8)


def action_mask(legal: npt.ArrayLike) -> npt.NDArray[np.int8]:
    """Converts bit masks of legal actions […] to int8 […, 10] with 1 for legal. Discrete.sample
    accepts such a mask for one agent."""
    bits = np.array(legal, "<u2")[..., None].view(np.uint8)
    return np.unpackbits(bits, axis=-1, count=N_ACTIONS, bitorder="little").view(np.int8)


def state_space(farms: Any, observation: str) -> spaces.Space[Any]:
    """Returns the space of the observations of all agents in one array (FarmParallelEnv.state)."""
    own = observation_space(farms, observation)
    if isinstance(own, spaces.Discrete):
        return spaces.MultiDiscrete([int(own.n)] * farms.agents)
    assert isinstance(own, spaces.Box)
    low, high = (np.concatenate([bound] * farms.agents) for bound in (own.low, own.high))
    return spaces.Box(low, high, dtype=own.dtype.type)
