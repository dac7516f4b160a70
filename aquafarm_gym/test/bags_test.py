#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the conversion of bags to Minari datasets. tools/check_python runs this file.

It needs rosbags and minari (pip install './aquafarm_gym[bags]').
"""
import contextlib
import io
import os
import pathlib
import sys
import tempfile
import types
import unittest
import warnings

os.environ["MINARI_DATASETS_PATH"] = tempfile.mkdtemp()

import aquafarm_gym
import minari
import numpy as np
from aquafarm_gym import bags

BAG = str(pathlib.Path(__file__).resolve().parents[2]
          / "aquafarm_sim" / "test" / "data" / "version_0_1_0.bag")


def played(scenario, steps, seed=5, episode=3):
    """Returns an episode of random actions as a bag would contain it."""
    scenario = aquafarm_gym.find_scenario(scenario)
    farms = aquafarm_gym.LocalFarms(scenario, 1, hashes=True)
    farms.reset(seed, episode)
    buffers, rng = farms.buffers, np.random.default_rng(1)
    kept = bags.Recorded(scenario, "x.bag: episode 3", seed, episode, [[10] * farms.agents],
                         [[np.float32(0)] * farms.agents], [int(buffers["hashes"][0])], [0])
    for _ in range(steps):
        actions = rng.integers(0, 10, (1, farms.agents)).astype(np.uint8)
        farms.step(actions)
        kept.actions.append(actions[0].tolist())
        kept.rewards.append(list(buffers["rewards"][0].copy()))
        kept.hashes.append(int(buffers["hashes"][0]))
        kept.reasons.append(int(buffers["end_reasons"][0]))
    return kept


class BagsTest(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")  # Minari recommends authors and links

    def test_a_bag_of_the_first_version_becomes_a_dataset(self):
        dataset = bags.make_dataset("aquafarm/tiny-v0", [BAG, BAG])
        self.assertEqual((dataset.total_episodes, dataset.total_steps), (2, 16))
        again = minari.load_dataset("aquafarm/tiny-v0")
        episode = again[0]
        np.testing.assert_array_equal(episode.actions, [1, 7, 7, 8, 0, 4, 4, 9])
        self.assertTrue(episode.terminations[-1])
        env = again.recover_environment().unwrapped
        self.assertEqual(env.farms.name, "tiny")
        # Seeds of evaluations are larger than env.reset accepts, so the farms are reset directly.
        recorded = next(bags.read_episodes(BAG))
        env.reset(seed=1)
        env.farms.reset(recorded.seed, recorded.episode)
        for k, action in enumerate(episode.actions):
            np.testing.assert_array_equal(env._observe(), episode.observations[k])
            _, reward, terminated, _, info = env.step(action)
            self.assertEqual((reward, terminated), (episode.rewards[k], episode.terminations[k]))
            np.testing.assert_array_equal(info["action_mask"], episode.infos["action_mask"][k + 1])

    def test_each_ship_gives_an_episode(self):
        recorded = played("two_squads", 30)
        for observation in ("features", "planes"):
            ships = bags.replay(recorded, observation)
            self.assertEqual(len(ships), 2)
            for number, one in enumerate(ships):
                self.assertEqual(len(one.observations), 31)
                np.testing.assert_array_equal(one.actions,
                                              [step[number] for step in recorded.actions[1:]])
                self.assertTrue(one.truncations[-1])  # the recording ends within the episode
                self.assertFalse(one.terminations.any())
        self.assertTrue((ships[0].observations != ships[1].observations).any())

    def test_a_difference_from_the_bag_is_refused_in_one_line(self):
        reward, hashed, reason, changed = (played("paper", 12) for _ in range(4))
        reward.rewards[7][0] += np.float32(0.5)
        hashed.hashes[0] ^= 1
        reason.reasons[12] = 3
        changed.is_changed = True
        for one, words in ((reward, "step 7: rewards: got "), (hashed, "step 0: hash: got "),
                           (reason, "step 12: reason: got 0 in the replay, expected 3; "),
                           (changed, "got changes from outside")):
            with self.assertRaisesRegex(ValueError, f"^x.bag: episode 3: {words}"):
                bags.replay(one)

    def test_a_change_at_step_0_is_kept_and_an_episode_is_yielded_once(self):
        spec = types.SimpleNamespace(scenario_yaml=aquafarm_gym.find_scenario("paper").yaml,
                                     scenario_name="paper")

        def taken(running, state_hash, episode=3):
            state = types.SimpleNamespace(step=0, seed=5, episode=episode, hash=state_hash,
                                          reason=0,
                                          ships=[types.SimpleNamespace(action=10, reward=0.0)])
            return list(bags._take(running, "/a", spec, state, "x.bag"))

        running = {}
        self.assertEqual(taken(running, 1) + taken(running, 1), [])  # published twice
        running["/a"].is_changed = True  # as a message saved_state does
        self.assertEqual(taken(running, 2), [])
        self.assertTrue(running["/a"].is_changed)
        before, = taken(running, 7, episode=4)
        self.assertEqual((before.episode, before.hashes), (3, [1]))
        self.assertFalse(running["/a"].is_changed)

    def test_the_command_says_what_is_wrong_in_one_line(self):
        with tempfile.NamedTemporaryFile(suffix=".bag") as other:
            other.write(b"no bag")
            other.flush()
            for path, words in ((other.name, "got no readable bag"), ("none.bag", "none.bag: ")):
                sys.argv = ["bags", "aquafarm/none-v0", path]
                with contextlib.redirect_stderr(io.StringIO()) as said:
                    self.assertEqual(bags.main(), 2)
                self.assertIn(words, said.getvalue())
                self.assertEqual(said.getvalue().count("\n"), 1)
        sys.argv = ["bags", "aquafarm/tiny-v1", BAG, "--observation", "index"]
        with contextlib.redirect_stdout(io.StringIO()) as said:
            self.assertEqual(bags.main(), 0)
        self.assertEqual(said.getvalue(), "aquafarm/tiny-v1: 1 episodes, 8 steps; the replay "
                         "reproduced every reward\n")


if __name__ == "__main__":
    unittest.main()
