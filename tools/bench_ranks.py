#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares PPO trainings of two and four ranks with a training of one rank.

Usage: bench_ranks.py AQUAFARM_TRAIN [--steps N] [--repetitions N]

A rank is one of the processes that train one policy together; the ranks exchange their gradients.
The trainings with one, two and four ranks alternate, so that other programs disturb all of them
alike. First prints a table. Then prints for each batch size whether two ranks meet the targets for
speed and for the share of time in exchanges, with 95 % intervals. Then prints one line `name value
unit` per figure. Exit code 1: a training failed, or trainings with different numbers of ranks wrote
different policies.
"""

import argparse
import math
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from paired_ratio import describe, mean, paired_ratio

HIDDEN = 128
FEATURES = 81  # of paper.yaml
OUTPUTS = 11  # ten actions and the value
WEIGHTS = (FEATURES + 1) * HIDDEN + (HIDDEN + 1) * HIDDEN + (HIDDEN + 1) * OUTPUTS
EPOCHS = 2
BATCHES = (256, 2048)
RANKS = (1, 2, 4)
MIN_SPEED = 1.8  # target: speed of two ranks on two cores relative to one rank
MAX_EXCHANGE = 0.08  # target: share of the training time of two ranks in exchanges


def train(program, ranks, batch, steps, folder):
    """Runs one training with one core per rank, or with all cores if there are more ranks than
    cores. Returns (training time [s], fraction of it in exchanges, peak memory of the largest
    process [MiB], processor time of all processes including their start [s]). Ends this program if
    the training fails."""
    cores = sorted(os.sched_getaffinity(0))[:ranks]
    command = ["taskset", "-c", ",".join(map(str, cores)), "/usr/bin/env", "OMP_NUM_THREADS=1",
               program, "paper", "-a", "ppo", "--ranks", str(ranks), "-n", str(steps),
               "-o", f"batch_size={batch}", "--evaluate", "0", "-d", str(folder)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True)
    memory = peak_memory(process)
    output = process.communicate()[0]
    if process.returncode != 0:
        sys.exit(f"bench_ranks: {' '.join(command)}: exit code {process.returncode}:\n{output}")
    seconds = re.search(r"^trained .* in (?:(\d+) min )?([0-9.]+) s$", output, re.MULTILINE)
    exchanges = re.search(r"^ranks +\d+, ([0-9.]+) %", output, re.MULTILINE)
    duration = 60.0 * int(seconds[1] or 0) + float(seconds[2])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return duration, float(exchanges[1]) / 100.0 if exchanges else 0.0, memory, processor


def peak_memory(process):
    """Waits for a process to end. Returns the peak resident memory [MiB] of the process or of one
    of its children, whichever is largest."""
    peak = 0
    while True:
        try:
            process.wait(0.2)
            return peak / 1024.0
        except subprocess.TimeoutExpired:
            pass
        for pid in [process.pid] + children(process.pid):
            try:
                text = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
            except OSError:
                continue
            peak = max(peak, *(int(kib) for kib in re.findall(r"VmHWM:\s+(\d+)", text)), 0)


def children(pid):
    """Returns the process ids of the children of a process."""
    try:
        return list(map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split()))
    except OSError:
        return []


def policy(folder):
    return (folder / "policy.ckpt").read_bytes()


def measure(program, steps, repetitions, batch):
    """Returns {number of ranks: list of the results of train(), one per repetition}. Ends this
    program if the policy of several ranks differs from that of one rank."""
    results = {ranks: [] for ranks in RANKS}
    for _ in range(repetitions):
        with tempfile.TemporaryDirectory() as top:
            for ranks in RANKS:
                folder = Path(top) / str(ranks)
                results[ranks].append(train(program, ranks, batch, steps, folder))
                if policy(folder) != policy(Path(top) / "1"):
                    sys.exit(f"bench_ranks: batch {batch}: {ranks} ranks give other bits than one")
    return results


def bars(batch, one, two, cores):
    """Returns a line that compares two ranks with the targets. @param one, two the results of
    train() with one and two ranks"""
    speed = paired_ratio([run[0] for run in one], [run[0] for run in two])
    share = mean([run[1] for run in two])
    speed_met = "met" if speed[0] >= MIN_SPEED else "missed"
    share_met = "met" if share[0] <= MAX_EXCHANGE else "missed"
    return (f"batch {batch}, n = {len(one)}, {min(cores, 2)} cores: speed of two ranks {describe(speed)} "
            f"times, bar {MIN_SPEED}: {speed_met}; in exchanges {describe(share)} of the time, bar "
            f"{MAX_EXCHANGE}: {share_met}; policies of {', '.join(map(str, RANKS))} ranks equal")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="aquafarm_train")
    parser.add_argument("--steps", type=int, default=1500000)
    parser.add_argument("--repetitions", type=int, default=5)
    arguments = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    print(f"{cores} cores, load {os.getloadavg()[0]:.1f}, {arguments.repetitions} repetitions of "
          f"{arguments.steps} steps, {WEIGHTS} weights")
    figures, lines = [], []
    print("batch  ranks  µs/step  of it in exchanges  MiB/rank  processor µs/step  speed  predicted")
    for batch in BATCHES:
        results = measure(arguments.program, arguments.steps, arguments.repetitions, batch)
        middle = {ranks: [statistics.median(column) for column in zip(*results[ranks])]
                  for ranks in RANKS}
        compute = middle[1][0] / arguments.steps
        # The predicted speed assumes that each minibatch needs log2(ranks) exchanges of gradients,
        # and neglects the time of other exchanges.
        per_step = EPOCHS / batch
        exchange = middle[2][0] * middle[2][1] / arguments.steps / per_step
        for ranks in RANKS:
            seconds, fraction, memory, processor = middle[ranks]
            speed = statistics.median(
                one[0] / several[0] for one, several in zip(results[1], results[ranks]))
            predicted = compute / (compute / min(ranks, cores) +
                                   per_step * exchange * math.log2(ranks) * max(1, ranks / cores))
            print(f"{batch:5} {ranks:6} {1e6 * seconds / arguments.steps:8.2f} "
                  f"{100 * fraction:16.1f} % {memory:9.0f} "
                  f"{1e6 * processor / arguments.steps:18.2f} {speed:6.2f} {predicted:10.2f}")
            if ranks == 2:
                extra = 1e6 * (processor - middle[1][3]) / arguments.steps
                figures.append((f"ranks_processor_batch_{batch}", f"{extra:.2f}", "us/step"))
                figures.append((f"ranks_speed_batch_{batch}", f"{speed:.3f}", "times"))
                figures.append((f"ranks_exchange_batch_{batch}", f"{100 * fraction:.1f}", "%"))
        figures.append((f"ranks_sum_batch_{batch}", f"{1e6 * exchange:.0f}", "us"))
        lines.append(bars(batch, results[1], results[2], cores))
    print(*lines, sep="\n")
    for figure in figures:
        print(*figure)


if __name__ == "__main__":
    main()
