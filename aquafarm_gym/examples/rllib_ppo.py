#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains PPO of RLlib with an action mask. The farms run in this process or in worker processes.

    python3 rllib_ppo.py [--scenario paper] [--steps 1000000] [--workers 0] [--seed 1]

Install first: pip install ./aquafarm_gym 'ray[rllib]' torch. The wrapper ActionMaskInObservation
adds the mask to the observation. MaskedModule gives illegal actions the probability 0.
"""
import argparse
import time

import aquafarm_gym
import gymnasium
import numpy as np
import torch
from aquafarm_gym.spaces import action_mask
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.columns import Columns
from ray.rllib.core.rl_module.apis.value_function_api import ValueFunctionAPI
from ray.rllib.core.rl_module.rl_module import RLModuleSpec
from ray.rllib.core.rl_module.torch import TorchRLModule
from ray.tune.registry import register_env
from torch import nn

# The episodes of aquafarm_evaluate --seed 1000. Seeds of trainings are below 2**63; with them, an
# archive of storms draws the storms of the training years.
EVALUATION_SEED = 2**63 + 1000
REWARD_SCALE = 0.05  # rewards are in the tens
GAMMA, HIDDEN, BATCH = 0.98, 128, 4096


def make_env(config):
    """Returns a farm whose observations contain the mask and whose rewards are scaled."""
    env = aquafarm_gym.ActionMaskInObservation(aquafarm_gym.FarmEnv(config["scenario"]))
    return gymnasium.wrappers.TransformReward(env, lambda reward: REWARD_SCALE * reward)


class MaskedModule(TorchRLModule, ValueFunctionAPI):
    """An actor and a critic with two hidden layers each; illegal actions have probability 0."""

    def setup(self):
        inputs = self.observation_space["observation"].shape[0]

        def layers(outputs):
            return nn.Sequential(nn.Linear(inputs, HIDDEN), nn.Tanh(), nn.Linear(HIDDEN, HIDDEN),
                                 nn.Tanh(), nn.Linear(HIDDEN, outputs))

        self.actor, self.critic = layers(int(self.action_space.n)), layers(1)

    def _forward(self, batch, **_):
        seen = batch[Columns.OBS]
        logits = self.actor(seen["observation"])
        return {Columns.ACTION_DIST_INPUTS: logits.masked_fill(seen["action_mask"] == 0, -1e9)}

    def compute_values(self, batch, embeddings=None):
        return self.critic(batch[Columns.OBS]["observation"]).squeeze(-1)


@torch.no_grad()
def evaluate(module, scenario, episodes):
    """Returns (mean return, success rate) of greedy play in episodes not used for training."""
    farms, records = aquafarm_gym.LocalFarms(scenario, episodes), {}
    farms.reset(EVALUATION_SEED)  # FarmEnv.reset accepts only seeds of trainings
    while len(records) < episodes:
        rows = {"observation": torch.as_tensor(farms.buffers["features"][:, 0]),
                "action_mask": torch.as_tensor(action_mask(farms.buffers["legal"][:, 0]))}
        logits = module.forward_inference({Columns.OBS: rows})[Columns.ACTION_DIST_INPUTS]
        farms.step(logits.argmax(-1).numpy().astype(np.uint8)[:, None])
        over = farms.buffers["end_reasons"] != 0
        if over.any():
            for one in farms.finished():
                records.setdefault(one["farm"], one)
            farms.start_next(over)
    return (np.mean([one["episode_return"] for one in records.values()]),
            np.mean([one["success"] for one in records.values()]))


def main(scenario="paper", steps=1_000_000, seed=1, workers=0, farms=16, episodes=50):
    """Trains and evaluates; returns (mean return, success rate). workers: number of processes that
    step farms; 0 if the farms step in this process."""
    register_env("farm", make_env)
    config = (PPOConfig().environment("farm", env_config={"scenario": scenario})
              .env_runners(num_env_runners=workers, num_envs_per_env_runner=farms)
              .rl_module(rl_module_spec=RLModuleSpec(module_class=MaskedModule))
              .training(gamma=GAMMA, lambda_=0.95, lr=[[0, 1e-3], [steps, 0.0]],
                        entropy_coeff=[[0, 0.02], [steps, 0.0]], train_batch_size=BATCH,
                        minibatch_size=512, num_epochs=2, vf_clip_param=1e6)
              .debugging(seed=seed))
    algorithm, began, played = config.build_algo(), time.monotonic(), 0
    while played < steps:
        result = algorithm.train()["env_runners"]
        played = int(result["num_env_steps_sampled_lifetime"])
        print(f"{played:>9,} steps  {played / (time.monotonic() - began):>6,.0f} steps/s  return "
              f"{result.get('episode_return_mean', np.nan) / REWARD_SCALE:8.1f}", flush=True)
    mean, success = evaluate(algorithm.get_module(), scenario, episodes)
    algorithm.stop()
    print(f"{scenario}: mean return {mean:.1f}, success {100 * success:.0f} % in {episodes} greedy "
          "episodes")
    return mean, success


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--steps", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=0)
    given = parser.parse_args()
    main(given.scenario, given.steps, given.seed, given.workers)
