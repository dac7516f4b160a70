# SPDX-License-Identifier: BSD-3-Clause
"""A PettingZoo environment: one farm with ships and self-propelled devices as agents."""
from __future__ import annotations

import pathlib
import warnings
from collections.abc import Callable
from typing import Any

import aquafarm_core as core
import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

from aquafarm_gym import rendering, spaces
from aquafarm_gym.episodes import check_options
from aquafarm_gym.farms import LocalFarms
from aquafarm_gym.single_farm import SingleFarm, info_at, observation_at


class FarmParallelEnv(SingleFarm,
                      ParallelEnv[str, Any, Any]):  # type: ignore[misc, unused-ignore]
    """One farm whose agents are named ship_0, ship_1, … as in ROS. Self-propelled devices are the
    last agents; they terminate when they are delivered.

    Observations and infos are those of FarmEnv, one per agent. state() returns the observations of
    all agents in one array (`state_space`), for centralized critics.
    """

    metadata: dict[str, Any] = {"name": "aquafarm_v1", "render_modes": list(rendering.OFFERED),
                                "render_fps": rendering.FPS,
                                "is_parallelizable": True}
    possible_agents: list[str]
    agents: list[str]
    observation_spaces: dict[str, Any]
    action_spaces: dict[str, Any]
    state_space: gymnasium.Space[Any]

    def __init__(self, scenario: core.Scenario | str | pathlib.Path = "two_squads",
                 observation: str = "features", farms: Any = None,
                 render_mode: str | None = None, picture_size: tuple[int, int] = rendering.SIZE,
                 picture_layers: str = rendering.LAYERS,
                 picture_style: str = rendering.STYLE) -> None:
        """farms: a backend that replaces the scenario's farms in this process, such as RosFarms().
        picture_size, picture_layers, picture_style: as in FarmEnv."""
        super().__init__(farms or LocalFarms(scenario, 1, observation), observation, render_mode,
                         picture_size, picture_layers, picture_style)
        self.possible_agents = [f"ship_{i}" for i in range(self.farms.agents)]
        self.agents = []
        self.observation_spaces = {agent: spaces.observation_space(self.farms, observation)
                                   for agent in self.possible_agents}
        self.action_spaces = {agent: spaces.action_space() for agent in self.possible_agents}
        self.state_space = spaces.state_space(self.farms, observation)
        self._number = {agent: i for i, agent in enumerate(self.possible_agents)}

    def observation_space(self, agent: str) -> Any:
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Any:
        return self.action_spaces[agent]

    def reset(self, seed: int | None = None,
              options: dict[str, Any] | None = None) -> tuple[dict[str, Any], dict[str, Any]]:
        known = {"episode"}
        for name in set(options or ()) - known:  # PettingZoo's own tests pass unknown options
            warnings.warn(f"reset: options: got '{name}', expected one of: episode; it is ignored",
                          stacklevel=2)
        kept = {name: value for name, value in (options or {}).items() if name in known}
        options = check_options(kept, known)
        self.farms.reset(*self._episodes.next(seed, options, lambda: seeding.np_random()[1]))
        self.agents = self.possible_agents[:]
        return self._of_agents(self._observe), self._of_agents(self._info)

    def step(self, actions: dict[str, Any]) -> tuple[
            dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Any]]:
        if not self.agents:
            raise ValueError("step: the episode is over; reset first")
        if set(actions) != set(self.agents):
            raise ValueError(f"actions: got the agents {sorted(actions)}, expected {self.agents}")
        joint = np.full((1, self.farms.agents), core.HOLD, np.uint8)
        for agent, action in actions.items():
            if not self.action_spaces[agent].contains(action):
                raise ValueError(f"actions[{agent}]: got {action!r}, expected a whole number in "
                                 "[0, 9]")
            joint[0, self._number[agent]] = action
        self.farms.step(joint)
        reason = int(self._buffers["end_reasons"][0])
        truncated = reason == core.STEP_LIMIT
        over = reason != 0 and not truncated
        delivered = self._buffers["active"][0] == 0
        terminations = self._of_agents(lambda i: bool(over or delivered[i]))
        results = (self._of_agents(self._observe),
                   self._of_agents(lambda i: float(self._buffers["rewards"][0, i])), terminations,
                   self._of_agents(lambda i: bool(truncated and not delivered[i])),
                   self._of_agents(self._info))
        self.agents = [] if reason else [a for a in self.agents if not terminations[a]]
        return results

    def state(self) -> npt.NDArray[Any]:
        """Returns the observations of all agents, including delivered agents: features [S · F],
        planes [S · P, H, W], index [S]."""
        joint = self._observation[0].astype(self.state_space.dtype)
        return np.asarray(joint.reshape(self.state_space.shape))

    def render(self) -> Any:
        """Returns the farm as a picture, uint8 [height, width, 3] (`rgb_array`), or as text
        (`ansi`). In mode `human`, shows the farm in a window and returns None."""
        if self.render_mode == "human":
            self._window.show()
        return self._picture()

    def _of_agents(self, value: Callable[[int], Any]) -> dict[str, Any]:
        return {agent: value(self._number[agent]) for agent in self.agents}

    def _observe(self, i: int) -> Any:
        return observation_at(self.observation, self._observation, i)

    def _info(self, i: int) -> dict[str, Any]:
        return info_at(self.farms, i)

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, FarmParallelEnv) and self.observation == other.observation
                and (self.agents, self._episodes) == (other.agents, other._episodes)
                and bool(self.farms == other.farms))

    def __hash__(self) -> int:
        return hash((FarmParallelEnv, self.observation, self.farms))
