# SPDX-License-Identifier: BSD-3-Clause
"""Tests vector environments as Gymnasium's own tests of vectors and autoreset modes do:
SyncVectorEnv and AsyncVectorEnv give the same results in the modes NEXT_STEP and SAME_STEP, and a
masked reset resets only the selected farms and refuses wrong masks. Also tests vector wrappers, and
vectors that were reset without a seed."""
import aquafarm_gym
import gymnasium
import numpy as np
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import vector as wrappers

PAPER = aquafarm_gym.find_scenario("paper")
SHORT = PAPER.yaml.replace(f"step_limit: {PAPER.step_limit}", "step_limit: 20")
assert SHORT != PAPER.yaml


def make():
    return aquafarm_gym.FarmEnv(SHORT)


def check_equal_vectors(mode, shared_memory):
    """Tests that SyncVectorEnv and AsyncVectorEnv give equal observations, rewards, ends and
    infos."""
    vectors = [SyncVectorEnv([make] * 4, autoreset_mode=mode),
               AsyncVectorEnv([make] * 4, autoreset_mode=mode, shared_memory=shared_memory)]
    assert data_equivalence(*(one.reset(seed=0) for one in vectors))
    for _ in range(100):
        actions = vectors[0].action_space.sample()
        assert data_equivalence(*(one.step(actions) for one in vectors)), (mode, shared_memory)
    for one in vectors:
        one.close()


def check_masked_reset(make_vector):
    """Tests that a reset with reset_mask resets only the selected farms and refuses wrong masks."""
    envs = make_vector()
    first, _ = envs.reset(seed=[0, 1, 2])
    for _ in range(3):
        last = envs.step(np.array([0, 1, 2]))[0]
    mask = np.array([True, True, False])
    after, _ = envs.reset(seed=[0, 1, 0], options={"reset_mask": mask})
    np.testing.assert_array_equal(after[:2], first[:2])
    np.testing.assert_array_equal(after[2], last[2])
    for wrong in ([True], [True] * 4, [[True] * 3], [1, 1, 0], [1.0, 1.0, 0.0]):
        try:
            envs.reset(options={"reset_mask": np.array(wrong)})
        except (AssertionError, TypeError, ValueError):
            continue
        raise AssertionError(f"{make_vector}: accepted the mask {wrong}")
    envs.close()


for mode in (AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP):
    for shared_memory in (True, False):
        check_equal_vectors(mode, shared_memory)
for make_vector in (
        lambda: SyncVectorEnv([make] * 3, autoreset_mode=AutoresetMode.DISABLED),
        lambda: aquafarm_gym.FarmVectorEnv(3, SHORT, autoreset_mode=AutoresetMode.DISABLED)):
    check_masked_reset(make_vector)
for mode in AutoresetMode:
    envs = gymnasium.make_vec("aquafarm/Paper-v1", num_envs=4, autoreset_mode=mode)
    assert envs.metadata["autoreset_mode"] == mode
    if mode == AutoresetMode.DISABLED:
        continue
    envs = wrappers.RecordEpisodeStatistics(envs)
    if mode == AutoresetMode.NEXT_STEP:  # NormalizeObservation rejects SAME_STEP
        envs = wrappers.NormalizeReward(wrappers.NormalizeObservation(envs))
    envs.reset(seed=1)
    ended = 0
    for _ in range(3000):
        infos = envs.step(envs.action_space.sample())[4]
        ended += infos["_episode"].sum() if "_episode" in infos else 0
    assert ended > 4, (mode, ended)
for kind in (SyncVectorEnv, AsyncVectorEnv):
    envs = kind([aquafarm_gym.FarmEnv] * 4)
    envs.reset()
    ended = 0
    for _ in range(3000):
        ended += (envs.step(envs.action_space.sample())[4]["reason"] != 0).sum()
    envs.close()
    assert ended > 4, (kind, ended)
