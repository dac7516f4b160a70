# SPDX-License-Identifier: BSD-3-Clause
"""Wrappers that add the action mask to the observation. The observation becomes a dict with the
entries "observation" and "action_mask" (int8 […, 10]). The classic environments of PettingZoo use
these names, and tianshou reads them."""
from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector.utils import batch_space

from aquafarm_gym.spaces import N_ACTIONS


def masked_space(space: gymnasium.Space[Any], shape: tuple[int, ...] = ()) -> gymnasium.spaces.Dict:
    """Returns the space of an observation in `space` with an action mask int8 [*shape, 10]."""
    masks = gymnasium.spaces.Box(0, 1, (*shape, N_ACTIONS), np.int8)
    return gymnasium.spaces.Dict({"observation": space, "action_mask": masks})


def joined(observation: Any, infos: dict[str, Any]) -> dict[str, Any]:
    """Returns a dict with an observation and the action mask from `infos`."""
    return {"observation": observation, "action_mask": infos["action_mask"]}


class ActionMaskInObservation(gymnasium.Wrapper[Any, Any, Any, Any],
                              gymnasium.utils.RecordConstructorArgs):
    """FarmEnv with observations {"observation", "action_mask"}."""

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        gymnasium.utils.RecordConstructorArgs.__init__(self)
        super().__init__(env)
        self.observation_space = masked_space(env.observation_space)

    def reset(self, *, seed: int | None = None,
              options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        observation, info = self.env.reset(seed=seed, options=options)
        return joined(observation, info), info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        observation, reward, terminated, truncated, info = self.env.step(action)
        return joined(observation, info), reward, terminated, truncated, info


class VectorActionMaskInObservation(gymnasium.vector.VectorWrapper):
    """FarmVectorEnv or TeamVectorEnv with observations {"observation", "action_mask"}."""

    def __init__(self, env: Any) -> None:
        super().__init__(env)
        agents = env.single_action_space.shape
        self.single_observation_space = masked_space(env.single_observation_space, agents)
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)

    def reset(self, *, seed: Any = None,
              options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        observation, infos = self.env.reset(seed=seed, options=options)
        return joined(observation, infos), infos

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        observation, rewards, terminated, truncated, infos = self.env.step(actions)
        if "final_obs" in infos:
            last = np.full(self.num_envs, None)
            for i in np.flatnonzero(infos["_final_obs"]):
                last[i] = {"observation": infos["final_obs"][i],
                           "action_mask": infos["final_info"]["action_mask"][i]}
            infos = {**infos, "final_obs": last}
        return joined(observation, infos), rewards, terminated, truncated, infos
