# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates policies, plays episodes, and renders videos and maps with the programs of aquafarm."""
import csv
import json
import pathlib
import subprocess

import yaml

from aquafarm_bringup.programs import find_program

LIMIT_S = 300  # default max duration of a program [s]
FRAMES = 240  # approximate max number of frames of a video
SIDE = ["--width", "800", "--height", "640"]
SEED = 1000  # seed of the evaluation episodes, the default of aquafarm_evaluate


class ReportError(Exception):
    """A report cannot be made. The message is one line."""


def program(package, name):
    """Returns the path of a program of aquafarm. Raises ReportError if it is not built."""
    found = find_program(package, name)
    if not found:
        raise ReportError(f"{package} has no {name}; build the workspace first")
    return found


def call(package, name, *arguments, limit_s=LIMIT_S):
    """Runs a program. Raises ReportError if it takes longer than `limit_s` or fails. The message of
    a failure is the last line of the program's stderr, or of its stdout if stderr is empty."""
    try:
        subprocess.run([program(package, name), *map(str, arguments)], check=True, timeout=limit_s,
                       capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines()
        raise ReportError(words[-1] if words else f"{name} ended with {error.returncode}") from None
    except subprocess.TimeoutExpired:
        raise ReportError(f"{name} took longer than {limit_s} s") from None


def evaluate(run, folder, episodes):
    """Evaluates the policy of a run greedily. Returns (summary, rows of evaluation.csv)."""
    call("aquafarm_agents", "aquafarm_evaluate", run, "--episodes", episodes, "--seed", SEED,
         "--write", folder / "evaluation")
    with open(folder / "evaluation.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return json.loads((folder / "evaluation.json").read_text(encoding="utf-8")), rows


def choose(rows):
    """Returns [("best", row), ("median", row), ("worst", row)] by return. An episode occurs only
    once."""
    ranked = sorted(rows, key=lambda row: (-float(row["return"]), int(row["episode"])))
    chosen = []
    for name, row in (("best", ranked[0]), ("median", ranked[len(ranked) // 2]),
                      ("worst", ranked[-1])):
        if row not in [one for _, one in chosen]:
            chosen.append((name, row))
    return chosen


def result_text(row):
    """Returns a row of evaluation.csv as "return 269.6 in 63 steps, 3 of 3 home, all retrieved"."""
    return (f"return {float(row['return']):.1f} in {row['steps']} steps, {row['delivered']} of "
            f"{row['devices']} home, {row['reason'].replace('_', ' ')}")


def is_family(run):
    """Returns whether the scenario of a run is a family, which draws a new ranch in every
    episode."""
    scenario = yaml.safe_load((run / "scenario.yaml").read_text(encoding="utf-8"))
    return isinstance(scenario, dict) and bool(scenario.get("family"))


def bag_of(run, folder, episode):
    """Plays an evaluation episode with the policy of a run. Returns the path of its bag."""
    route, bag = folder / f"{episode}.json", folder / f"{episode}.bag"
    call("aquafarm_agents", "aquafarm_evaluate", run, "--episodes", 1, "--farms", 1, "--seed", SEED,
         "--route", route, "--route-episode", episode)
    call("aquafarm_sim", "episode_bag", run / "scenario.yaml", route, "-o", bag)
    return bag


def draw_video(bag, steps):
    """Renders a bag as a video. Returns its path: mp4, or gif if mp4 fails, for example without a
    codec."""
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
    """Renders the ranch at the start of a bag's episode. Returns the path of the image."""
    path = pathlib.Path(bag).with_suffix(".png")
    call("aquafarm_viz", "render", bag, "-o", path, "--step", 0, *SIDE)
    return path
