# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium environments: one farm with one ship, and many of them as arrays."""
import aquafarm_core as core
import gymnasium
import numpy as np
from gymnasium.vector.utils import batch_space

from aquafarm_gym import spaces
from aquafarm_gym.farms import ENCODINGS, LocalFarms

SEED_MASK = (1 << 64) - 1


def one_agent(farms):
    """Refuses farms of several agents."""
    if farms.agents != 1:
        raise ValueError(f"scenario {farms.name}: got {farms.agents} agents, expected 1; "
                         "FarmParallelEnv is for several")
    return farms


def observation_of(farms, observation):
    """The array of an observation; refuses farms that do not write it."""
    if observation not in farms.buffers:
        has = ", ".join(name for name in ENCODINGS if name in farms.buffers)
        raise ValueError(f"observation: got '{observation}', but the farms given write {has}")
    return farms.buffers[observation]


class Episodes:
    """Where the sequence of episodes stands: a seed starts one, a reset without seed goes on."""

    def __init__(self):
        self.seed, self.episode = None, 0

    def next(self, seed, options, drawn_seed, by=1):
        """The (seed, episode) to begin; options may name an `episode` of the sequence."""
        if seed is None and self.seed is not None:
            self.episode += by
        else:
            self.seed = (seed if seed is not None else drawn_seed()) & SEED_MASK
            self.episode = 0
        if options and "episode" in options:
            self.episode = int(options["episode"])
        return self.seed, self.episode


class FarmEnv(gymnasium.Env):
    """One farm with one ship.

    observation: `features` (default), `planes` or `index`. info holds `action_mask` (1: would not
    be illegal), `outcome` (a name of aquafarm_core.OUTCOMES) and, when an episode is over,
    `is_success` and `summary`. reset(seed=…) starts a sequence of episodes, reset() goes on with
    its next one, options={"episode": k} with its k-th.
    """

    metadata = {"render_modes": []}

    def __init__(self, scenario="paper", observation="features", farms=None, render_mode=None):
        """farms: a backend instead of a scenario played in this process, such as RosFarms()."""
        self.farms = one_agent(farms or LocalFarms(scenario, 1, observation))
        self.render_mode = render_mode
        self.action_space = spaces.action_space()
        self.observation_space = spaces.observation_space(self.farms, observation)
        self._is_index = observation == "index"
        self._buffers = self.farms.buffers
        self._observation = observation_of(self.farms, observation)
        self._episodes = Episodes()
        self._actions = np.zeros((1, 1), np.uint8)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.farms.reset(*self._episodes.next(seed, options, lambda: self.np_random_seed))
        return self._observe(), self._info()

    def step(self, action):
        if not self.action_space.contains(action):
            raise ValueError(f"action: got {action!r}, expected a whole number in [0, 9]")
        if self._buffers["reasons"][0] != 0:
            raise gymnasium.error.ResetNeeded("the episode is over: reset first")
        self._actions[0, 0] = action
        self.farms.step(self._actions)
        reason = int(self._buffers["reasons"][0])
        truncated = reason == core.STEP_LIMIT
        return (self._observe(), float(self._buffers["rewards"][0, 0]),
                reason != 0 and not truncated, truncated, self._info())

    def action_masks(self):
        """Legal actions as sb3_contrib's MaskablePPO asks for them."""
        return spaces.action_mask(self._buffers["legal"][0, 0]).astype(bool)

    def close(self):
        self.farms.close()

    def _observe(self):
        entry = self._observation[0, 0]
        return int(entry) if self._is_index else entry.copy()

    def _info(self):
        info = {"action_mask": spaces.action_mask(self._buffers["legal"][0, 0]),
                "outcome": core.OUTCOMES[self._buffers["outcomes"][0, 0]]}
        if self._buffers["reasons"][0] != 0:
            info["summary"] = self.farms.finished()[0]
            info["is_success"] = info["summary"]["success"]
        return info


class FarmVectorEnv(gymnasium.vector.VectorEnv):
    """N farms with one ship each, stepped together in this process (or behind ROS, by `farms`).

    A farm whose episode is over starts its next one in the next step, whose action it ignores.
    With copy=False observations and rewards are the arrays that the farms write, overwritten by
    the next step. infos holds `legal` (bits, uint16 [N]; spaces.action_mask unfolds them) and
    `started`, and `summary` where episodes are over; each with its mask `_legal`, `_started`,
    `_summary` [N], as Gymnasium's vector environments have it.
    """

    metadata = {"render_modes": []}
    if hasattr(gymnasium.vector, "AutoresetMode"):  # since Gymnasium 1.1
        metadata["autoreset_mode"] = gymnasium.vector.AutoresetMode.NEXT_STEP

    def __init__(self, num_envs=1, scenario="paper", observation="features", copy=True, threads=1,
                 farms=None, render_mode=None):
        self.farms = one_agent(farms or LocalFarms(scenario, num_envs, observation,
                                                   threads=threads))
        self.num_envs = self.farms.farms
        self.render_mode = render_mode
        self.single_action_space = spaces.action_space()
        self.single_observation_space = spaces.observation_space(self.farms, observation)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        buffers = self.farms.buffers
        self._observation = observation_of(self.farms, observation)[:, 0]
        self._rewards = buffers["rewards"][:, 0]
        self._reasons, self._started = buffers["reasons"], buffers["started"].view(bool)
        self._legal = buffers["legal"][:, 0]
        self._everywhere = np.ones(self.num_envs, bool)
        self._everywhere.flags.writeable = False
        self._copy = copy
        self._actions = np.zeros((self.num_envs, 1), np.uint8)
        self._episodes = Episodes()
        self._begun = np.zeros(self.num_envs, int)  # episodes since the last reset, by farm

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        # Farm i of N plays every N-th episode: go on behind the farm that has come furthest.
        by = self.num_envs * (1 + int(self._begun.max()))
        self.farms.reset(*self._episodes.next(seed, options, lambda: self.np_random_seed, by))
        self._begun[:] = 0
        return self._out(self._observation), self._infos()

    def step(self, actions):
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs,) or actions.dtype.kind not in "iu":
            raise ValueError(f"actions: got {actions.dtype} {list(actions.shape)}, expected whole "
                             f"numbers [{self.num_envs}]")
        if actions.min() < 0 or actions.max() >= len(core.ACTIONS):
            raise ValueError(f"actions: got {actions.min()} to {actions.max()}, expected [0, 9]")
        self._actions[:, 0] = actions
        self.farms.step(self._actions)
        self._begun += self._started
        truncated = self._reasons == core.STEP_LIMIT
        terminated = (self._reasons != 0) ^ truncated
        return (self._out(self._observation), self._out(self._rewards), terminated, truncated,
                self._infos())

    def close_extras(self, **kwargs):
        self.farms.close()

    def _out(self, array):
        return array.copy() if self._copy else array

    def _infos(self):
        infos = {"legal": self._out(self._legal), "_legal": self._everywhere,
                 "started": self._out(self._started), "_started": self._everywhere}
        if self._reasons.any():
            over = self._reasons != 0
            infos["summary"] = np.full(self.num_envs, None)
            infos["summary"][over] = self.farms.finished()  # by farm
            infos["_summary"] = over
        return infos
