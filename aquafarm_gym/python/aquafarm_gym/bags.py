# SPDX-License-Identifier: BSD-3-Clause
"""Converts bags to a Minari dataset without ROS, and checks every reward.

    python -m aquafarm_gym.bags DATASET_ID BAG … [--observation features]

Each episode that a bag contains from step 0 is played again in this process, with the bag's
scenario, seed and actions. At every step, the rewards, the hash of the state and the end reason
must equal those of the bag. The observations of the dataset come from this replay. The dataset
contains a separate episode for each agent (ship or self-propelled device).
"""
from __future__ import annotations

import argparse
import dataclasses
import pathlib
import sys
import warnings
from collections.abc import Iterator
from typing import Any

import aquafarm_core as core
import gymnasium
import numpy as np
import numpy.typing as npt

from aquafarm_gym import spaces
from aquafarm_gym.farms import LocalFarms, find_scenario

STATE_TYPE, SPEC_TYPE = "aquafarm_msgs/msg/FarmState", "aquafarm_msgs/msg/FarmSpec"
SAVED_TYPE = "aquafarm_msgs/msg/SavedState"
MAX_SEED = 2**63  # environments accept only smaller seeds


@dataclasses.dataclass
class Recorded:
    """An episode of a bag: the results of steps 0 … T. Step 0 is the start of the episode."""
    scenario: core.Scenario
    where: str                             # bag and episode, for messages
    seed: int
    episode: int
    actions: list[list[int]]               # [T + 1][S]; entry 0 is not used
    rewards: list[list[np.float32]]        # [T + 1][S]
    hashes: list[int]                      # [T + 1]
    reasons: list[int]                     # [T + 1], index into aquafarm_core.REASONS
    is_changed: bool = False               # the topic saved_state reports a change from outside


@dataclasses.dataclass
class Replayed:
    """An episode of one agent: observations and masks [T + 1, …], the other arrays [T]."""
    seed: int
    episode: int
    observations: npt.NDArray[Any]
    actions: npt.NDArray[np.int64]
    rewards: npt.NDArray[np.float64]
    terminations: npt.NDArray[np.bool_]
    truncations: npt.NDArray[np.bool_]
    masks: npt.NDArray[np.int8]            # legal actions, [T + 1, 10]


def read_episodes(path: str | pathlib.Path) -> Iterator[Recorded]:
    """Yields each episode that a bag contains from step 0. Raises ValueError if the file is not a
    readable bag of a ranch, or if a step is missing."""
    from rosbags.highlevel import AnyReader, AnyReaderError
    from rosbags.rosbag1 import ReaderError
    try:
        with AnyReader([pathlib.Path(path)]) as reader:
            yield from _episodes_in(reader, str(path))
    except (AnyReaderError, ReaderError, OSError) as error:
        raise ValueError(f"{path}: got no readable bag ({error}), expected one with the topics "
                         "spec and state; 'rosbag reindex' repairs an interrupted one") from error


def _episodes_in(reader: Any, path: str) -> Iterator[Recorded]:
    specs: dict[str, Any] = {}
    running: dict[str, Recorded] = {}
    wanted = [one for one in reader.connections
              if one.msgtype in (SPEC_TYPE, SAVED_TYPE)
              or (one.msgtype == STATE_TYPE and one.topic.endswith("/state"))
              or one.topic == "state"]
    if not any(one.msgtype == STATE_TYPE for one in wanted):
        raise ValueError(f"{path}: got no topic state of type {STATE_TYPE}, expected a bag of a "
                         "ranch")
    for connection, _, raw in reader.messages(connections=wanted):
        prefix = connection.topic.rpartition("/")[0]
        message = reader.deserialize(raw, connection.msgtype)
        if connection.msgtype == SPEC_TYPE:
            specs[prefix] = message
        elif connection.msgtype == SAVED_TYPE:
            if prefix in running:
                running[prefix].is_changed = True
        elif prefix in specs:
            yield from _take(running, prefix, specs[prefix], message, path)
    yield from running.values()


def _take(running: dict[str, Recorded], prefix: str, spec: Any, state: Any,
          path: str) -> Iterator[Recorded]:
    """Adds a state to the current episode of its ranch. If the state starts another episode, yields
    the previous episode. prefix: namespace of the ranch."""
    if state.step == 0 and not _is_same_start(running.get(prefix), state):
        if prefix in running:
            yield running.pop(prefix)
        scenario = core.Scenario.parse(spec.scenario_yaml, spec.scenario_name)
        running[prefix] = Recorded(scenario, f"{path}: episode {state.episode}", int(state.seed),
                                   int(state.episode), [], [], [], [])
    one = running.get(prefix)
    if one is None or state.episode != one.episode:
        return  # the start of this episode is not in the bag
    if state.step != len(one.hashes):
        if state.step + 1 == len(one.hashes):
            return  # the same state was published again
        raise ValueError(f"{one.where}: got step {state.step} after step {len(one.hashes) - 1}, "
                         "expected every step; leave the bag out")
    one.actions.append([int(ship.action) for ship in state.ships])
    one.rewards.append([np.float32(ship.reward) for ship in state.ships])
    one.hashes.append(int(state.hash))
    one.reasons.append(int(state.reason))


def _is_same_start(one: Recorded | None, state: Any) -> bool:
    """Returns whether a state of step 0 belongs to the start that an episode already contains: it
    was published again, or a service has changed the farm."""
    return (one is not None and len(one.hashes) == 1
            and (state.seed, state.episode) == (one.seed, one.episode)
            and (one.is_changed or state.hash == one.hashes[0]))


def replay(recorded: Recorded, observation: str = "features") -> list[Replayed]:
    """Plays an episode again and returns one result per agent. Raises ValueError at the first
    difference, or if the farm was changed from outside (is_changed)."""
    if recorded.is_changed:
        raise ValueError(f"{recorded.where}: got changes from outside (topic saved_state), expected "
                         "none: actions alone do not repeat them; leave the bag out")
    farms = LocalFarms(recorded.scenario, 1, observation, hashes=True)
    farms.reset(recorded.seed, recorded.episode)
    steps, buffers = len(recorded.hashes), farms.buffers
    seen, masks = [], []
    for step in range(steps):
        if step > 0:
            farms.step(np.array([recorded.actions[step]], np.uint8))
        for what, got, kept in (("rewards", buffers["rewards"][0].tolist() if step else [],
                                 [float(one) for one in recorded.rewards[step]] if step else []),
                                ("hash", int(buffers["hashes"][0]), recorded.hashes[step]),
                                ("reason", int(buffers["end_reasons"][0]), recorded.reasons[step])):
            if got != kept:
                raise ValueError(f"{recorded.where}: step {step}: {what}: got {got} in the replay, "
                                 f"expected {kept}; was it recorded by aquafarm {core.VERSION}?")
        seen.append(buffers[observation][0].copy())
        masks.append(spaces.action_mask(buffers["legal"][0]))
    return [_of_ship(recorded, np.array(seen), np.array(masks), ship)
            for ship in range(farms.agents)]


def _of_ship(recorded: Recorded, seen: npt.NDArray[Any], masks: npt.NDArray[np.int8],
             ship: int) -> Replayed:
    reasons = np.array(recorded.reasons[1:])
    truncations = reasons == core.STEP_LIMIT
    terminations = (reasons != 0) & ~truncations
    if len(reasons) and reasons[-1] == 0:
        truncations[-1] = True  # the bag ends within the episode
    actions = np.array([step[ship] for step in recorded.actions[1:]], np.int64)
    rewards = np.array([step[ship] for step in recorded.rewards[1:]], np.float64)
    return Replayed(recorded.seed, recorded.episode, seen[:, ship], actions, rewards, terminations,
                    truncations, masks[:, ship])


def make_dataset(dataset_id: str, paths: list[str | pathlib.Path], observation: str = "features",
                 **about: Any) -> Any:
    """Makes a Minari dataset from the episodes in bags of one scenario, and returns it.

    about: further arguments of minari.create_dataset_from_buffers, such as algorithm_name. If the
    scenario has one agent, Minari can recover the environment from the dataset. Action 10 (the ship
    holds its cell) occurs if a ship had no command, as in paced bags, or if the policy holds ships,
    as do_nothing does. The action space then has 11 actions.
    Raises ValueError in the same cases as read_episodes and replay. Also raises it if the scenarios
    of the bags differ, or if no bag contains the start and the first step of an episode.
    """
    import minari
    from minari.data_collector import EpisodeBuffer
    scenario: core.Scenario | None = None
    buffers: list[Any] = []
    most = 0
    for path in paths:
        for recorded in read_episodes(path):
            scenario = scenario or recorded.scenario
            if recorded.scenario != scenario:
                raise ValueError(f"{recorded.where}: got scenario {recorded.scenario.name}, expected "
                                 f"{scenario.name} as before; make a dataset of each scenario")
            if len(recorded.hashes) < 2:
                continue
            for one in replay(recorded, observation):
                most = max(most, int(one.actions.max()))
                start: dict[str, Any] = ({"seed": one.seed, "options": {"episode": one.episode}}
                                         if one.seed < MAX_SEED else {})
                buffers.append(EpisodeBuffer(
                    id=len(buffers), observations=list(one.observations),
                    actions=list(one.actions), rewards=list(one.rewards),
                    terminations=list(one.terminations), truncations=list(one.truncations),
                    infos={"action_mask": list(one.masks)}, **start))
    if scenario is None or not buffers:
        raise ValueError(f"bags: got no episode from step 0 in {[str(one) for one in paths]}, "
                         "expected at least one; record them with record:=all")
    farms = LocalFarms(scenario, 1, observation)
    env = gymnasium.make("aquafarm/Farm-v1", scenario=name_of(scenario),
                         observation=observation) if farms.agents == 1 else None
    actions = spaces.action_space() if most < spaces.N_ACTIONS else gymnasium.spaces.Discrete(11)
    return minari.create_dataset_from_buffers(
        dataset_id, buffers, env=env, action_space=actions,
        observation_space=spaces.observation_space(farms, observation), **about)


def name_of(scenario: core.Scenario) -> str:
    """Returns the name of a shipped scenario. Returns the YAML text of any other scenario."""
    try:
        if find_scenario(scenario.name) == scenario:
            return scenario.name
    except ValueError:
        pass
    return scenario.yaml


def main() -> int:
    """Runs the command; returns its exit code."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset_id", help="id of the new Minari dataset, such as aquafarm/paper/ppo-v0")
    parser.add_argument("bags", nargs="+", type=pathlib.Path)
    parser.add_argument("--observation", default="features", help="features, planes or index")
    parser.add_argument("--algorithm", default="unknown", help="policy that played, for the description")
    given = parser.parse_args()
    warnings.filterwarnings("ignore", module="minari")  # bags contain no author and no link
    try:
        dataset = make_dataset(given.dataset_id, given.bags, given.observation,
                               algorithm_name=given.algorithm, description="From bags of aquafarm")
    except ImportError as error:
        print(f"bags: {error}; pip install './aquafarm_gym[bags]'", file=sys.stderr)
        return 3
    except ValueError as error:
        print(f"bags: {error}", file=sys.stderr)
        return 2
    print(f"{given.dataset_id}: {dataset.total_episodes} episodes, {dataset.total_steps} steps; "
          "the replay reproduced every reward")
    return 0


if __name__ == "__main__":
    sys.exit(main())
