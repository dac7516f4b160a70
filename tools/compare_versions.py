#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the speed of two versions, each in a workspace that ./aquafarm bench has built. Runs
their benchmarks alternately. Prints for each figure the geometric mean of the ratios new / old and
its 95 % interval. For costs, such as seconds, bytes or figures whose name starts with cost_, the
ratio is old / new: a ratio above 1 means that the new version is better."""
import argparse
import pathlib
import re
import subprocess
import sys

import paired_ratio
from verbs.bench import FIGURE

# For each benchmark: its program, relative to the workspace, and the options of the program.
BENCHES = {"sim": ["core/aquafarm_sim/bench_sim"],
           "tabular": ["core/aquafarm_agents/bench_tabular"],
           "dqn": ["core/aquafarm_agents/bench_deep", "--benchmark_filter=^Dqn"],
           "lstm": ["core/aquafarm_agents/bench_deep", "--benchmark_filter=^LstmDqn"],
           "ros": ["devel/lib/aquafarm_sim/ros_bench"]}
COST = re.compile(r"(s|ms|us|µs|ns|bytes|B|kB|MB)\b(?!/s\b)")
LIMIT_S = 900  # for one benchmark


class Failed(Exception):
    """A benchmark cannot be run. The message is one line."""


def measure(workspace, words):
    """Returns {figure: (value, unit)} of one run of a benchmark."""
    command = [str(workspace / words[0]), *words[1:]]
    if words[0].startswith("devel/"):
        command = ["bash", "-c", 'source "$0" && exec "$@"', workspace / "devel/setup.bash", *command]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=LIMIT_S, check=True)
    except (OSError, subprocess.SubprocessError) as error:
        raise Failed(f"{workspace / words[0]}: {error}; build it with ./aquafarm bench") from None
    lines = [line.split(maxsplit=2) for line in done.stdout.splitlines() if FIGURE.match(line)]
    return {name: (float(value), unit) for name, value, unit in lines}


def describe(name, pairs):
    """Returns the printed line of a figure. @param pairs for each round, the results of measure()
    of the old and of the new version"""
    if any(name not in one for pair in pairs for one in pair):
        return f"{name:44} printed by only one version"
    unit = pairs[0][1][name][1]
    before, after = ([pair[i][name][0] for pair in pairs] for i in range(2))
    if min(*before, *after) <= 0.0:
        return f"{name:44} has no ratio: not above 0"
    is_cost = COST.match(unit) or name.startswith("cost_")
    ratio = paired_ratio.paired_ratio(*((before, after) if is_cost else (after, before)))
    return f"{name:44} {paired_ratio.describe(ratio)}, n {len(pairs)}, {unit}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("old", type=pathlib.Path, help="workspace (.ws) of the old version")
    parser.add_argument("new", type=pathlib.Path, help="workspace (.ws) of the new version")
    parser.add_argument("--only", default=",".join(BENCHES), help="benchmarks (default: %(default)s)")
    parser.add_argument("--rounds", type=int, default=5, help="2 or more (default: %(default)s)")
    options = parser.parse_args()
    names = options.only.split(",")
    unknown = [name for name in names if name not in BENCHES]
    if unknown:
        parser.error(f"--only: got '{unknown[0]}', expected some of: {','.join(BENCHES)}")
    if options.rounds < 2:
        parser.error(f"--rounds: got {options.rounds}, expected 2 or more")
    versions = [options.old.resolve(), options.new.resolve()]
    try:
        for name in names:
            pairs = []
            for turn in range(options.rounds):
                order = versions if turn % 2 == 0 else versions[::-1]
                found = {version: measure(version, BENCHES[name]) for version in order}
                pairs.append([found[version] for version in versions])
                print(f"{name}: round {turn + 1} of {options.rounds}", file=sys.stderr, flush=True)
            for figure in {**pairs[0][0], **pairs[0][1]}:
                print(describe(figure, pairs), flush=True)
    except Failed as fault:
        print(f"compare_versions: {fault}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
