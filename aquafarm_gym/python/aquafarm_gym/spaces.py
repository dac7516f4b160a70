# SPDX-License-Identifier: BSD-3-Clause
"""The spaces of one agent; the same for farms in process and behind ROS."""
import aquafarm_core as core
import numpy as np
from gymnasium import spaces

ACTION_BITS = np.left_shift(1, np.arange(len(core.ACTIONS))).astype(np.uint16)


def action_space():
    """The paper's ten actions: eight moves, pickup, drop-off (names: aquafarm_core.ACTIONS)."""
    return spaces.Discrete(len(core.ACTIONS))


def observation_space(farms, encoding):
    """Discrete for `index`, Box for `features` and `planes`."""
    if encoding == "index":
        return spaces.Discrete(farms.state_count)
    if encoding == "features":
        return spaces.Box(-np.inf, np.inf, (farms.feature_count,), np.float32)
    return spaces.Box(0, 255, (farms.plane_count, farms.height, farms.width), np.uint8)


def action_mask(legal):
    """Bits of legal actions [...] as 0 and 1 [..., 10], as Discrete.sample(mask) takes them."""
    return ((np.asarray(legal)[..., None] & ACTION_BITS) != 0).astype(np.int8)
