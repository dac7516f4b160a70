# SPDX-License-Identifier: BSD-3-Clause
"""Episodes that people played, read from the bags of `./aquafarm play`, as a row of the benchmark.

    FOLDER/*.bag          one person
    FOLDER/NAME/*.bag     one person per folder
"""
import csv
import dataclasses
import io
import json
import pathlib
import subprocess

import numpy as np

from aquafarm_benchmark import measures, results
from aquafarm_benchmark.protocol import Contestant

HUMAN = Contestant("human", "human", "#e7ba52", learns=False)
_EVALUATION_SEED_BIT = 1 << 63  # base/rng.h
_REASONS = {1: "all_retrieved", 2: "disaster_ended", 3: "step_limit"}
COLUMNS = ("farm", "seed", "episode", "steps", "return", "delivered", "devices",
           "delivered_health", "crashes", "collisions", "steps_in_disaster", "reason", "success")
ADDED = ("energy_kwh", "distance_km")


class BadBag(ValueError):
    """A bag cannot be used. The message is one line."""


@dataclasses.dataclass
class Person:
    """The finished episodes of one person. Each episode has an entry in `rows`, with the keys
    COLUMNS and ADDED, and an entry in `starts`, the result of _start_of."""
    folder: pathlib.Path
    bags: list
    rows: list
    starts: list


def find(folder):
    """Returns a Person for each folder with bags; read adds the episodes. Raises BadBag if there
    are no bags."""
    if not folder.is_dir():
        raise BadBag(f"human: got {folder}, expected a folder with bags of ./aquafarm play")
    places = [folder, *sorted(path for path in folder.iterdir() if path.is_dir())]
    people = [Person(place, sorted(place.glob("*.bag")), [], []) for place in places]
    people = [person for person in people if person.bags]
    if not people:
        raise BadBag(f"human: {folder} and its folders contain no *.bag; ./aquafarm play writes "
                     "one for each finished episode")
    return people


def verify(people, verify_bag):
    """Simulates all bags again with the program verify_bag. Raises BadBag if a bag differs from its
    simulation, or contains an external change such as a bulletin."""
    for bag in (bag for person in people for bag in person.bags):
        done = subprocess.run([verify_bag, str(bag)], capture_output=True, text=True, check=False)
        words = (done.stdout + done.stderr).strip().splitlines()
        if done.returncode != 0:
            raise BadBag(f"human: {words[-1] if words else bag}")
        if "changed from outside" in words[-1]:
            raise BadBag(f"human: {words[-1]}; expected a ranch that changes only by commands; "
                         "remove the bag")


def _start_of(spec, state):
    """Returns a key that is equal for equal starts: layout, devices, disasters and ships."""
    text = io.BytesIO()
    for one in (*spec.islands, *spec.rocks, *spec.ports, *spec.devices, *spec.disasters):
        one.serialize(text)
    return text.getvalue(), tuple((ship.x, ship.y) for ship in state.ships)


def read(people, scenario_hash):
    """Reads the finished episodes of farm 0. Returns the people with at least one episode. Raises
    BadBag if there are no such people, or if a bag has another scenario."""
    import rosbag  # imported here, because the benchmark of learners needs no ROS

    for person in people:
        for path in person.bags:
            spec = start = None
            with rosbag.Bag(str(path)) as bag:
                topics = [topic for topic in bag.get_type_and_topic_info().topics
                          if topic.rsplit("/", maxsplit=1)[-1] in ("spec", "state", "episode")]
                for topic, message, _ in bag.read_messages(topics=topics):
                    name = topic.rsplit("/", maxsplit=1)[-1]
                    if name == "spec":
                        spec = message
                        if spec.scenario_hash != scenario_hash:
                            raise BadBag(
                                f"human: {path}: got scenario {spec.scenario_name} with hash "
                                f"{spec.scenario_hash}, expected the benchmark's {scenario_hash}; "
                                "play with the same scenario:=")
                    elif name == "state" and message.step == 0 and spec is not None:
                        start = _start_of(spec, message)
                    elif name == "episode" and message.farm == 0:
                        person.rows.append(_row(message))
                        person.starts.append(start)
    played = [person for person in people if person.rows]
    if not played:
        raise BadBag(f"human: {people[0].folder}: the bags contain no finished episode")
    return played


def _row(summary):
    row = dict(zip(COLUMNS, (
        summary.farm, summary.seed, summary.episode, summary.steps, summary.episode_return,
        summary.delivered, summary.devices, summary.delivered_health, summary.crashes,
        summary.collisions, summary.steps_in_disaster, _REASONS.get(summary.reason, "none"),
        int(summary.success))))
    # Bags of version 0.1.0 do not contain these fields.
    return dict(row, energy_kwh=getattr(summary, "energy", None),
                distance_km=getattr(summary, "distance", None))


def _column(rows, name):
    return np.array([row[name] for row in rows], dtype=float)


def summary_of(person, farm):
    """Returns the content of evaluation.json for a person. The values are defined as those of
    aquafarm_evaluate."""
    rows = person.rows
    steps = _column(rows, "steps").sum()
    delivering = np.count_nonzero(_column(rows, "delivered"))
    health = _column(rows, "delivered_health").sum()
    return {
        "policy": str(person.folder), "algorithm": HUMAN.name, "training_steps": 0,
        "scenario": farm["scenario"], "scenario_hash": farm["scenario_hash"],
        "version": farm["version"], "bags": [bag.name for bag in person.bags],
        "episodes": len(rows), "distinct_episodes": len(set(person.starts)), "complete": True,
        "return_per_episode": float(_column(rows, "return").mean()),
        "return_per_step": float(_column(rows, "return").sum() / steps) if steps else 0.0,
        "success_rate": float(_column(rows, "success").mean()),
        "steps_per_episode": float(_column(rows, "steps").mean()),
        "delivered_health": float(health / delivering) if delivering else 0.0,
        "crashes_per_episode": float(_column(rows, "crashes").mean()),
        "steps_in_disaster_per_episode": float(_column(rows, "steps_in_disaster").mean()),
        **{f"{name}_per_episode": float(_column(rows, name).mean()) for name in ADDED
           if all(row[name] is not None for row in rows)}}


def write_runs(people, farm, folder):
    """Writes evaluation.csv and evaluation.json of each person to folder/seed_1, seed_2, …"""
    for number, person in enumerate(people, start=1):
        place = folder / f"seed_{number}"
        place.mkdir(parents=True, exist_ok=True)
        text = io.StringIO()
        table = csv.DictWriter(text, (*COLUMNS, *ADDED), lineterminator="\n")
        table.writeheader()
        table.writerows(person.rows)
        results.write_atomically(place / "evaluation.csv", text.getvalue())
        results.write_atomically(place / "evaluation.json",
                                 json.dumps(summary_of(person, farm), indent=2) + "\n")


def contestant(people):
    """Returns the contestant of the row. Its label contains the number of episodes and, if there
    are several people, their number."""
    episodes = sum(len(person.rows) for person in people)
    count = "" if len(people) == 1 else f"{len(people)} people, "
    label = f"human, {count}{episodes} episode{'' if episodes == 1 else 's'}"
    return dataclasses.replace(HUMAN, label=label)


def optimum_of_the_same(people, evaluation_seed, evaluation_csv):
    """Returns the optimum's mean return over the episodes that the people played. All people have
    the same weight. Returns None if an episode is not an evaluation episode of the optimum."""
    with open(evaluation_csv, newline="") as file:
        best = {int(row["episode"]): float(row["return"]) for row in csv.DictReader(file)}
    seed = evaluation_seed | _EVALUATION_SEED_BIT
    means = []
    for person in people:
        if any(row["seed"] != seed or row["episode"] not in best for row in person.rows):
            return None
        means.append(np.mean([best[row["episode"]] for row in person.rows]))
    return float(np.mean(means))


def add_intervals(row, people):
    """If there is one person, replaces the 95 % intervals of the row by intervals over episodes."""
    if len(people) > 1:
        return
    rows = people[0].rows
    returns, steps = _column(rows, "return"), _column(rows, "steps")
    numbers = np.arange(len(rows))

    def per_step(drawn):
        picks = drawn.astype(int)
        return returns[picks].sum() / max(1.0, steps[picks].sum())

    row["return_interval"] = list(measures.bootstrap_interval(returns, np.mean))
    row["return_per_step_interval"] = list(measures.bootstrap_interval(numbers, per_step))
    row["success_interval"] = list(
        measures.wilson_interval(int(_column(rows, "success").sum()), len(rows)))
