# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium vector environments: many farms as arrays, with one or several ships each."""
from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import Any, TypeAlias

import aquafarm_core as core
import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector.utils import batch_space

from aquafarm_gym import rendering, spaces
from aquafarm_gym.env import one_agent
from aquafarm_gym.episodes import NO_SUMMARY, Episodes, check_options, check_seed, summary_of
from aquafarm_gym.farms import LocalFarms, observation_of
from aquafarm_gym.rendering import Pictures, check_render_mode, html_of

NEXT_STEP: str = "NextStep"
SAME_STEP: str = "SameStep"
DISABLED: str = "Disabled"
AUTORESET_MODES: tuple[str, ...] = (NEXT_STEP, SAME_STEP, DISABLED)
Array: TypeAlias = npt.NDArray[Any]


def autoreset_name(mode: Any, farms: Any) -> str:
    """Returns the name of an autoreset mode. mode: a gymnasium.vector.AutoresetMode or its name.
    Raises ValueError if the mode is unknown or the farms do not support it."""
    name = getattr(mode, "value", mode)
    if name not in AUTORESET_MODES:
        raise ValueError(f"autoreset_mode: got {mode!r}, expected a "
                         f"gymnasium.vector.AutoresetMode or one of: {', '.join(AUTORESET_MODES)}")
    if name != NEXT_STEP and not hasattr(farms, "start_next"):
        raise ValueError(f"autoreset_mode: got {name} for farms behind ROS, expected {NEXT_STEP}; "
                         "play the farms in this process, or leave autoreset_mode out")
    return str(name)


class VectorBase(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """Base class of the vector environments: N farms that step together."""

    metadata: dict[str, Any] = {"render_modes": [one for one in rendering.OFFERED if one != "human"],
                                "render_fps": rendering.FPS}
    farms: Any
    num_envs: int
    observation: str
    render_mode: str | None
    action_space: gymnasium.Space[Any]
    observation_space: gymnasium.Space[Any]
    single_action_space: gymnasium.Space[Any]
    single_observation_space: gymnasium.Space[Any]

    def __init__(self, farms: Any, observation: str, copy: bool, render_mode: str | None,
                 autoreset_mode: Any, action_space: gymnasium.Space[Any],
                 observation_space: gymnasium.Space[Any]) -> None:
        self.farms = farms
        self.single_action_space, self.single_observation_space = action_space, observation_space
        self.action_space = batch_space(action_space, farms.farms)
        self.observation_space = batch_space(observation_space, farms.farms)
        self.num_envs = self.farms.farms
        self.observation = observation
        if render_mode == "human":
            raise ValueError("render_mode: got 'human' for many farms, expected ansi, rgb_array or "
                             "None; show one farm with FarmEnv")
        self.render_mode = check_render_mode(render_mode, farms, ("ansi", "rgb_array"))
        self._mode = autoreset_name(autoreset_mode, farms)
        if hasattr(gymnasium.vector, "AutoresetMode"):  # since Gymnasium 1.1
            self.metadata = {**self.metadata,
                             "autoreset_mode": gymnasium.vector.AutoresetMode(self._mode)}
        self._copy = copy
        self._episodes = Episodes()
        # False: all farms play one sequence of episodes. True: each farm may have its own.
        self._own_sequences = False
        self._seeds = [0] * self.num_envs  # seed of the sequence of each farm
        self._is_listed = np.zeros(self.num_envs, bool)  # whether a farm's seed was passed in a list
        # Number of next episodes that each farm has started since all farms last started together.
        self._begun = np.zeros(self.num_envs, np.int64)
        self._attach()

    def _attach(self) -> None:
        """Sets the members that refer to the arrays of the farms."""
        buffers = self.farms.buffers
        self._observation = self._agents_of(observation_of(self.farms, self.observation))
        self._all_rewards = buffers["rewards"]
        self._reasons, self._is_first = buffers["end_reasons"], buffers["is_first"].view(bool)
        self._legal = self._agents_of(buffers["legal"])
        self._outcomes = self._agents_of(buffers["outcomes"])
        self._actions = np.zeros((self.num_envs, self.farms.agents), np.uint8)
        self._pictures = Pictures(self.farms)
        self._everywhere = np.ones(self.num_envs, bool)
        self._nowhere = np.zeros(self.num_envs, bool)
        self._no_summary = {name: np.zeros(self.num_envs, np.asarray(value).dtype)
                            for name, value in NO_SUMMARY.items()}
        for array in (self._everywhere, self._nowhere, *self._no_summary.values()):
            array.flags.writeable = False  # shared by the infos of all steps

    def _agents_of(self, array: Array) -> Array:
        """Returns the part of an array [N, S, …] for observations, masks and outcomes: [N, …] in
        FarmVectorEnv, the whole array in TeamVectorEnv."""
        raise NotImplementedError

    def _rewards(self) -> Array:
        """Returns the reward of each farm, [N]."""
        raise NotImplementedError

    def reset(self, *, seed: int | Sequence[int | None] | None = None,
              options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts episodes. seed: a number starts one sequence for all farms, with farm i at episode
        i. A list starts one sequence per farm, at episode 0. A farm without a seed (or with None in
        the list) starts the next episode of its sequence. If all farms start together, a farm that
        is behind skips episodes, so that all new episodes follow the latest one. options: with
        `episode` k, farm i starts at episode k + i of its sequence, or at episode k if its seed
        comes from a list; without effect on a farm with None in the list. `reset_mask` (bool [N])
        selects the farms that start; the other farms do not change."""
        options = check_options(options, ("episode", "reset_mask"))
        mask = self._mask_of(options)
        seeds = self._seeds_of(seed)
        one_seed: Any = seed if seeds is None else None
        super().reset(seed=one_seed)
        if seeds is not None:
            self._start_each(mask, seeds, int(options.get("episode", 0)))
        elif mask is None and not (self._own_sequences and seed is None and
                                   ("episode" not in options or self._is_listed.any())):
            self._start_all(one_seed, options)
        elif seed is None and "episode" not in options:
            self._start_next(self._everywhere if mask is None else mask)
        else:
            self._start_masked(mask, one_seed, int(options.get("episode", 0)))
        return self._out(self._observation), self._infos(self._reasons != 0)

    def _mask_of(self, options: dict[str, Any]) -> Array | None:
        mask: Array | None = options.get("reset_mask")
        if mask is None:
            return None
        fits = isinstance(mask, np.ndarray) and mask.shape == (self.num_envs,)
        if not fits or mask.dtype != np.bool_ or not mask.any():
            raise ValueError(f"reset: options['reset_mask']: got {mask!r}, expected a bool array "
                             f"[{self.num_envs}] with at least one True")
        self._need_local("reset_mask")
        if self._episodes.seed is None and not self._own_sequences and not mask.all():
            raise ValueError("reset: got a reset_mask of some farms before the first reset, "
                             "expected all farms; call reset() without reset_mask first")
        return mask

    def _seeds_of(self, seed: Any) -> list[int | None] | None:
        if seed is None or not isinstance(seed, (list, tuple, np.ndarray)):
            if seed is not None:
                check_seed(seed)
            return None
        if len(seed) != self.num_envs:
            raise ValueError(f"reset: seed: got {len(seed)} seeds, expected {self.num_envs}; pass "
                             "one per farm, or one number for all")
        self._need_local("a list of seeds")
        return [None if one is None else check_seed(one) for one in seed]

    def _need_local(self, given: str) -> None:
        if not hasattr(self.farms, "start"):
            raise ValueError(f"reset: got {given} for farms behind ROS, expected none; these farms "
                             "start together: pass one seed")

    def _start_all(self, seed: int | None, options: dict[str, Any]) -> None:
        # Farm i of N plays every N-th episode. Without a seed, the new episodes follow the latest
        # episode of all farms.
        by = self.num_envs * (1 + int(self._begun.max()))
        first = self._episodes.next(seed, options, lambda: self.np_random_seed, by)
        self.farms.reset(*first)
        self._begun[:] = 0
        self._own_sequences = False
        self._seeds = [first[0]] * self.num_envs
        self._is_listed[:] = False

    def _ensure_reset(self) -> None:
        if self._episodes.seed is None:
            self._start_all(None, {})

    def _start_next(self, mask: Array) -> None:
        self._ensure_reset()
        self.farms.start_next(mask)
        self._begun += mask

    def _start_each(self, mask: Array | None, seeds: list[int | None], episode: int) -> None:
        self._ensure_reset()
        mask = self._everywhere if mask is None else mask
        seeded = mask & np.array([one is not None for one in seeds])
        if (mask & ~seeded).any():
            self._start_next(mask & ~seeded)
        self._seeds = [one if new is None or not is_started else new
                       for one, new, is_started in zip(self._seeds, seeds, mask)]
        self._is_listed |= seeded
        self._start_at(seeded, episode)

    def _start_masked(self, mask: Array | None, seed: int | None, episode: int) -> None:
        self._ensure_reset()
        mask = self._everywhere if mask is None else mask
        if seed is not None:
            self._seeds = [seed if is_started else one
                           for one, is_started in zip(self._seeds, mask)]
            self._is_listed &= ~mask
        self._start_at(mask, episode)

    def _start_at(self, mask: Array, episode: int) -> None:
        """Starts farms at an episode of their sequences. See the option `episode` of reset."""
        listed, others = mask & self._is_listed, mask & ~self._is_listed
        if listed.any():
            self.farms.start(listed, self._seeds, [episode] * self.num_envs, 1)
        if others.any():
            self.farms.start(others, self._seeds, [episode + i for i in range(self.num_envs)],
                             self.num_envs)
        self._own_sequences = True

    def step(self, actions: Any) -> tuple[Any, Array, Array, Array, dict[str, Any]]:
        actions = np.asarray(actions)
        shape = self.action_space.shape
        if actions.shape != shape or actions.dtype.kind not in "iu":
            raise ValueError(f"actions: got {actions.dtype} {list(actions.shape)}, expected whole "
                             f"numbers {list(shape or ())}")
        if actions.min() < 0 or actions.max() >= spaces.N_ACTIONS:
            raise ValueError(f"actions: got {actions.min()} to {actions.max()}, expected [0, 9]")
        if self._mode == DISABLED and self._reasons.any():
            raise gymnasium.error.ResetNeeded(
                f"step: the episodes of farms {np.flatnonzero(self._reasons).tolist()} are over; "
                "reset them with options={'reset_mask': mask} first")
        self._actions[...] = actions.reshape(self._actions.shape)
        self.farms.step(self._actions)
        self._begun += self._is_first
        over = self._reasons != 0
        truncated = self._reasons == core.STEP_LIMIT
        rewards = self._rewards()
        if self._mode == SAME_STEP and not self._copy:
            rewards = rewards.copy()  # the start of the next episodes overwrites the array
        if self._mode == SAME_STEP and over.any():
            infos = self._restart(over)
        else:
            infos = self._infos(over)
        return self._out(self._observation), rewards, over ^ truncated, truncated, infos

    def _restart(self, over: Array) -> dict[str, Any]:
        """Starts the next episodes of the farms in `over`. Returns infos that contain the final
        observations and infos of their previous episodes."""
        final_obs = np.full(self.num_envs, None)
        for i in np.flatnonzero(over):
            final_obs[i] = self._observation[i].copy()
        final_info = self._infos(over)
        self._start_next(over)
        return {**self._infos(self._nowhere), "final_obs": final_obs, "_final_obs": over,
                "final_info": final_info, "_final_info": over}

    def render(self) -> tuple[Any, ...] | None:
        """Returns each farm as a picture, uint8 [640, 800, 3] (`rgb_array`), or as text (`ansi`)."""
        if self.render_mode is None:
            return None
        draw = self._pictures.draw if self.render_mode == "rgb_array" else self.farms.text
        return tuple(draw(i) for i in range(self.num_envs))

    def close_extras(self, **kwargs: Any) -> None:
        if "farms" in self.__dict__:  # missing if the constructor failed
            self.farms.close()

    def _out(self, array: Array) -> Array:
        return array.copy() if self._copy else array

    def _infos(self, over: Array) -> dict[str, Any]:
        summary, success = self._no_summary, self._nowhere
        if over.any():
            summary = {name: zeros.copy() for name, zeros in self._no_summary.items()}
            for one in self.farms.finished():
                for name, value in summary_of(one).items():
                    summary[name][one["farm"]] = value
            success = summary["success"]
        infos = {"action_mask": spaces.action_mask(self._legal),
                 "outcome": self._outcomes.astype(np.int64),
                 "reason": self._reasons.astype(np.int64), "is_success": success,
                 "is_first": self._is_first.copy(), "summary": summary}
        infos["started"] = infos["is_first"]  # former name
        infos.update(self._more_infos())
        infos.update({f"_{name}": self._everywhere for name in infos})
        infos["_summary"] = over
        return infos

    def _more_infos(self) -> dict[str, Any]:
        return {}

    def _repr_html_(self) -> str:
        shown = min(self.num_envs, 4)
        return html_of(self.farms, self._pictures, range(shown)) + (
            f"<p>{shown} of {self.num_envs} farms</p>")

    def __getstate__(self) -> dict[str, Any]:
        kept = ("_own_sequences", "_seeds", "_is_listed", "_begun", "_mode", "_copy", "_episodes",
                "_np_random", "_np_random_seed")
        return {name: value for name, value in self.__dict__.items()
                if not name.startswith("_") or name in kept}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # Environments that were pickled by older versions lack the seeds of the farms.
        self.__dict__.setdefault("_seeds", [self._episodes.seed or 0] * self.num_envs)
        self.__dict__.setdefault("_is_listed", np.zeros(self.num_envs, bool))
        self._attach()

    def __eq__(self, other: object) -> bool:
        return (type(self) is type(other) and isinstance(other, VectorBase)
                and (self.observation, self._mode) == (other.observation, other._mode)
                and self._episodes == other._episodes and bool(self.farms == other.farms))

    def __hash__(self) -> int:
        return hash((type(self), self.observation, self.farms))


class FarmVectorEnv(VectorBase):
    """N farms with one ship each that step together in this process (or behind ROS, with `farms`).

    autoreset_mode (a gymnasium.vector.AutoresetMode or its name) specifies when a farm starts its
    next episode. NextStep (default): in the next step, which ignores the farm's action. SameStep:
    in the step that ends the episode. Disabled: only by reset, for example with a reset_mask.

    With copy=False, observations are the arrays that the farms write, and the next step overwrites
    them. The same holds for rewards of FarmVectorEnv, except in mode SameStep.

    infos always contains the keys of FarmEnv as arrays [N, …], and `is_first` (bool [N]). Each key
    has a mask, such as `_action_mask` (bool [N]). `summary` is valid where `_summary` is True, and
    0 elsewhere. In mode SameStep, infos also contains `final_obs` and `final_info` when an episode
    ends.
    """

    def __init__(self, num_envs: int = 1, scenario: core.Scenario | str | pathlib.Path = "paper",
                 observation: str = "features", copy: bool = True, threads: int = 1,
                 farms: Any = None, render_mode: str | None = None,
                 autoreset_mode: Any = NEXT_STEP) -> None:
        farms = one_agent(farms or LocalFarms(scenario, num_envs, observation, threads=threads))
        super().__init__(farms, observation, copy, render_mode, autoreset_mode,
                         spaces.action_space(), spaces.observation_space(farms, observation))

    def _agents_of(self, array: Array) -> Array:
        return array[:, 0]

    def _rewards(self) -> Array:
        return self._out(self._all_rewards[:, 0])


class TeamVectorEnv(VectorBase):
    """N farms with S agents each (ships and self-propelled devices), which act together: actions
    [N, S], observations [N, S, …].

    The reward of a farm is the sum of the rewards of its agents. With `rewards: {sharing: team}`
    each agent already receives this sum; the reward of the farm then contains it once.
    infos["agent_rewards"], float32 [N, S], contains the reward of each agent. infos["active"],
    bool [N, S], is False for a delivered self-propelled device. Observations, action masks and
    outcomes have S entries per farm. Other results are as in FarmVectorEnv.
    """

    def __init__(self, num_envs: int = 1,
                 scenario: core.Scenario | str | pathlib.Path = "two_squads",
                 observation: str = "features", copy: bool = True, threads: int = 1,
                 farms: Any = None, render_mode: str | None = None,
                 autoreset_mode: Any = NEXT_STEP) -> None:
        farms = farms or LocalFarms(scenario, num_envs, observation, threads=threads)
        super().__init__(farms, observation, copy, render_mode, autoreset_mode,
                         gymnasium.spaces.MultiDiscrete([spaces.N_ACTIONS] * farms.agents),
                         batch_space(spaces.observation_space(farms, observation), farms.agents))

    def _agents_of(self, array: Array) -> Array:
        return array

    def _rewards(self) -> Array:
        rewards = self._all_rewards
        if not self.farms.has_team_rewards:
            return np.asarray(rewards.sum(axis=1))
        return np.asarray(rewards[:, 0].copy())  # every agent has the reward of the team

    def _more_infos(self) -> dict[str, Any]:
        active = self.farms.buffers["active"].astype(bool)
        return {"agent_rewards": self._all_rewards.copy(), "active": active,
                "in_play": active}  # former name of "active"
