# SPDX-License-Identifier: BSD-3-Clause
"""Tests SuperSuit's vector environments and wrappers with several ships."""
import aquafarm_gym
import numpy as np
import supersuit

env = aquafarm_gym.FarmParallelEnv("two_squads")
# agent_indicator_v0 is left out. SuperSuit 3.11 limits the indicator to the min upper bound of the
# space but sets it to the max upper bound. If the bounds differ, the space does not contain it.
for wrap in (lambda e: supersuit.black_death_v3(e), lambda e: supersuit.pad_observations_v0(e),
             lambda e: supersuit.dtype_v0(e, np.float64), lambda e: supersuit.frame_stack_v2(e, 3)):
    wrapped = wrap(aquafarm_gym.FarmParallelEnv("two_squads"))
    observations = wrapped.reset(seed=1)[0]
    for _ in range(20):
        actions = {a: wrapped.action_space(a).sample() for a in wrapped.agents}
        observations, *_ = wrapped.step(actions)
    assert all(wrapped.observation_space(a).contains(o) for a, o in observations.items()), wrapped
single = supersuit.pettingzoo_env_to_vec_env_v1(supersuit.black_death_v3(env))
envs = supersuit.concat_vec_envs_v1(single, 3, num_cpus=0, base_class="gymnasium")
seen, _ = envs.reset(seed=1)
assert seen.shape[0] == 6, seen.shape
for _ in range(300):
    seen, rewards, *_ = envs.step(np.random.default_rng(1).integers(0, 10, 6))
assert np.isfinite(rewards).all()
