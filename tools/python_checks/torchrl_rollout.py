# SPDX-License-Identifier: BSD-3-Clause
"""Tests the specs of one farm in TorchRL and runs a rollout of 100 steps."""
import aquafarm_gym
from torchrl.envs import GymWrapper
from torchrl.envs.utils import check_env_specs

env = GymWrapper(aquafarm_gym.FarmEnv())
check_env_specs(env)
assert env.rollout(100, break_when_any_done=False).shape[0] == 100
