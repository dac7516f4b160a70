#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds MaskablePPO of sb3-contrib to the benchmark:

    ./aquafarm benchmark learner:="sb3_ppo=python3 benchmark_learner.py"
"""
import sys

import numpy as np
from aquafarm_gym.external import main
from sb3_contrib import MaskablePPO


class Learner:
    """MaskablePPO with unscaled rewards. The rewards are in the tens, so the entropy bonus must
    be large."""

    def __init__(self, env, seed):
        self.model = MaskablePPO("MlpPolicy", env, seed=seed, n_steps=512, learning_rate=1e-3,
                                 gamma=0.97, ent_coef=0.5)

    def train(self):
        """Learns until the environment ends the training by raising EpisodesOver."""
        self.model.learn(10**9)

    def act(self, observation, mask):
        """Returns the greedy action."""
        return int(self.model.predict(observation, deterministic=True,
                                      action_masks=np.asarray(mask, bool))[0])


if __name__ == "__main__":
    sys.exit(main(Learner))
