# SPDX-License-Identifier: BSD-3-Clause
"""Many farms for Stable-Baselines3, stepped together in C++. One policy plays all ships."""
from __future__ import annotations

import pathlib
from collections.abc import Iterable
from typing import Any

import aquafarm_core as core
import numpy as np
import numpy.typing as npt
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecEnv

from aquafarm_gym import spaces
from aquafarm_gym.episodes import Episodes, summary_of
from aquafarm_gym.farms import LocalFarms, observation_of
from aquafarm_gym.rendering import Pictures, check_render_mode


class FarmVecEnv(VecEnv):  # type: ignore[misc, unused-ignore]
    """N farms with S ships each as a Stable-Baselines3 VecEnv. Each ship is a separate environment:
    ship s of farm f has the index f · S + s. The attribute num_envs is N · S.

    If the episode of a farm ends, the farm starts its next episode in the same step. The infos of
    the farm's ships then contain `terminal_observation`, `TimeLimit.truncated`, `is_success`,
    `summary` (as in FarmEnv) and `episode`. `episode` has the keys of Monitor: r (return of the
    farm), l (number of steps) and t (always 0). MaskablePPO of sb3_contrib calls action_masks().
    """

    farms: LocalFarms
    render_mode: str | None

    def __init__(self, num_envs: int = 1, scenario: core.Scenario | str | pathlib.Path = "paper",
                 observation: str = "features", threads: int = 1,
                 render_mode: str | None = None) -> None:
        """num_envs: number of farms, N. render_mode: rgb_array (for VecVideoRecorder) or None."""
        self.farms = LocalFarms(scenario, num_envs, observation, threads=threads)
        if self.farms.agents > self.farms.scenario.ships:
            raise ValueError(f"scenario {self.farms.name}: got self-propelled devices, whose play "
                             "ends before that of their farm, expected ships alone; use "
                             "FarmParallelEnv or TeamVectorEnv")
        self.render_mode = check_render_mode(render_mode, self.farms, ("rgb_array",))
        self._pictures = Pictures(self.farms)
        self._agents = self.farms.agents
        buffers = self.farms.buffers
        array = observation_of(self.farms, observation)
        self._observation = array.reshape(-1, *array.shape[2:])
        self._dtype = np.int64 if observation == "index" else array.dtype
        self._rewards, self._legal = buffers["rewards"].reshape(-1), buffers["legal"].reshape(-1)
        self._reasons = buffers["end_reasons"]
        self._actions = np.zeros((self.farms.farms, self._agents), np.uint8)
        self._episodes = Episodes()
        super().__init__(self.farms.farms * self._agents,
                         spaces.observation_space(self.farms, observation), spaces.action_space())

    def reset(self) -> npt.NDArray[Any]:
        """Starts the sequence of the seed that seed() set. Without a seed, the first reset draws a
        seed, and later resets start the next episode of every farm."""
        seed = self._seeds[0]
        if seed is None and self._episodes.seed is not None:
            self.farms.start_next(np.ones(self.farms.farms, bool))
        else:
            drawn = np.random.SeedSequence().generate_state(1, np.uint64)[0]
            self.farms.reset(*self._episodes.next(seed, {}, lambda: int(drawn)))
        self._reset_seeds()
        self._reset_options()
        self.reset_infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        return self._observation.astype(self._dtype)

    def step_async(self, actions: npt.NDArray[Any]) -> None:
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs,) or actions.min() < 0 or (
                actions.max() >= spaces.N_ACTIONS):
            raise ValueError(f"actions: got shape {list(actions.shape)}, values "
                             f"{actions.min()} to {actions.max()}, expected shape [{self.num_envs}], "
                             "values 0 to 9")
        self._actions.reshape(-1)[:] = actions

    def step_wait(self) -> Any:
        self.farms.step(self._actions)
        rewards = self._rewards.copy()
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        over = self._reasons != 0
        if over.any():
            for one in self.farms.finished():
                first = self._agents * one["farm"]
                for i in range(first, first + self._agents):
                    infos[i] = self._last_info(i, one)
            self.farms.start_next(over)
        return (self._observation.astype(self._dtype), rewards, np.repeat(over, self._agents),
                infos)

    def _last_info(self, i: int, finished: dict[str, Any]) -> dict[str, Any]:
        summary = summary_of(finished)
        last = self._observation[i].astype(self._dtype)
        return {"terminal_observation": last, "is_success": summary["success"], "summary": summary,
                "TimeLimit.truncated": summary["reason"] == core.STEP_LIMIT,
                "episode": {"r": summary["episode_return"], "l": summary["steps"], "t": 0.0}}

    def action_masks(self) -> npt.NDArray[np.bool_]:
        """Returns the legal actions, bool [N · S, 10]."""
        return spaces.action_mask(self._legal).astype(bool)

    def get_images(self) -> list[npt.NDArray[np.uint8] | None]:
        """Returns a picture of each farm, uint8 [640, 800, 3]; an empty list without a
        render_mode."""
        if self.render_mode is None:
            return []
        return [self._pictures.draw(i) for i in range(self.farms.farms)]

    def close(self) -> None:
        self.farms.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self, attr_name)] * self._count(indices)

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise ValueError(f"set_attr: got '{attr_name}', expected no attribute: the farms of a "
                         "FarmVecEnv have one scenario; make another FarmVecEnv")

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None,
                   **method_kwargs: Any) -> list[Any]:
        if method_name != "action_masks":
            raise ValueError(f"env_method: got '{method_name}', expected action_masks; the farms "
                             "of a FarmVecEnv have no other method of their own")
        masks = self.action_masks()
        return [masks[i] for i in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        # infos already contain the entries that Monitor adds.
        return [wrapper_class is Monitor] * self._count(indices)

    def _count(self, indices: None | int | Iterable[int]) -> int:
        return len(list(self._get_indices(indices)))
