# SPDX-License-Identifier: BSD-3-Clause
"""The Gymnasium environment of one farm with one ship."""
from __future__ import annotations

import pathlib
from typing import Any

import aquafarm_core as core
import gymnasium
import numpy as np
import numpy.typing as npt

from aquafarm_gym import rendering, spaces
from aquafarm_gym.episodes import check_options, check_seed
from aquafarm_gym.farms import LocalFarms
from aquafarm_gym.single_farm import SingleFarm, info_at, observation_at


def one_agent(farms: Any) -> Any:
    """Returns `farms`. Raises ValueError if they have several agents."""
    if farms.agents != 1:
        raise ValueError(f"scenario {farms.name}: got {farms.agents} agents, expected 1; use "
                         "FarmParallelEnv or TeamVectorEnv")
    return farms


class FarmEnv(SingleFarm, gymnasium.Env[Any, Any]):
    """One farm with one ship.

    observation: `features` (default), `planes` or `index`. info has the same keys at every step,
    and contains no text: `action_mask` (int8 [10], 1: legal), `outcome` (index into
    aquafarm_core.OUTCOMES), `reason` (index into aquafarm_core.REASONS, 0: the episode continues),
    `is_success`, and `summary`, whose entries are 0 until the episode ends. Each seed has its own
    sequence of episodes: reset(seed=…) starts episode 0, reset() starts the next episode, and
    reset(options={"episode": k}) starts episode k of the sequence. If the farms are in this
    process, copies and pickles of the environment continue bit-identically.
    """

    metadata: dict[str, Any] = {"render_modes": list(rendering.OFFERED),
                                "render_fps": rendering.FPS}
    action_space: gymnasium.Space[Any]
    observation_space: gymnasium.Space[Any]

    def __init__(self, scenario: core.Scenario | str | pathlib.Path = "paper",
                 observation: str = "features", farms: Any = None,
                 render_mode: str | None = None, picture_size: tuple[int, int] = rendering.SIZE,
                 picture_layers: str = rendering.LAYERS,
                 picture_style: str = rendering.STYLE) -> None:
        """farms: a backend that replaces the scenario's farms in this process, such as RosFarms().
        picture_size: width and height of pictures [pixels]. picture_layers: some names of
        aquafarm_core.pictures.LAYERS, separated by commas. picture_style: dark or light."""
        super().__init__(one_agent(farms or LocalFarms(scenario, 1, observation)), observation,
                         render_mode, picture_size, picture_layers, picture_style)
        self.action_space = spaces.action_space()
        self.observation_space = spaces.observation_space(self.farms, observation)
        self._actions = np.zeros((1, 1), np.uint8)

    def reset(self, *, seed: int | None = None,
              options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        options = check_options(options, ("episode",))
        if seed is not None:
            seed = check_seed(seed)
        super().reset(seed=seed)
        self.farms.reset(*self._episodes.next(seed, options, lambda: self.np_random_seed))
        self._show()
        return self._observe(), self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        if not self.action_space.contains(action):
            raise ValueError(f"action: got {action!r}, expected a whole number in [0, 9]")
        if self._buffers["end_reasons"][0] != 0:
            raise gymnasium.error.ResetNeeded("step: the episode is over; reset first")
        self._actions[0, 0] = action
        self.farms.step(self._actions)
        self._show()
        reason = int(self._buffers["end_reasons"][0])
        truncated = reason == core.STEP_LIMIT
        return (self._observe(), float(self._buffers["rewards"][0, 0]),
                reason != 0 and not truncated, truncated, self._info())

    def render(self) -> Any:
        """Returns the farm as a picture, uint8 [height, width, 3] (`rgb_array`), or as text
        (`ansi`; farm_text.h explains the symbols). In mode `human`, each reset and step shows the
        farm."""
        if self.render_mode is None:
            gymnasium.logger.warn("render: got render_mode None, expected rgb_array or ansi; pass "
                                  "render_mode='rgb_array' to the constructor")
        return self._picture()

    def _show(self) -> None:
        if self.render_mode == "human":
            self._window.show()

    def action_masks(self) -> npt.NDArray[np.bool_]:
        """Returns the legal actions, bool [10], for MaskablePPO of sb3_contrib."""
        return spaces.action_mask(self._buffers["legal"][0, 0]).astype(bool)

    def _observe(self) -> Any:
        return observation_at(self.observation, self._observation, 0)

    def _info(self) -> dict[str, Any]:
        return info_at(self.farms, 0)

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, FarmEnv) and self.observation == other.observation
                and self._episodes == other._episodes and bool(self.farms == other.farms))

    def __hash__(self) -> int:
        return hash((FarmEnv, self.observation, self.farms))
