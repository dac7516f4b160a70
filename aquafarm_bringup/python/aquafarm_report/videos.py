# SPDX-License-Identifier: BSD-3-Clause
"""Videos of a policy's best, median and worst episode, and the map, by the suite's programs."""
import csv
import json
import pathlib
import subprocess

import roslib.packages
import yaml

LIMIT_S = 300
FRAMES = 240  # approximate max number of frames of a video
SIDE = ["--width", "800", "--height", "640"]
SEED = 1000  # of episodes that no training plays, the default of aquafarm_evaluate


class ReportError(Exception):
    """Reason why a report cannot be made, in one line."""


def program(package, name):
    """Path of one of the suite's programs."""
    found = roslib.packages.find_node(package, name)
    if not found:
        raise ReportError(f"{package} has no {name}; build the workspace first")
    return found[0]


def call(package, name, *arguments, limit_s=LIMIT_S):
    """Runs a program; on failure raises ReportError with its last line of stderr."""
    try:
        subprocess.run([program(package, name), *map(str, arguments)], check=True, timeout=limit_s,
                       capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines()
        raise ReportError(words[-1] if words else f"{name} ended with {error.returncode}") from None
    except subprocess.TimeoutExpired:
        raise ReportError(f"{name} took longer than {limit_s} s") from None


def evaluate(run, folder, episodes):
    """Plays a run's policy greedily: (summary, one dict per episode)."""
    call("aquafarm_agents", "aquafarm_evaluate", run, "--episodes", episodes, "--seed", SEED,
         "--write", folder / "evaluation")
    with open(folder / "evaluation.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return json.loads((folder / "evaluation.json").read_text(encoding="utf-8")), rows


def choose(rows):
    """[(best, its row), (median, …), (worst, …)] by return, without duplicate episodes."""
    ranked = sorted(rows, key=lambda row: (-float(row["return"]), int(row["episode"])))
    chosen = []
    for name, row in (("best", ranked[0]), ("median", ranked[len(ranked) // 2]),
                      ("worst", ranked[-1])):
        if row not in [one for _, one in chosen]:
            chosen.append((name, row))
    return chosen


def result_text(row):
    """Returns "return 269.6 in 63 steps, 3 of 3 home, all retrieved" for a row of evaluation.csv."""
    return (f"return {float(row['return']):.1f} in {row['steps']} steps, {row['delivered']} of "
            f"{row['devices']} home, {row['reason'].replace('_', ' ')}")


def is_family(run):
    """Whether the scenario of a run draws another ranch in every episode."""
    scenario = yaml.safe_load((run / "scenario.yaml").read_text(encoding="utf-8"))
    return isinstance(scenario, dict) and bool(scenario.get("family"))


def bag_of(run, folder, episode):
    """Records an episode of SEED as a bag."""
    route, bag = folder / f"{episode}.json", folder / f"{episode}.bag"
    call("aquafarm_agents", "aquafarm_evaluate", run, "--episodes", 1, "--farms", 1, "--seed", SEED,
         "--route", route, "--route-episode", episode)
    call("aquafarm_sim", "episode_bag", run / "scenario.yaml", route, "-o", bag)
    return bag


def draw_video(bag, steps):
    """Renders a bag as a video: mp4, or gif if there is no codec."""
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
    """Renders the farm at an episode's start."""
    path = pathlib.Path(bag).with_suffix(".png")
    call("aquafarm_viz", "render", bag, "-o", path, "--step", 0, *SIDE)
    return path
