#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates a policy on ranches at random places of a real coast, with recorded storms.

usage: evaluate_coasts.py CHART ARCHIVE OUTPUT [--ranches N] [--episodes N] [--seed SEED] [--policy P]

`aquafarm_scenario` cuts each ranch from the chart. The seed determines its place, width and height
(12 to 60 cells each), cell size (300 to 1,200 m), number of devices (1 to 10) and number of ports
(1 to 6). A place without enough water or without a shore is replaced by the next random place.
Episodes draw the archive's storms since 2010. The ranches, the results of each ranch and the
table ranches.csv are written to OUTPUT. The same command resumes an interrupted run. The last line
contains the return as a share of the clairvoyant optimum, with a 95 % interval (bootstrap over
ranches). This share covers only the episodes whose plan has at most 400,000 states.
aquafarm_scenario and aquafarm_evaluate must be on the PATH.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys

import numpy

STATES = 400000
YEARS = ("1979:2009", "2010:2200")
COLUMNS = ("ranch", "place", "size", "cell_m", "devices", "ports", "return", "success", "optimum",
           "return_of_planned", "planned", "solved", "solvable")
OPTIMUM = re.compile(r"^optimum ([-0-9.]+), return ([-0-9.]+), .* of (\d+) episodes .*; "
                     r"(\d+) of (\d+) solved$", re.MULTILINE)


def bounds(chart):
    """Returns (south, north, west, east) of a GeoJSON file in degrees."""
    points = []

    def collect(value):
        if isinstance(value, dict):
            for name in ("features", "geometry", "geometries", "coordinates"):
                collect(value.get(name))
        elif isinstance(value, list) and value and isinstance(value[0], (int, float)):
            points.append(value[:2])
        elif isinstance(value, list):
            for one in value:
                collect(one)

    collect(json.loads(chart.read_text(encoding="utf-8")))
    if not points:
        sys.exit(f"evaluate_coasts: {chart}: got no coordinates, expected a coast as GeoJSON")
    (west, south), (east, north) = numpy.min(points, axis=0), numpy.max(points, axis=0)
    return south, north, west, east


def cut(random, box, arguments, path):
    """Cuts a ranch at a random place. Returns its columns `place` to `ports` of ranches.csv,
    or None if the place is refused."""
    place = f"{random.uniform(*box[:2]):.4f},{random.uniform(*box[2:]):.4f}"
    size = "x".join(map(str, random.integers(12, 61, 2)))
    cell, devices, ports = (int(random.integers(*limits)) for limits in ((300, 1201), (1, 11), (1, 7)))
    made = subprocess.run(
        ["aquafarm_scenario", "--chart", arguments.chart, "--center", place, "--size", size, "--cell",
         f"{cell}m", "--devices", str(devices), "--ports", str(ports), "--archive", arguments.archive,
         "--years", YEARS[0], "--evaluation-years", YEARS[1], "--seed",
         str(int(random.integers(1, 2**31))), "--output", path],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if made.returncode == 0 and " 0 island cells" not in made.stdout:
        return {"place": place, "size": size, "cell_m": cell, "devices": devices, "ports": ports}
    path.unlink(missing_ok=True)
    return None


def evaluate(policy, path, episodes):
    """Plays the episodes of a ranch. Returns its last columns of ranches.csv, from `return` on."""
    written = path.with_suffix("")
    played = subprocess.run(
        ["aquafarm_evaluate", policy, path, "--episodes", str(episodes), "--optimum", str(STATES),
         "--write", written], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if played.returncode != 0:
        sys.exit(f"evaluate_coasts: {path}: aquafarm_evaluate ended with code {played.returncode}:\n"
                 f"{played.stdout}")
    figures = json.loads(written.with_suffix(".json").read_text(encoding="utf-8"))
    found = OPTIMUM.search(played.stdout)
    planned = dict(zip(COLUMNS[8:], found.groups() if found else ("", "", 0, 0, 0)))
    return {"return": figures["return_per_episode"], "success": figures["success_rate"], **planned}


def summarize(rows):
    """Prints the return as a share of the optimum, and the number of solved episodes."""
    planned = [row for row in rows if int(row["planned"]) > 0]
    if not planned:
        sys.exit("evaluate_coasts: no plan has few enough states; raise --ranches")
    counts = numpy.array([int(row["planned"]) for row in planned])
    returns, optima = (numpy.array([float(row[name]) for row in planned]) * counts
                       for name in ("return_of_planned", "optimum"))
    chosen = numpy.random.default_rng(1).integers(len(planned), size=(10000, len(planned)))
    low, high = numpy.percentile(returns[chosen].sum(1) / optima[chosen].sum(1), (2.5, 97.5))
    solved, solvable = (sum(int(row[name]) for row in planned) for name in ("solved", "solvable"))
    success = numpy.mean([float(row["success"]) for row in rows])
    print(f"{len(rows)} ranches, mean success {success:.4f}; {len(planned)} ranches with "
          f"{counts.sum()} planned episodes: optimum {optima.sum() / counts.sum():.1f}, return "
          f"{returns.sum() / counts.sum():.1f}, share {returns.sum() / optima.sum():.4f} "
          f"[{low:.4f}, {high:.4f}]; {solved} of {solvable} solved")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("chart", type=pathlib.Path, help="coast as GeoJSON")
    parser.add_argument("archive", type=pathlib.Path, help="storm archive")
    parser.add_argument("output", type=pathlib.Path, help="folder of ranches and results")
    parser.add_argument("--ranches", type=int, default=100)
    parser.add_argument("--episodes", type=int, default=10, help="per ranch")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--policy", default="generalist")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    table = arguments.output / "ranches.csv"
    rows = list(csv.DictReader(table.open(encoding="utf-8"))) if table.is_file() else []
    random = numpy.random.default_rng(arguments.seed)
    box = bounds(arguments.chart)
    number = refused = 0
    while number < arguments.ranches:
        path = arguments.output / f"coast_{number}.yaml"
        ranch = cut(random, box, arguments, path)
        if ranch is None:
            refused += 1
            if refused > 100 * arguments.ranches:
                sys.exit(f"evaluate_coasts: {arguments.chart}: {refused} places were refused")
            continue
        if number == len(rows):
            rows.append({"ranch": number, **ranch, **evaluate(arguments.policy, path, arguments.episodes)})
            with table.open("w", encoding="utf-8") as file:
                writer = csv.DictWriter(file, COLUMNS)
                writer.writeheader()
                writer.writerows(rows)
            print(f"ranch {number + 1} of {arguments.ranches}: {rows[-1]}", file=sys.stderr)
        number += 1
    print(f"{refused} places without enough water or shore were refused")
    summarize(rows)


if __name__ == "__main__":
    main()
