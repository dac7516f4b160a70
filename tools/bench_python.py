# SPDX-License-Identifier: BSD-3-Clause
"""Measures how fast the environments of aquafarm_gym step, and prints 'metric value unit' lines.

usage: bench_python.py [REPETITIONS]      (with the Python of an environment that has aquafarm_gym)

Each figure is a number of steps or states per second of processor time: the median of the
repetitions (default: 7). Min and max follow in parentheses. The actions are drawn before the
measurement. Figures that need PettingZoo or Stable-Baselines3 are left out if these packages are
not installed.
"""
import importlib.util
import sys
import time

import aquafarm_core as core
import aquafarm_gym
import numpy as np

STEPS = 200


def measure(name, unit, count, repetitions, call):
    """Prints the rate of `call`, which makes `count` steps. First calls it once to warm up."""
    call()
    rates = []
    for _ in range(repetitions):
        start = time.process_time()
        call()
        rates.append(count / (time.process_time() - start))
    print(f"{name} {np.median(rates):.3g} {unit} ({min(rates):.3g} to {max(rates):.3g}, "
          f"n = {repetitions})", flush=True)


def play(envs, actions):
    """Resets a vector environment; returns a function that steps it with each row of actions."""
    envs.reset(seed=1)

    def call():
        for row in actions:
            envs.step(row)
    return call


def main(repetitions):
    """Measures every interface."""
    rng = np.random.default_rng(1)
    single = rng.integers(0, 10, (STEPS, 1024))
    batch = core.FarmBatch(aquafarm_gym.find_scenario("paper"), 1024,
                           ["rewards", "end_reasons", "is_first", "index"])
    batch.reset(1)
    rows = single.astype(np.uint8)[:, :, None]
    measure("python_batch_index", "steps/s", single.size, repetitions,
            lambda: [batch.step(row) for row in rows])
    for observation in ("index", "features", "planes"):
        envs = aquafarm_gym.FarmVectorEnv(1024, "paper", observation, copy=False)
        measure(f"python_vector_{observation}", "steps/s", single.size, repetitions,
                play(envs, single))
    joint = rng.integers(0, 10, (STEPS, 1024, 2))
    for observation in ("features", "planes"):
        envs = aquafarm_gym.TeamVectorEnv(1024, "two_squads", observation, copy=False)
        measure(f"python_teams_{observation}", "joint_steps/s", STEPS * 1024, repetitions,
                play(envs, joint))
    env = aquafarm_gym.FarmParallelEnv("two_squads") if importlib.util.find_spec("pettingzoo") else None
    if env:
        env.reset(seed=1)
        measure("python_state", "states/s", STEPS, repetitions,
                lambda: [env.state() for _ in range(STEPS)])
    if importlib.util.find_spec("stable_baselines3"):
        for observation in ("index", "features"):
            envs = aquafarm_gym.FarmVecEnv(64, "paper", observation)
            envs.reset()
            measure(f"python_sb3_64_{observation}", "steps/s", STEPS * 64, repetitions,
                    lambda: [envs.step(row) for row in single[:, :64]])


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 7)
