# SPDX-License-Identifier: BSD-3-Clause
"""Records episodes with Minari and recovers the environment. Tests that the recorded actions give
the recorded observations and rewards again."""
import os
import tempfile

os.environ["MINARI_DATASETS_PATH"] = tempfile.mkdtemp()

import aquafarm_gym  # noqa: E402, F401
import gymnasium  # noqa: E402
import minari  # noqa: E402
import numpy as np  # noqa: E402

env = minari.DataCollector(gymnasium.make("aquafarm/Paper-v1", max_episode_steps=200),
                           record_infos=True)
for episode in range(3):
    env.reset(seed=episode)
    env.action_space.seed(episode)
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(env.action_space.sample())
        over = terminated or truncated
dataset = env.create_dataset(dataset_id="aquafarm/check-v0", algorithm_name="random",
                             author="aquafarm", author_email="maintainers@aquafarm.invalid",
                             code_permalink="https://aquafarm.invalid",
                             description="A check of recording.")
again = minari.load_dataset("aquafarm/check-v0")
recovered = again.recover_environment()
assert recovered.spec.id == "aquafarm/Paper-v1", recovered.spec
for number, episode in enumerate(again.iterate_episodes()):
    first, _ = recovered.reset(seed=number)
    np.testing.assert_array_equal(first, episode.observations[0])
    for action, reward, after in zip(episode.actions, episode.rewards, episode.observations[1:]):
        seen, found, *_ = recovered.step(action)
        assert found == reward
        np.testing.assert_array_equal(seen, after)
    assert "outcome" in episode.infos
