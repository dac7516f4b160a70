#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures Q-learning written as a NumPy loop and relates the learner's figure to it.

usage: bench_numpy.py BENCH_TABULAR_OUTPUT, a file with 'metric value unit' lines of bench_tabular.

The loop's environment costs nothing (states and rewards drawn beforehand), which flatters it.
"""
import sys
import time

import numpy

METRIC = "q_learning_training_steps"
STEPS = 200000
STATES, ACTIONS = 20000, 10


def numpy_steps_per_second():
    """Updates a table STEPS times under ε-greedy actions; returns steps per second."""
    rng = numpy.random.default_rng(1)
    table = numpy.zeros((STATES, ACTIONS), numpy.float32)
    states = rng.integers(0, STATES, STEPS + 1).tolist()
    rewards = rng.uniform(-5, 0, STEPS).tolist()
    explores = (rng.random(STEPS) < 0.1).tolist()
    others = rng.integers(0, ACTIONS, STEPS).tolist()
    start = time.perf_counter()
    for k in range(STEPS):
        row = table[states[k]]
        action = others[k] if explores[k] else row.argmax()
        row[action] += 0.1 * (rewards[k] + 0.97 * table[states[k + 1]].max() - row[action])
    return STEPS / (time.perf_counter() - start)


def main(path):
    rate = numpy_steps_per_second()
    print(f"numpy_q_learning_steps {rate:.6g} steps/s")
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if len(words) == 3 and words[0] == METRIC and words[2] == "steps/s":
                print(f"q_learning_to_numpy {float(words[1]) / rate:.6g} ratio")
                return 0
    print(f"bench_numpy: {path} has no line '{METRIC} VALUE steps/s'", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
