#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains MaskablePPO of sb3-contrib on a shipped farm, with 64 farms stepped together in C++.

    python3 masked_ppo.py [--scenario paper] [--steps 3000000] [--seed 1] [--save model.zip]

Install first: pip install './aquafarm_gym[sb3]'. The action mask excludes illegal pickups and
drop-offs. Without it, PPO, A2C and DQN with their default options learn to wait. Most random
pickups and drop-offs cost 10, so waiting at -1 per step looks better than any attempt
(docs/python.md).
"""
import argparse
import time

import aquafarm_gym
import numpy as np
import torch
from sb3_contrib import MaskablePPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecNormalize

# The episodes of aquafarm_evaluate --seed 1000. Seeds of trainings are below 2**63; with them, an
# archive of storms draws the storms of the training years.
EVALUATION_SEED = 2**63 + 1000
GAMMA = 0.98
ENTROPY = 0.02


class DecayEntropy(BaseCallback):
    """Decreases the entropy bonus linearly to 0, as aquafarm's own PPO does by default."""

    def _on_step(self):
        return True

    def _on_rollout_start(self):
        self.model.ent_coef = ENTROPY * self.model._current_progress_remaining


def make_model(envs, seed, rollout=16384, batch=512):
    """Returns the learner. The options given here are the defaults of aquafarm's PPO
    (docs/algorithms.md), except for the batch size. rollout: number of steps between two updates,
    summed over all environments."""
    return MaskablePPO("MlpPolicy", envs, seed=seed, n_steps=rollout // envs.num_envs,
                       batch_size=batch, n_epochs=2, gamma=GAMMA,
                       learning_rate=lambda remaining: 1e-3 * remaining,
                       gae_lambda=0.95, policy_kwargs={"net_arch": [128, 128]})


def evaluate(model, scenario, episodes):
    """Returns (mean return, success rate) of greedy play in episodes not used for training."""
    envs = aquafarm_gym.FarmVecEnv(episodes, scenario)
    envs.farms.reset(EVALUATION_SEED)  # envs.seed accepts only seeds of trainings
    seen, results = envs.farms.buffers["features"].reshape(envs.num_envs, -1).copy(), {}
    while len(results) < episodes:
        actions, _ = model.predict(seen, deterministic=True, action_masks=envs.action_masks())
        seen, _, _, infos = envs.step(actions)
        for farm, info in enumerate(infos):
            if "episode" in info:
                results.setdefault(farm, (info["episode"]["r"], info["is_success"]))
    return tuple(np.mean([results[farm] for farm in range(episodes)], axis=0))


def main(scenario="paper", steps=3_000_000, seed=1, save=None, farms=64, episodes=100, **options):
    """Trains and evaluates; returns (mean return, success rate, steps per second). options:
    arguments of make_model."""
    torch.set_num_threads(1)
    # Rewards are in the tens: VecNormalize scales them for the value network.
    envs = VecNormalize(aquafarm_gym.FarmVecEnv(farms, scenario), norm_obs=False, gamma=GAMMA)
    model = make_model(envs, seed, **options)
    model.learn(steps, callback=DecayEntropy())
    rate = model.num_timesteps / ((time.time_ns() - model.start_time) / 1e9)
    if save:
        model.save(save)
    mean, success = evaluate(model, scenario, episodes)
    print(f"{scenario}: {model.num_timesteps:,} steps at {rate:,.0f} steps/s; mean return {mean:.1f}, "
          f"success {100 * success:.0f} % in {episodes} greedy episodes")
    return mean, success, rate


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--steps", type=int, default=3_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--save", help="file for the trained model")
    given = parser.parse_args()
    main(given.scenario, given.steps, given.seed, given.save)
