# SPDX-License-Identifier: BSD-3-Clause
"""Runs one iteration of RLlib's PPO."""
import aquafarm_gym
from ray.rllib.algorithms.ppo import PPOConfig
from ray.tune.registry import register_env

register_env("farm", lambda config: aquafarm_gym.FarmEnv())
config = (PPOConfig().environment("farm").env_runners(num_env_runners=0)
          .training(train_batch_size=500, minibatch_size=100, num_epochs=1))
assert config.build_algo().train()["training_iteration"] == 1
