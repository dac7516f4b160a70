# SPDX-License-Identifier: BSD-3-Clause
"""Tests every registered id of aquafarm_gym as Gymnasium's tests/envs/test_envs.py tests its own
environments: check_env gives no warning, two rollouts with the same seed are equal, an unpickled
copy continues like the original, and the render modes rgb_array and ansi return a picture and a
text. Also tests specs and wrappers."""
import pickle
import warnings

import aquafarm_gym
import gymnasium
import numpy as np
from gymnasium import wrappers
from gymnasium.utils.env_checker import check_env, data_equivalence

STEPS = 50


def check_rollout(make):
    """Tests that two environments with the same seed give the same results."""
    pair = [make(), make()]
    assert data_equivalence(*(env.reset(seed=0) for env in pair))
    pair[0].action_space.seed(0)
    for _ in range(STEPS):
        action = pair[0].action_space.sample()
        one, other = (env.step(action) for env in pair)
        assert data_equivalence(one, other)
        assert pair[0].observation_space.contains(one[0])
        if one[2] or one[3]:
            assert data_equivalence(*(env.reset(seed=0) for env in pair))


def check_pictures(name):
    """Tests that rgb_array and ansi return a picture and a text, at the start and after a step."""
    modes = gymnasium.make(name).metadata["render_modes"]
    assert {"rgb_array", "ansi", "human"} == set(modes), modes
    for mode in ("rgb_array", "ansi"):
        env = gymnasium.make(name, render_mode=mode)
        env.reset(seed=1)
        for _ in range(2):
            shown = env.render()
            if mode == "ansi":
                assert isinstance(shown, str) and shown, name
            else:
                assert (shown.dtype, shown.shape) == (np.uint8, (640, 800, 3)) and shown.std(), name
            env.step(env.action_space.sample())


def check_pickle(env):
    """Tests that an environment and its unpickled copy give the same results."""
    env.reset(seed=3)
    other = pickle.loads(pickle.dumps(env))
    for _ in range(STEPS):
        action = env.action_space.sample()
        one = env.step(action)
        assert data_equivalence(one, other.step(action))
        if one[2] or one[3]:
            assert data_equivalence(env.reset(), other.reset())


ids = [name for name in gymnasium.registry if name.startswith("aquafarm/")]
assert len(ids) > 5, ids
for name in ids:
    tables = aquafarm_gym.LocalFarms(gymnasium.spec(name).kwargs["scenario"]).state_count
    for observation in ("features", "planes", *(["index"] if tables else [])):
        def make(**more):
            return gymnasium.make(name, observation=observation, **more)

        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(make(render_mode="ansi", disable_env_checker=True).unwrapped)
        check_rollout(make)
        check_pickle(make())
        env = make()
        spec = gymnasium.envs.registration.EnvSpec.from_json(env.spec.to_json())
        assert gymnasium.make(spec).spec == env.spec, name
try:
    import aquafarm_core.pictures  # noqa: F401
except ImportError as error:  # a wheel without OpenCV
    print(f"no pictures: {error}")
    assert set(gymnasium.make(ids[0]).metadata["render_modes"]) == {"ansi", "human"}
else:
    for name in ids:
        check_pictures(name)

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
