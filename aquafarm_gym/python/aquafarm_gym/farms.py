# SPDX-License-Identifier: BSD-3-Clause
"""Backends of all environments in this package: N farms with S agents each, with results as arrays.

A backend has the attributes of the class Farms, and the attributes `yaml` (the scenario) and
`buffers` (see aquafarm_core.FarmBatch). It has the methods reset(seed, first_episode),
step(actions), finished() and close(). LocalFarms (farms in this process) also has start, start_next
and text; aquafarm_gym.ros.RosFarms (farms behind ROS) does not.
"""
from __future__ import annotations

import pathlib
from typing import Any

import aquafarm_core as core
import numpy as np
import numpy.typing as npt

OBSERVATIONS: tuple[str, ...] = ("index", "features", "planes")
ALWAYS: tuple[str, ...] = ("rewards", "outcomes", "legal", "active", "end_reasons", "is_first")


def find_scenario(scenario: core.Scenario | str | pathlib.Path) -> core.Scenario:
    """Returns a scenario. `scenario` is a Scenario, the name of a shipped scenario, the path of a
    scenario file, or YAML text of several lines. Raises ValueError if there is no such scenario or
    the scenario is invalid."""
    if isinstance(scenario, core.Scenario):
        return scenario
    folder = pathlib.Path(core.SCENARIO_FOLDER)
    names = ", ".join(sorted(path.stem for path in folder.glob("*.yaml")))
    expected = f"expected an aquafarm_core.Scenario, a file or one of: {names}"
    if not isinstance(scenario, (str, pathlib.Path)):
        raise ValueError(f"scenario: got {scenario!r}, {expected}")
    if "\n" in str(scenario):
        return core.Scenario.parse(str(scenario))
    shipped = folder / f"{scenario}.yaml"
    if shipped.is_file() and "/" not in str(scenario):
        return core.Scenario.load(str(shipped))
    if pathlib.Path(scenario).is_file():
        return core.Scenario.load(str(scenario))
    raise ValueError(f"scenario: got '{scenario}', {expected}")


def check_observation(observation: str, state_count: int, name: str) -> None:
    """Raises ValueError if the observation is unknown, or if it is `index` and state_count is 0."""
    if observation not in OBSERVATIONS:
        raise ValueError(f"observation: got '{observation}', expected one of: "
                         + ", ".join(OBSERVATIONS))
    if observation == "index" and state_count == 0:
        raise ValueError(f"observation: got 'index', but {name} has too many states for a table; "
                         "expected features or planes")


class Farms:
    """Attributes of every backend, in addition to `buffers` and `yaml`."""

    name: str
    farms: int
    agents: int
    state_count: int
    feature_names: list[str]
    feature_count: int
    plane_count: int
    has_team_rewards: bool
    height: int
    width: int

    def __init__(self, scenario: core.Scenario, farms: int, state_count: int,
                 feature_names: list[str]) -> None:
        self.name, self.agents = scenario.name, scenario.agents
        self.has_team_rewards = scenario.has_team_rewards
        self.height, self.width = scenario.height, scenario.width
        self.farms, self.state_count = farms, state_count
        self.feature_names, self.feature_count = feature_names, len(feature_names)
        self.plane_count = len(core.PLANES)


def observation_of(farms: Any, observation: str) -> npt.NDArray[Any]:
    """Returns the array of an observation. Raises ValueError if the farms do not write it."""
    if observation not in farms.buffers:
        has = ", ".join(name for name in OBSERVATIONS if name in farms.buffers)
        raise ValueError(f"observation: got '{observation}', expected one that these farms write: "
                         f"{has}")
    array: npt.NDArray[Any] = farms.buffers[observation]
    return array


class LocalFarms(Farms):
    """Farms in this process. Copies and pickles continue bit-identically."""

    scenario: core.Scenario
    batch: core.FarmBatch

    def __init__(self, scenario: core.Scenario | str | pathlib.Path = "paper", farms: int = 1,
                 observation: str = "features", hashes: bool = False, threads: int = 1) -> None:
        scenario = find_scenario(scenario)
        check_observation(observation, core.FarmBatch(scenario).state_count, scenario.name)
        write = [*ALWAYS, observation] + (["hashes"] if hashes else [])
        self.scenario = scenario
        self.batch = core.FarmBatch(scenario, farms, write, threads)
        super().__init__(scenario, self.batch.farms, self.batch.state_count,
                         self.batch.feature_names)

    @property
    def yaml(self) -> str:
        """The scenario as YAML text."""
        return self.scenario.yaml

    @property
    def buffers(self) -> dict[str, npt.NDArray[Any]]:
        """The arrays that reset and step write."""
        return self.batch.buffers

    def reset(self, seed: int, first_episode: int = 0) -> None:
        """See FarmBatch.reset."""
        self.batch.reset(seed, first_episode)

    def step(self, actions: npt.NDArray[np.uint8]) -> None:
        """See FarmBatch.step."""
        self.batch.step(actions)

    def finished(self) -> list[dict[str, Any]]:
        """See FarmBatch.finished."""
        return self.batch.finished()

    def start(self, mask: npt.NDArray[np.bool_], seeds: list[int], episodes: list[int],
              stride: int) -> None:
        """See FarmBatch.start."""
        self.batch.start(mask, seeds, episodes, stride)

    def start_next(self, mask: npt.NDArray[np.bool_]) -> None:
        """See FarmBatch.start_next."""
        self.batch.start_next(mask)

    def text(self, farm: int = 0) -> str:
        """See FarmBatch.text."""
        return self.batch.text(farm)

    def close(self) -> None:
        """Does nothing; other backends close connections."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, LocalFarms) and self.batch == other.batch

    def __hash__(self) -> int:
        return hash((LocalFarms, self.scenario, self.farms))
