#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the wall time of a benchmark on Dask with that of the pool of processes that Dask replaced.

Usage: bench_dask.py [--programs FOLDER] [--repetitions N] [--jobs N] [--before COMMIT]
                     [-- BENCHMARK ARGUMENTS]

The code with the pool is that of an earlier commit (--before), taken from git. Both versions call
the same C++ programs. Each repetition runs the benchmark with both versions, in alternating order.
The default is the quick benchmark of `paper`, which takes minutes. Prints one line per repetition,
then the ratio Dask / pool with its 95 % interval and the number of repetitions. Exit code 1: a
benchmark failed, the two versions wrote different tables, or git lacks the earlier commit.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from paired_ratio import describe, paired_ratio

ROOT = pathlib.Path(__file__).resolve().parents[1]
BEFORE_DASK = "d104ba3^"  # d104ba3: benchmarks execute on Dask
PACKAGE = "aquafarm_agents"
TABLE = "runs.csv"


def earlier_code(folder, commit):
    """Writes the Python code of aquafarm_agents at a commit into a folder."""
    archive = subprocess.run(["git", "-C", ROOT, "archive", commit, f"{PACKAGE}/python",
                              f"{PACKAGE}/scripts"], stdout=subprocess.PIPE, check=False)
    if archive.returncode != 0:
        sys.exit(f"bench_dask: git has no commit {commit}; run it in a clone with all commits")
    subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)


def seconds(code, programs, jobs, output, words):
    """Runs a benchmark with the Python code of the folder `code`; returns its wall time [s]."""
    command = ["/usr/bin/python3", code / PACKAGE / "scripts/aquafarm_benchmark", *words, "--jobs",
               str(jobs), "--programs", programs, "--output", output]
    environment = {**os.environ, "PYTHONPATH": str(code / PACKAGE / "python"), "OMP_NUM_THREADS": "1"}
    start = time.monotonic()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    taken = time.monotonic() - start
    if done.returncode != 0:
        sys.exit(f"bench_dask: {' '.join(map(str, command))}: exit code {done.returncode}:\n"
                 f"{done.stdout}{done.stderr}")
    return taken


def main(words):
    rest = words[words.index("--") + 1:] if "--" in words else []
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path,
                        default=ROOT / ".ws/devel/lib/aquafarm_agents",
                        help="folder of aquafarm_train and aquafarm_evaluate")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--before", default=BEFORE_DASK, help="commit with the pool")
    arguments = parser.parse_args(words[:len(words) - len(rest) - 1] if "--" in words else words)
    rest = rest or ["paper", "--profile", "quick"]
    print(f"{arguments.jobs} jobs, load {os.getloadavg()[0]:.1f}, {arguments.repetitions} pairs of: "
          f"aquafarm_benchmark {' '.join(rest)}", flush=True)
    times = {"dask": [], "pool": []}
    with tempfile.TemporaryDirectory(prefix="aquafarm_bench_dask_") as top:
        top = pathlib.Path(top)
        earlier_code(top, arguments.before)
        code = {"dask": ROOT, "pool": top}
        for number in range(arguments.repetitions):
            for name in sorted(times, reverse=number % 2 == 1):
                times[name].append(seconds(code[name], arguments.programs, arguments.jobs,
                                           top / f"{name}_{number}", rest))
            print(f"pair {number + 1}: Dask {times['dask'][-1]:.1f} s, pool {times['pool'][-1]:.1f} s",
                  flush=True)
            if (top / f"dask_{number}" / TABLE).read_bytes() != (
                    top / f"pool_{number}" / TABLE).read_bytes():
                sys.exit(f"bench_dask: {TABLE} of Dask and the pool differ")
    ratio = paired_ratio(times["dask"], times["pool"])
    print(f"Dask / pool: {describe(ratio)}, n = {arguments.repetitions}; bar: at most 1.05; {TABLE} equal")
    print(f"dask_wall_time {ratio[0]:.3f} times")


if __name__ == "__main__":
    main(sys.argv[1:])
