#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains PPO of Stable-Baselines3 to retrieve one device, then evaluates the greedy policy.

    python3 train_sb3.py [STEPS]       (first: pip install gymnasium stable-baselines3)
"""
import sys

import aquafarm_core
import aquafarm_gym
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor

STEPS = 15000

# A small ranch near a red tide, for which about ten seconds of training are enough.
SCENARIO = """
name: small
grid: {width: 4, height: 4, cell_size_m: 1000}
time: {step_duration_s: 180, step_limit: 100}
layout:
  mode: fixed
  seed: 1
  islands: [{x: 0, y: 2, width: 1, height: 1}]
  rocks: {cells: [[2, 3]], reward: [-5, -1]}
  ports: {cells: [[1, 2]]}
  devices:
    placement: explicit
    sites: [{cell: [3, 2], kind: monitoring, value: 80}]
rewards: {illegal: -2}
ships: {count: 1, capacity: 1}
disasters:
  - {kind: red_tide, grade: 2, radii: [1], risks: [-5], speed: 0.2, duration: 1000}
"""


def main(steps):
    """Trains for `steps` steps; returns the mean return of episodes not used for training."""
    env = Monitor(aquafarm_gym.FarmEnv(aquafarm_core.Scenario.parse(SCENARIO, "small")))
    # Rewards are in the tens, so the entropy bonus must be large to keep the policy exploring.
    model = PPO("MlpPolicy", env, seed=1, n_steps=1024, batch_size=128, learning_rate=1e-3,
                gamma=0.97, gae_lambda=0.9, ent_coef=0.5)
    model.learn(steps)
    env.reset(seed=1, options={"episode": 1_000_000})
    mean, spread = evaluate_policy(model, env, n_eval_episodes=10)
    print(f"after {steps} steps: mean return {mean:.1f} ± {spread:.1f} over 10 greedy episodes")
    return mean


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else STEPS)
