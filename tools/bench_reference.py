#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures a well-known reference and relates a benchmark's figure to it.

usage: bench_reference.py taxi | numpy BENCH_OUTPUT, a file with 'metric value unit' lines.
"""
import sys
import time

import numpy

CHUNK = 10000
DURATION_S = 3.0
STATES, ACTIONS = 20000, 10


def taxi_steps_per_second():
    """Steps Gymnasium's Taxi-v3 under random actions drawn beforehand; returns steps a second."""
    import gymnasium  # in the environment of this reference alone
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


def numpy_steps_per_second():
    """Q-learning as a NumPy loop on an environment that costs nothing, which flatters it: states
    and rewards are drawn beforehand; returns training steps a second."""
    rng = numpy.random.default_rng(1)
    table = numpy.zeros((STATES, ACTIONS), numpy.float32)
    states = rng.integers(0, STATES, CHUNK + 1).tolist()
    rewards = rng.uniform(-5, 0, CHUNK).tolist()
    explores = (rng.random(CHUNK) < 0.1).tolist()
    others = rng.integers(0, ACTIONS, CHUNK).tolist()
    steps = 0
    start = time.perf_counter()
    while time.perf_counter() - start < DURATION_S:
        for k in range(CHUNK):
            row = table[states[k]]
            action = others[k] if explores[k] else row.argmax()
            row[action] += 0.1 * (rewards[k] + 0.97 * table[states[k + 1]].max() - row[action])
        steps += CHUNK
    return steps / (time.perf_counter() - start)


# How each reference is measured, its name, and the metric of ours that is related to it.
REFERENCES = {
    "taxi": (taxi_steps_per_second, "taxi_v3", "farm_steps_tabular"),
    "numpy": (numpy_steps_per_second, "numpy_q_learning", "q_learning_training_steps"),
}


def main(which, path):
    measure, name, metric = REFERENCES[which]
    rate = measure()
    print(f"{name}_steps {rate:.6g} steps/s")
    with open(path, encoding="utf-8") as lines:
        for words in map(str.split, lines):
            if len(words) == 3 and words[0] == metric:
                print(f"{metric}_to_{name} {float(words[1]) / rate:.6g} ratio")
                return 0
    print(f"bench_reference: {path} has no line '{metric} VALUE steps/s'", file=sys.stderr)
    return 1


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in REFERENCES:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(*sys.argv[1:]))
