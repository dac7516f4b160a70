# SPDX-License-Identifier: BSD-3-Clause
"""Plays three episodes in tianshou's vector environment and stores the steps, with their infos, in
its replay buffer."""
import aquafarm_gym
from tianshou.data import Batch, VectorReplayBuffer
from tianshou.env import DummyVectorEnv

envs = DummyVectorEnv([aquafarm_gym.FarmEnv for _ in range(2)])
envs.seed(1)
space = envs.action_space[0]
observations, infos = envs.reset()
buffer = VectorReplayBuffer(20000, 2)
ended = 0
while ended < 3:
    actions = [space.sample() for _ in range(2)]
    after, rewards, terminated, truncated, infos = envs.step(actions)
    buffer.add(Batch(obs=observations, act=actions, rew=rewards, terminated=terminated,
                     truncated=truncated, obs_next=after, info=infos))
    observations = after
    over = (terminated | truncated).nonzero()[0]
    ended += len(over)
    if len(over):
        observations[over] = envs.reset(over)[0]
assert len(buffer) > 0
