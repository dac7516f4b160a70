#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains a learner with several weights of energy, evaluates each policy, and compares.

usage: energy_of_learners.py SCENARIO.yaml ALGORITHM OUT.csv [--seeds N] [--weights W ...]
                             [--episodes N] [--from-first] [-- OPTION OF aquafarm_train ...]

There is one training for each weight and seed. With --from-first, trainings of later weights start
with the policy of the first weight. The first weight must then be above 0, because the features
contain the energy only for weights above 0. The return excludes the term of energy. OUT.csv has a
row per training, and may have rows of several algorithms. The same command resumes an interrupted
run.

The printed table has the means over the seeds. It also has the change of return and energy relative
to the first weight, with 95 % intervals (bootstrap over seeds; each change compares two trainings
of the same seed). The run folders are in a folder with the name of OUT.csv without .csv.
aquafarm_train and aquafarm_evaluate must be on the PATH.
"""
import argparse
import csv
import pathlib
import shutil
import subprocess
import sys

import numpy

from energy_curve import energy_block, measure

SAMPLES = 10000
COLUMNS = ("algorithm", "seed", "policy", "weight", "episodes", "return_without_energy",
           "energy_kwh", "distance_km", "success_rate", "steps")


def run_folder(weight, seed, arguments):
    return arguments.output.with_suffix("") / f"{arguments.algorithm}_{seed}_{weight:g}"


def train(text, weight, seed, arguments):
    """Trains on the scenario with a weight; returns the row of its policy."""
    run = run_folder(weight, seed, arguments)
    shutil.rmtree(run, ignore_errors=True)  # the folder of an interrupted training
    run.parent.mkdir(parents=True, exist_ok=True)
    scenario = run.parent / f"{run.name}.yaml"
    scenario.write_text(energy_block(text, weight), encoding="utf-8")
    start = [] if not arguments.from_first or weight == arguments.weights[0] else \
        ["--init", run_folder(arguments.weights[0], seed, arguments)]
    subprocess.run(["aquafarm_train", scenario, "-a", arguments.algorithm, "-s", str(seed), "-d", run,
                    "--evaluate", "0", "--random", "0", *start, *arguments.options], check=True,
                   stdout=subprocess.DEVNULL)
    return {**measure(text, str(run), arguments.episodes, weight),
            "algorithm": arguments.algorithm, "seed": str(seed), "policy": "trained"}


def read_rows(path, algorithm):
    """Returns the rows of an algorithm. The file may contain rows of several algorithms."""
    if not path.is_file():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if row["algorithm"] == algorithm]


def append(path, row):
    is_new = not path.is_file()
    with open(path, "a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        if is_new:
            writer.writeheader()
        writer.writerow(row)


def interval(values):
    """Returns the 2.5 and 97.5 % quantiles of the mean of resampled values."""
    picks = numpy.random.default_rng(1).integers(0, len(values), (SAMPLES, len(values)))
    return numpy.quantile(numpy.asarray(values)[picks].mean(axis=1), (0.025, 0.975))


def changes(rows, weight, first, column):
    """Returns for each seed the change of a column relative to the first weight [%]."""
    by_seed = {row["seed"]: float(row[column]) for row in rows if float(row["weight"]) == first}
    return [100 * (float(row[column]) / by_seed[row["seed"]] - 1) for row in rows
            if float(row["weight"]) == weight and row["seed"] in by_seed]


def table(rows, weights):
    """Returns the lines of the table."""
    lines = ["| weight | n | return | energy [kWh] | success | return, change | energy, change |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for weight in weights:
        own = [row for row in rows if float(row["weight"]) == weight]
        means = [numpy.mean([float(row[name]) for row in own]) for name in
                 ("return_without_energy", "energy_kwh", "success_rate")]
        cells = [f"{weight:g}", str(len(own)), f"{means[0]:.1f}", f"{means[1]:.2f}", f"{means[2]:.3f}"]
        for column in ("return_without_energy", "energy_kwh"):
            change = changes(rows, weight, weights[0], column)
            low, high = interval(change)
            cells.append("" if weight == weights[0] else
                         f"{numpy.mean(change):+.1f} % ({low:+.1f} … {high:+.1f})")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("scenario", type=pathlib.Path)
    parser.add_argument("algorithm")
    parser.add_argument("output", type=pathlib.Path, help="a CSV file")
    parser.add_argument("--seeds", type=int, default=5, help="trainings per weight (default 5)")
    parser.add_argument("--weights", type=float, nargs="+", default=[0.0, 1.0, 3.0, 10.0])
    parser.add_argument("--episodes", type=int, default=1000, help="of each evaluation (default 1000)")
    parser.add_argument("--from-first", action="store_true",
                        help="later weights start with the policy of the first")
    parser.usage = "%(prog)s SCENARIO.yaml ALGORITHM OUT.csv [options] [-- OPTION OF aquafarm_train ...]"
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    arguments = parser.parse_args(words[:end])
    arguments.options = words[end + 1:]
    text = arguments.scenario.read_text(encoding="utf-8")
    trained = {(row["seed"], float(row["weight"]))
               for row in read_rows(arguments.output, arguments.algorithm)}
    jobs = [(seed, weight) for seed in range(1, arguments.seeds + 1) for weight in arguments.weights]
    for number, (seed, weight) in enumerate(jobs, 1):
        if (str(seed), weight) not in trained:
            print(f"training {number} of {len(jobs)}: seed {seed}, weight {weight:g}",
                  file=sys.stderr, flush=True)
            append(arguments.output, train(text, weight, seed, arguments))
    rows = read_rows(arguments.output, arguments.algorithm)
    print("\n".join(table(rows, arguments.weights)))


if __name__ == "__main__":
    main()
