# SPDX-License-Identifier: BSD-3-Clause
"""Tests Stable-Baselines3 with farms: check_env, PPO and DQN with FarmVecEnv, MaskablePPO if
sb3_contrib is installed, and saved models as policies of aquafarm's programs
(policy:=model.zip)."""
import importlib.util
import pathlib
import sys
import tempfile

import aquafarm_core
import aquafarm_gym
import numpy as np
from stable_baselines3 import DQN, PPO
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "aquafarm_agents/scripts"))
import serve_policy  # noqa: E402


def check_served(trained, is_masked=False):
    """Tests that serve_policy.py, with which the programs play saved models, chooses the same
    actions as the model."""
    with tempfile.TemporaryDirectory() as folder:
        trained.save(f"{folder}/model.zip")
        kind, act = serve_policy.load(f"{folder}/model.zip")
    assert kind == "features", kind
    seen, masks = envs.reset(), envs.action_masks()
    bits = np.packbits(masks, axis=1, bitorder="little")
    options = {"action_masks": masks} if is_masked else {}
    expected = trained.predict(seen, deterministic=True, **options)[0]
    served = serve_policy.choose(act, kind, [seen.shape[1], 1, 1], seen.tobytes(), bits.tobytes())
    np.testing.assert_array_equal(np.frombuffer(served, np.uint8), expected)


for observation in ("features", "index"):
    check_env(aquafarm_gym.FarmEnv(observation=observation))
paper = aquafarm_gym.find_scenario("paper")
short = aquafarm_core.Scenario.parse(
    paper.yaml.replace(f"step_limit: {paper.step_limit}", "step_limit: 50"), "short")
envs = aquafarm_gym.FarmVecEnv(16, short)
model = PPO("MlpPolicy", envs, n_steps=64, batch_size=256, seed=1).learn(4096)
evaluate_policy(model, envs, 2, deterministic=False)
check_served(model)
check_served(DQN("MlpPolicy", envs, learning_starts=100, buffer_size=5000, seed=1).learn(1000))
if importlib.util.find_spec("sb3_contrib"):
    from sb3_contrib import MaskablePPO

    learner = MaskablePPO("MlpPolicy", envs, n_steps=64, batch_size=256, seed=1).learn(4096)
    check_served(learner, is_masked=True)
    assert len(learner.ep_info_buffer) > 0, "no episode ended"
