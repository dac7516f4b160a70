# SPDX-License-Identifier: BSD-3-Clause
"""Runs PettingZoo's api, parallel api, seed, max_cycles and render tests. Also tests that state()
is in state_space."""
import types

import aquafarm_core as core
import aquafarm_gym
from pettingzoo.test import (api_test, max_cycles_test, parallel_api_test, parallel_seed_test,
                             render_test, seed_test)
from pettingzoo.utils import parallel_to_aec


def with_limit(max_cycles):
    """Returns an environment of two_squads with the step limit `max_cycles`."""
    text = aquafarm_gym.find_scenario("two_squads").yaml
    limit = aquafarm_gym.find_scenario("two_squads").step_limit
    changed = text.replace(f"step_limit: {limit}", f"step_limit: {max_cycles}")
    assert changed != text
    return aquafarm_gym.FarmParallelEnv(core.Scenario.parse(changed, "limited"))


for scenario in ("two_squads", "four_squads", "smart_devices", "networked_devices"):
    for observation in ("features", "planes"):
        def make(render_mode=None):
            return aquafarm_gym.FarmParallelEnv(scenario, observation, render_mode=render_mode)

        parallel_api_test(make(), 300)
        parallel_seed_test(make, 100)
        api_test(parallel_to_aec(make()), 300)
        seed_test(lambda: parallel_to_aec(make()), 100)
        render_test(lambda render_mode=None: parallel_to_aec(make(render_mode)))
max_cycles_test(types.SimpleNamespace(
    parallel_env=with_limit, env=lambda max_cycles: parallel_to_aec(with_limit(max_cycles))))
env = aquafarm_gym.FarmParallelEnv("two_squads")
env.reset(seed=1)
assert env.state_space.contains(env.state())
