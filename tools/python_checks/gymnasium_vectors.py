# SPDX-License-Identifier: BSD-3-Clause
"""Tests Gymnasium's vector wrappers, and Sync and Async vectors of unseeded environments."""
import aquafarm_gym
import gymnasium
from gymnasium.wrappers import vector as wrappers

for mode in gymnasium.vector.AutoresetMode:
    envs = gymnasium.make_vec("aquafarm/Paper-v1", num_envs=4, autoreset_mode=mode)
    assert envs.metadata["autoreset_mode"] == mode
    if mode == gymnasium.vector.AutoresetMode.DISABLED:
        continue
    envs = wrappers.RecordEpisodeStatistics(envs)
    if mode == gymnasium.vector.AutoresetMode.NEXT_STEP:  # these wrappers reject SAME_STEP
        envs = wrappers.NormalizeReward(wrappers.NormalizeObservation(envs))
    envs.reset(seed=1)
    ended = 0
    for _ in range(3000):
        infos = envs.step(envs.action_space.sample())[4]
        ended += infos["_episode"].sum() if "_episode" in infos else 0
    assert ended > 4, (mode, ended)
for kind in (gymnasium.vector.SyncVectorEnv, gymnasium.vector.AsyncVectorEnv):
    envs = kind([aquafarm_gym.FarmEnv] * 4)
    envs.reset()
    ended = 0
    for _ in range(3000):
        ended += (envs.step(envs.action_space.sample())[4]["reason"] != 0).sum()
    envs.close()
    assert ended > 4, (kind, ended)
