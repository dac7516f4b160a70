# SPDX-License-Identifier: BSD-3-Clause
"""A policy's best, median and worst episode as films, and the map, by the suite's own programs."""
import csv
import json
import pathlib
import subprocess

import roslib.packages

LIMIT_S = 300
FRAMES = 240  # a film has no more than some so many
SIDE = ["--width", "640", "--height", "560"]
SEED = 2000  # of episodes that neither training nor the benchmark plays


class ReportError(Exception):
    """Why there is no report, in one line."""


def program(package, name):
    """Path of one of the suite's programs."""
    found = roslib.packages.find_node(package, name)
    if not found:
        raise ReportError(f"{package} has no {name}; build the workspace first")
    return found[0]


def call(package, name, *arguments):
    """Runs a program; its last line of errors is ours when it fails."""
    try:
        subprocess.run([program(package, name), *map(str, arguments)], check=True, timeout=LIMIT_S,
                       capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines()
        raise ReportError(words[-1] if words else f"{name} ended with {error.returncode}") from None
    except subprocess.TimeoutExpired:
        raise ReportError(f"{name} took longer than {LIMIT_S} s") from None


def evaluate(run, folder, episodes):
    """Plays a run's policy greedily: (summary, one dict an episode)."""
    call("aquafarm_agents", "aquafarm_evaluate", run, "--episodes", episodes, "--seed", SEED,
         "--write", folder / "evaluation")
    with open(folder / "evaluation.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return json.loads((folder / "evaluation.json").read_text(encoding="utf-8")), rows


def choose(rows):
    """[(best, its row), (median, …), (worst, …)] by return; an episode is shown once."""
    ranked = sorted(rows, key=lambda row: (-float(row["return"]), int(row["episode"])))
    chosen = []
    for name, row in (("best", ranked[0]), ("median", ranked[len(ranked) // 2]),
                      ("worst", ranked[-1])):
        if row not in [one for _, one in chosen]:
            chosen.append((name, row))
    return chosen


def bag_of(run, folder, episode):
    """A bag of an episode of SEED."""
    route, bag = folder / f"{episode}.json", folder / f"{episode}.bag"
    call("aquafarm_agents", "aquafarm_evaluate", run, "--episodes", 1, "--farms", 1, "--seed", SEED,
         "--route", route, "--route-episode", episode)
    call("aquafarm_sim", "episode_bag", run / "scenario.yaml", route, "-o", bag)
    return bag


def draw_film(bag, steps):
    """A film of a bag: mp4, or gif where there is no codec."""
    every = max(1, -(-steps // FRAMES))
    for ending in (".mp4", ".gif"):
        path = pathlib.Path(bag).with_suffix(ending)
        try:
            call("aquafarm_viz", "render", bag, "-o", path, "--fps", 12, "--every", every, *SIDE)
            return path
        except ReportError:
            if ending == ".gif":
                raise
    return None


def draw_map(bag):
    """The farm at an episode's start."""
    path = pathlib.Path(bag).with_suffix(".png")
    call("aquafarm_viz", "render", bag, "-o", path, "--step", 0, *SIDE)
    return path
