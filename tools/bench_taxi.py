#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures Gymnasium's Taxi-v3 under random actions and relates the farm's figure to it.

usage: bench_taxi.py BENCH_SIM_OUTPUT, a file with 'metric value unit' lines of bench_sim.
"""
import sys
import time

import gymnasium
import numpy

FARM_METRIC = "farm_steps_tabular"
DURATION_S = 3.0
CHUNK = 10000


def taxi_steps_per_second():
    """Steps Taxi-v3 for DURATION_S with actions drawn beforehand; returns steps per second."""
    env = gymnasium.make("Taxi-v3")
    env.reset(seed=1)
    actions = numpy.random.default_rng(1).integers(0, 6, CHUNK).tolist()
    steps = 0
    start = time.perf_counter()
    while time.perf_counter() - start < DURATION_S:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        steps += CHUNK
    return steps / (time.perf_counter() - start)


def main(path):
    taxi = taxi_steps_per_second()
    print(f"taxi_v3_steps {taxi:.6g} steps/s")
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if len(words) == 3 and words[0] == FARM_METRIC and words[2] == "steps/s":
                print(f"farm_steps_tabular_to_taxi_v3 {float(words[1]) / taxi:.6g} ratio")
                return 0
    print(f"bench_taxi: {path} has no line '{FARM_METRIC} VALUE steps/s'", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
