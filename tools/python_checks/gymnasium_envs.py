# SPDX-License-Identifier: BSD-3-Clause
"""Runs Gymnasium's check_env on every id and observation type, and tests specs and wrappers."""
import aquafarm_gym
import gymnasium
import numpy as np
from gymnasium import wrappers
from gymnasium.utils.env_checker import check_env

ids = [name for name in gymnasium.registry if name.startswith("aquafarm/")]
assert len(ids) > 5, ids
for name in ids:
    for observation in ("features", "planes", "index"):
        kwargs = {"observation": observation, "render_mode": "ansi"}
        if observation == "index" and aquafarm_gym.LocalFarms(
                gymnasium.spec(name).kwargs["scenario"]).state_count == 0:
            continue
        env = gymnasium.make(name, **kwargs)
        check_env(env.unwrapped)
        spec = gymnasium.envs.registration.EnvSpec.from_json(env.spec.to_json())
        assert gymnasium.make(spec).spec == env.spec, name

env = gymnasium.make("aquafarm/Paper-v1")
env = wrappers.RescaleObservation(env, np.float32(-1), np.float32(1))
env = wrappers.RecordEpisodeStatistics(wrappers.NormalizeReward(wrappers.FrameStackObservation(
    wrappers.TimeLimit(env, 50), 2)))
env.reset(seed=1)
for _ in range(200):
    _, _, terminated, truncated, info = env.step(env.action_space.sample())
    if terminated or truncated:
        assert info["episode"]["l"] <= 50
        env.reset()
