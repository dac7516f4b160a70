# SPDX-License-Identifier: BSD-3-Clause
"""A PettingZoo environment: one farm whose ships, and devices that drive themselves, act."""
import aquafarm_core as core
import numpy as np
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

from aquafarm_gym import spaces
from aquafarm_gym.env import Episodes, observation_of
from aquafarm_gym.farms import LocalFarms


class FarmParallelEnv(ParallelEnv):
    """One farm with several agents, named ship_0, ship_1, … as in ROS; those that are
    self-propelled devices come last and end on their own when they are delivered.

    Observations and infos are those of FarmEnv, an agent each.
    """

    metadata = {"name": "aquafarm_v0", "render_modes": [], "is_parallelizable": True}

    def __init__(self, scenario="two_squads", observation="features", farms=None,
                 render_mode=None):
        """farms: a backend instead of a scenario played in this process, such as RosFarms()."""
        self.farms = farms or LocalFarms(scenario, 1, observation)
        self.render_mode = render_mode
        self.possible_agents = [f"ship_{i}" for i in range(self.farms.agents)]
        self.agents = []
        self.observation_spaces = {agent: spaces.observation_space(self.farms, observation)
                                   for agent in self.possible_agents}
        self.action_spaces = {agent: spaces.action_space() for agent in self.possible_agents}
        self._is_index = observation == "index"
        self._buffers = self.farms.buffers
        self._observation = observation_of(self.farms, observation)
        self._episodes = Episodes()
        self._number = {agent: i for i, agent in enumerate(self.possible_agents)}

    def observation_space(self, agent):
        return self.observation_spaces[agent]

    def action_space(self, agent):
        return self.action_spaces[agent]

    def reset(self, seed=None, options=None):
        self.farms.reset(*self._episodes.next(seed, options, lambda: seeding.np_random()[1]))
        self.agents = self.possible_agents[:]
        return self._of_agents(self._observe), self._of_agents(self._info)

    def step(self, actions):
        if set(actions) != set(self.agents):
            raise ValueError(f"actions: got those of {sorted(actions)}, expected {self.agents}")
        if not self.agents:
            raise ValueError("the episode is over: reset first")
        joint = np.full((1, self.farms.agents), core.HOLD, np.uint8)
        for agent, action in actions.items():
            if not self.action_spaces[agent].contains(action):
                raise ValueError(f"actions[{agent}]: got {action!r}, expected a whole number in "
                                 "[0, 9]")
            joint[0, self._number[agent]] = action
        self.farms.step(joint)
        reason = int(self._buffers["reasons"][0])
        truncated = reason == core.STEP_LIMIT
        over = reason != 0 and not truncated
        delivered = self._buffers["in_play"][0] == 0
        terminations = self._of_agents(lambda i: bool(over or delivered[i]))
        results = (self._of_agents(self._observe),
                   self._of_agents(lambda i: float(self._buffers["rewards"][0, i])), terminations,
                   self._of_agents(lambda i: bool(truncated and not delivered[i])),
                   self._of_agents(self._info))
        self.agents = [] if reason else [a for a in self.agents if not terminations[a]]
        return results

    def close(self):
        self.farms.close()

    def _of_agents(self, value):
        return {agent: value(self._number[agent]) for agent in self.agents}

    def _observe(self, i):
        entry = self._observation[0, i]
        return int(entry) if self._is_index else entry.copy()

    def _info(self, i):
        info = {"action_mask": spaces.action_mask(self._buffers["legal"][0, i]),
                "outcome": core.OUTCOMES[self._buffers["outcomes"][0, i]]}
        if self._buffers["reasons"][0] != 0:
            info["summary"] = self.farms.finished()[0]
            info["is_success"] = info["summary"]["success"]
        return info
