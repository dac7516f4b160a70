#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds a learner of Stable-Baselines3 to the benchmark:

    ./aquafarm benchmark learner:="sb3_ppo=python3 benchmark_learner.py"
"""
import sys

import numpy as np
from aquafarm_gym.external import main
from sb3_contrib import MaskablePPO


class Learner:
    """MaskablePPO with unscaled rewards. They are in the tens, so the entropy bonus must be
    large."""

    def __init__(self, env, seed):
        self.model = MaskablePPO("MlpPolicy", env, seed=seed, n_steps=512, learning_rate=1e-3,
                                 gamma=0.97, ent_coef=0.5)

    def train(self):
        """Learns until the environment ends the training by an exception."""
        self.model.learn(10**9)

    def act(self, observation, mask):
        """Returns the greedy action."""
        return int(self.model.predict(observation, deterministic=True,
                                      action_masks=np.asarray(mask, bool))[0])


if __name__ == "__main__":
    sys.exit(main(Learner))
