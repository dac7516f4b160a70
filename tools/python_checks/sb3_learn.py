# SPDX-License-Identifier: BSD-3-Clause
"""Tests Stable-Baselines3: check_env, PPO with FarmVecEnv, and MaskablePPO with sb3_contrib."""
import importlib.util

import aquafarm_core
import aquafarm_gym
from stable_baselines3 import DQN, PPO
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy

for observation in ("features", "index"):
    check_env(aquafarm_gym.FarmEnv(observation=observation))
paper = aquafarm_gym.find_scenario("paper")
short = aquafarm_core.Scenario.parse(
    paper.yaml.replace(f"step_limit: {paper.step_limit}", "step_limit: 50"), "short")
envs = aquafarm_gym.FarmVecEnv(16, short)
model = PPO("MlpPolicy", envs, n_steps=64, batch_size=256, seed=1).learn(4096)
evaluate_policy(model, envs, 2, deterministic=False)
DQN("MlpPolicy", envs, learning_starts=100, buffer_size=5000, seed=1).learn(1000)
if importlib.util.find_spec("sb3_contrib"):
    from sb3_contrib import MaskablePPO

    learner = MaskablePPO("MlpPolicy", envs, n_steps=64, batch_size=256, seed=1).learn(4096)
    assert len(learner.ep_info_buffer) > 0, "no episode ended"
