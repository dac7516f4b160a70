# SPDX-License-Identifier: BSD-3-Clause
"""Lets a learner of any Python package take part in ./aquafarm benchmark.

    class MyLearner:
        def __init__(self, env, seed): ...            # env: FarmEnv with one ship
        def train(self): ...                          # plays `env` until it raises EpisodesOver
        def act(self, observation, mask): ...         # greedy; returns an action in [0, 9]

    if __name__ == "__main__":
        sys.exit(main(MyLearner))

    aquafarm_benchmark --learner "mine=python3 my_learner.py" …

main trains the learner for the number of episodes that the benchmark requests, then evaluates it
with the benchmark's evaluation seed. main writes run.json, metrics.csv, evaluation.csv and
evaluation.json into the run folder, with the column and key names that aquafarm_train and
aquafarm_evaluate use.
"""
from __future__ import annotations

import argparse
import csv
import json
import os
import pathlib
import sys
import time
from typing import Any, Callable, Protocol

import aquafarm_core as core
import numpy as np
import numpy.typing as npt

from aquafarm_gym import spaces
from aquafarm_gym.env import FarmEnv
from aquafarm_gym.farms import LocalFarms, find_scenario

EVALUATION = (*core.EPISODE_COLUMNS.values(), *core.ADDED_COLUMNS.values())
METRICS = ("number", "total_steps", *core.EPISODE_COLUMNS.values(), "exploration",
           "learning_rate", "loss", *core.ADDED_COLUMNS.values())
PROGRESS_PERIOD_S: float = 5.0
FIRST_EVALUATION_SEED = 2**63  # the farm seed of aquafarm_evaluate --seed 0


class EpisodesOver(Exception):
    """Raised by reset after the last episode of the training."""


class Learner(Protocol):
    """Interface of a learner, as main uses it."""

    def train(self) -> None:
        """Plays episodes of the environment and learns, until reset raises EpisodesOver."""

    def act(self, observation: Any, mask: npt.NDArray[np.int8]) -> int:
        """Returns the greedy action; mask: legal actions, int8 [10]."""


def cells_of(record: dict[str, Any]) -> dict[str, Any]:
    """Returns the CSV cells of an episode, by column. record: a dict from FarmBatch.finished()."""
    columns = {**core.EPISODE_COLUMNS, **core.ADDED_COLUMNS}
    return {**{columns[name]: value for name, value in record.items()},
            "success": int(record["success"])}


class TrainingEnv(FarmEnv):
    """A FarmEnv that writes metrics.csv and ends the training after `episodes` episodes."""

    episodes_taken: int
    steps_taken: int

    def __init__(self, scenario: core.Scenario, episodes: int, path: pathlib.Path,
                 **options: Any) -> None:
        super().__init__(scenario, **options)
        self._limit, self.episodes_taken, self.steps_taken = episodes, 0, 0
        self._shown = time.monotonic()
        self._file = open(path, "w", newline="", encoding="utf-8")
        self._rows = csv.DictWriter(self._file, METRICS, restval="nan", extrasaction="ignore",
                                    lineterminator="\n")
        self._rows.writeheader()

    def reset(self, **options: Any) -> Any:
        if self.episodes_taken == self._limit:
            raise EpisodesOver
        return super().reset(**options)

    def step(self, action: Any) -> Any:
        result = super().step(action)
        self.steps_taken += 1
        if result[2] or result[3]:
            self.episodes_taken += 1
            self._rows.writerow({"number": self.episodes_taken, "total_steps": self.steps_taken,
                                 **cells_of(self.farms.finished()[0])})
            self._show_progress()
        return result

    def _show_progress(self) -> None:
        """Prints the progress for aquafarm_benchmark, at most once per PROGRESS_PERIOD_S."""
        now = time.monotonic()
        if now - self._shown >= PROGRESS_PERIOD_S:
            self._shown = now
            print(f"episodes {self.episodes_taken:,} / {self._limit:,}", flush=True)

    def close(self) -> None:
        self._file.close()
        super().close()


def evaluate(learner: Learner, scenario: core.Scenario, observation: str, episodes: int,
             seed: int) -> tuple[list[dict[str, Any]], int]:
    """Plays episodes greedily. Returns a dict of FarmBatch.finished() for each episode, and the
    number of distinct initial states."""
    farms = LocalFarms(scenario, 1, observation)
    seen, records, starts = farms.buffers[observation], [], set()
    for episode in range(episodes):
        farms.reset(FIRST_EVALUATION_SEED + seed, episode)
        starts.add(farms.batch.start_hash())
        while not farms.buffers["end_reasons"][0]:
            mask = spaces.action_mask(farms.buffers["legal"][0, 0])
            now = np.int64(seen[0, 0]) if observation == "index" else seen[0, 0].copy()
            farms.step(np.array([[learner.act(now, mask)]], np.uint8))
        records.append(farms.finished()[0])
    return records, len(starts)


def summary_of(records: list[dict[str, Any]]) -> dict[str, Any]:
    """Returns the statistics of the episodes for evaluation.json."""
    count = len(records)
    total = {name: sum(one[name] for one in records)
             for name in ("episode_return", "steps", "success", "crashes", "steps_in_disaster",
                          "energy", "distance", "delivered")}
    health = [one["delivered_health"] for one in records if one["delivered"] > 0]
    return {"complete": True, "episodes": count,
            "return_per_episode": total["episode_return"] / count,
            "return_per_step": total["episode_return"] / total["steps"],
            "success_rate": total["success"] / count, "steps_per_episode": total["steps"] / count,
            "crashes_per_episode": total["crashes"] / count,
            "steps_in_disaster_per_episode": total["steps_in_disaster"] / count,
            "delivered_health": sum(health) / max(1, len(health)),
            "energy_kwh_per_episode": total["energy"] / count,
            "distance_km_per_episode": total["distance"] / count}


def with_limit(scenario: core.Scenario, max_steps: int) -> core.Scenario:
    """Returns the scenario with the step limit `max_steps`; 0 keeps the limit. Raises ValueError if
    the YAML text does not contain the old limit exactly once."""
    if max_steps in (0, scenario.step_limit):
        return scenario
    old, new = f"step_limit: {scenario.step_limit}", f"step_limit: {max_steps}"
    if scenario.yaml.count(old) != 1:
        raise ValueError(f"scenario {scenario.name}: got {scenario.yaml.count(old)} times '{old}' in "
                         "its text, expected it once; set the step limit in the scenario file")
    return core.Scenario.parse(scenario.yaml.replace(old, new), scenario.name)


def write(path: pathlib.Path, text: str) -> None:
    """Writes a file atomically."""
    part = path.with_name(path.name + ".part")
    part.write_text(text, "utf-8")
    os.replace(part, path)


def whole_from(least: int, below: int = 2**31) -> Callable[[str], int]:
    """Returns a parser of whole numbers in [least, below) for argparse."""
    def parse(text: str) -> int:
        if not text.isdecimal() or not least <= int(text) < below:
            raise argparse.ArgumentTypeError(
                f"got '{text}', expected a whole number from {least} to {below - 1}")
        return int(text)
    return parse


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="A learner of ./aquafarm benchmark.")
    seed, episodes = whole_from(0, FIRST_EVALUATION_SEED), whole_from(1)
    parser.add_argument("scenario", help="scenario file or name")
    parser.add_argument("--run-dir", type=pathlib.Path, required=True)
    parser.add_argument("--name", default="learner")
    parser.add_argument("--seed", type=seed, default=1)
    parser.add_argument("--episodes", type=episodes, default=100, help="training episodes")
    parser.add_argument("--max-steps", type=whole_from(0), default=0,
                        help="step limit of an episode; 0: the scenario's")
    parser.add_argument("--evaluation-episodes", type=episodes, default=100)
    parser.add_argument("--evaluation-seed", type=seed, default=1000)
    return parser.parse_args()


def main(make: Any, observation: str = "features") -> int:
    """Trains and evaluates one learner as the command line specifies; returns the exit code.

    make(env, seed) returns the learner. The exit code is 2 if an argument cannot be parsed, if the
    scenario is invalid or has several agents, or if the learner does not play all episodes.
    """
    given = arguments()
    try:
        scenario = with_limit(find_scenario(given.scenario), given.max_steps)
        given.run_dir.mkdir(parents=True, exist_ok=True)
        env = TrainingEnv(scenario, given.episodes, given.run_dir / "metrics.csv",
                          observation=observation)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    env.reset(seed=given.seed)
    write(given.run_dir / "run.json", json.dumps({
        "algorithm": given.name, "options": "", "seed": given.seed, "episodes": given.episodes,
        "scenario": scenario.name, "scenario_hash": scenario.hash, "version": core.VERSION,
        "arguments": sys.argv}, indent=2))
    learner = make(env, given.seed)
    try:
        learner.train()
    except EpisodesOver:
        pass
    env.close()
    if env.episodes_taken < given.episodes:
        print(f"{given.name}: train() ended after {env.episodes_taken} episodes, expected "
              f"{given.episodes}: play the environment until it raises EpisodesOver",
              file=sys.stderr)
        return 2
    began = time.monotonic()
    records, starts = evaluate(learner, scenario, observation, given.evaluation_episodes,
                               given.evaluation_seed)
    with open(given.run_dir / "evaluation.csv", "w", newline="", encoding="utf-8") as file:
        rows = csv.DictWriter(file, EVALUATION, extrasaction="ignore", lineterminator="\n")
        rows.writeheader()
        rows.writerows(cells_of(one) for one in records)
    summary = {**summary_of(records), "algorithm": given.name, "distinct_episodes": starts,
               "training_steps": env.steps_taken, "policy": given.name,
               "farm_seed": FIRST_EVALUATION_SEED + given.evaluation_seed, "farms": 1,
               "seed": given.evaluation_seed, "scenario": scenario.name,
               "scenario_hash": scenario.hash, "version": core.VERSION,
               "wall_s": time.monotonic() - began}
    write(given.run_dir / "evaluation.json", json.dumps(summary, indent=2, sort_keys=True))
    print(f"{given.name}: return {summary['return_per_episode']:.1f}, success "
          f"{100 * summary['success_rate']:.1f} % in {len(records)} episodes")
    return 0
