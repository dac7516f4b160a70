#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the checks of Gymnasium and PettingZoo, and compares steps in process and through ROS.

Runs in the virtual environment given by --venv (venv_tools.py).
"""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import unittest

from venv_tools import enter_venv, run_tests

HERE = pathlib.Path(__file__).resolve().parent

WHY_NOT = enter_venv()

if not WHY_NOT:
    import aquafarm_core as core
    import aquafarm_gym
    import gymnasium
    import numpy as np
    from aquafarm_gym import FarmEnv, FarmParallelEnv, FarmVectorEnv, RosFarms
    from aquafarm_gym.farms import LocalFarms
    from gymnasium.utils.env_checker import check_env, data_equivalence
    from pettingzoo.test import parallel_api_test, parallel_seed_test

REEF = str(HERE / "data" / "reef.yaml")


@unittest.skipIf(WHY_NOT, WHY_NOT)
class GymTest(unittest.TestCase):
    def test_gymnasiums_own_check_passes(self):
        for observation in ("index", "features", "planes"):
            check_env(FarmEnv("paper", observation))
        env = gymnasium.make("aquafarm/Farm-v1", scenario="procedural")
        self.assertTrue(env.observation_space.contains(env.reset(seed=1)[0]))

    def test_pettingzoos_own_checks_pass(self):
        for scenario in ("two_squads", REEF):
            for observation in ("index", "features", "planes"):
                parallel_api_test(FarmParallelEnv(scenario, observation), 500)
                parallel_seed_test(lambda: FarmParallelEnv(scenario, observation), 200)

    def test_both_own_checks_pass_through_ros(self):
        check_env(FarmEnv(farms=RosFarms("/ranch")))
        parallel_api_test(FarmParallelEnv(farms=RosFarms("/reef")), 300)
        names = iter(["/reef", "/other_reef"])
        parallel_seed_test(lambda: FarmParallelEnv(farms=RosFarms(next(names))))

    def test_one_ship_plays_the_same_in_process_and_through_ros(self):
        for observation in ("index", "features", "planes"):
            local = FarmEnv("paper", observation)
            ros = FarmEnv(observation=observation, farms=RosFarms("/ranch", 1, observation))
            self.assertEqual(local.observation_space, ros.observation_space)
            self.assert_same(local.reset(seed=3), ros.reset(seed=3))
            for action in np.random.default_rng(1).integers(0, 10, 400):
                one = local.step(action)
                self.assert_same(one, ros.step(action))
                if one[2] or one[3]:
                    self.assert_same(local.reset(), ros.reset())

    def test_several_agents_play_the_same_in_process_and_through_ros_also_when_some_end(self):
        local = FarmParallelEnv(REEF)
        ros = FarmParallelEnv(farms=RosFarms("/reef"))
        self.assert_same(local.reset(seed=1), ros.reset(seed=1))
        rng = np.random.default_rng(2)
        early = 0
        for _ in range(3000):
            actions = {agent: int(rng.integers(10)) for agent in local.agents}
            one = local.step(actions)
            self.assert_same(one, ros.step(actions))
            self.assertEqual(local.agents, ros.agents)
            if not local.agents:
                self.assert_same(local.reset(), ros.reset())
            elif len(local.agents) < len(actions):
                early += 1
                self.assertTrue(set(actions) - set(local.agents) <= {"ship_1", "ship_2"})
        self.assertGreater(early, 3)

    def test_many_farms_are_the_same_in_process_and_through_ros_and_one_by_one(self):
        local = FarmVectorEnv(8, "paper")
        ros = FarmVectorEnv(farms=RosFarms("/ranch", 8))
        single = FarmEnv("paper")
        self.assert_same(local.reset(seed=9), ros.reset(seed=9))
        np.testing.assert_array_equal(single.reset(seed=9)[0], local.reset(seed=9)[0][0])
        ros.reset(seed=9)
        for actions in np.random.default_rng(3).integers(0, 10, (1200, 8)):
            one = local.step(actions)
            self.assert_same(one, ros.step(actions))
            if one[4]["is_first"][0]:
                alone = single.reset(options={"episode": single._episodes.episode + 8})[0]
            else:
                alone, reward, *_ = single.step(actions[0])
                self.assertEqual(reward, one[1][0])
            np.testing.assert_array_equal(alone, one[0][0])

    def test_a_step_limit_truncates_and_all_else_terminates(self):
        paper = core.Scenario.load(f"{core.SCENARIO_FOLDER}/paper.yaml").yaml
        reef = core.Scenario.load(REEF).yaml
        for step_limit, limited in ((40, True), (100000, False)):
            one, two = (core.Scenario.parse(re.sub("step_limit: [0-9]+",
                                                   f"step_limit: {step_limit}", text))
                        for text in (paper, reef))
            self.check_ends_of_many(FarmVectorEnv(16, one), limited)
            rng = np.random.default_rng(4)
            single, pair = FarmEnv(one), FarmParallelEnv(two)
            single.reset(seed=1)
            ends = (False, False)
            while not any(ends):
                *_, terminated, truncated, info = single.step(int(rng.integers(10)))
                ends = terminated, truncated
            self.assertEqual(ends, (not limited, limited))
            self.assertEqual(info["reason"] == core.STEP_LIMIT, limited)
            pair.reset(seed=1)
            while pair.agents:
                _, _, terminated, truncated, infos = pair.step(
                    {agent: int(rng.integers(10)) for agent in pair.agents})
            self.assertEqual(any(truncated.values()), limited)
            for agent, info in infos.items():
                self.assertNotEqual(terminated[agent], truncated[agent])
                self.assertEqual(info["reason"] == core.STEP_LIMIT, limited)

    def check_ends_of_many(self, env, limited):
        rng = np.random.default_rng(4)
        env.reset(seed=1)
        before, ended = np.zeros(env.num_envs, bool), 0
        while ended < env.num_envs:
            _, rewards, terminated, truncated, infos = env.step(rng.integers(0, 10,
                                                                                env.num_envs))
            np.testing.assert_array_equal(infos["is_first"], before)  # begins in the next step
            self.assertFalse(rewards[before].any() or (terminated | truncated)[before].any())
            before = terminated | truncated
            self.assertFalse((terminated if limited else truncated).any())
            np.testing.assert_array_equal(infos["_summary"], before)
            np.testing.assert_array_equal(infos["summary"]["reason"] != 0, before)
            reasons = infos["reason"][before]
            self.assertTrue(((reasons == core.STEP_LIMIT) == limited).all())
            ended += len(reasons)

    def test_resets_of_many_farms_play_no_episode_twice(self):
        env = FarmVectorEnv(4, "paper")
        env.reset(seed=1)
        rng = np.random.default_rng(5)
        played = []
        for i in range(6000):
            infos = env.step(rng.integers(0, 10, 4))[4]
            ended = {name: infos["summary"][name][infos["_summary"]] for name in infos["summary"]}
            played += list(zip(ended["seed"].tolist(), ended["episode"].tolist()))
            if i % 1999 == 1998:
                env.reset()
        self.assertGreater(len(played), 8)
        self.assertEqual(len(played), len(set(played)))

    def test_an_array_that_is_not_copied_is_the_farms_own(self):
        env = FarmVectorEnv(4, "paper", copy=False)
        first = env.reset(seed=1)[0]
        self.assertIs(first.base, env.farms.buffers["features"])
        self.assertIs(env.step(np.zeros(4, int))[0].base, first.base)

    def test_what_does_not_fit_is_refused_in_one_line(self):
        def step_unknown_ship():
            env = FarmParallelEnv()
            env.reset(seed=1)
            env.step({"ship_7": 0})

        for call, words in (
                (lambda: FarmEnv("papre"), "scenario: got 'papre', expected an "
                 "aquafarm_core.Scenario, a file or one of: .*paper, paper_partial, paper_plain, partial, "),
                (lambda: FarmEnv("two_squads"), "scenario two_squads: got 2 agents, expected 1"),
                (lambda: FarmEnv(observation="pixels"), "observation: got 'pixels', expected one"),
                (lambda: FarmEnv(observation="planes", farms=LocalFarms()), "observation: got "
                 "'planes', expected one that these farms write: features"),
                (lambda: FarmEnv().step(10), "action: got 10, expected a whole number in"),
                (lambda: FarmVectorEnv(2).step(np.array([0, 10])), "actions: got 0 to 10, "),
                (lambda: FarmVectorEnv(2).step(np.array([0])), r"actions: got int64 \[1\], "),
                (lambda: FarmParallelEnv().step({"ship_0": 0}), "step: the episode is over; "),
                (step_unknown_ship, r"actions: got the agents \['ship_7"),
                (lambda: RosFarms("/ranch", 5000).reset(1), "sim node: reset refused: ")):
            with self.assertRaisesRegex(ValueError, f"^{words}"):
                call()
        with self.assertRaisesRegex(ConnectionError, "^sim node: no answer from /nowhere/get_state"
                                    " for 0.5 s"):
            RosFarms("/nowhere", wait_limit_s=0.5)

    def test_farms_that_another_client_reset_refuse_a_step(self):
        mine, other = RosFarms("/ranch"), RosFarms("/ranch")
        north = np.zeros((1, 1), np.uint8)
        mine.reset(1)
        mine.step(north)
        other.reset(2)
        with self.assertRaisesRegex(ConnectionError,
                                    "^sim node: its farms changed .* reset to continue"):
            mine.step(north)
        with self.assertRaisesRegex(ValueError, "^step: got no reset before, expected one"):
            mine.step(north)
        mine.reset(1)
        mine.step(north)

    def test_no_master_is_said_at_once(self):
        code = ("from aquafarm_gym import RosFarms\n"
                "try:\n    RosFarms()\nexcept ConnectionError as error:\n    print(error)")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              timeout=60, check=True,
                              env={**os.environ, "ROS_MASTER_URI": "http://localhost:9"})
        self.assertRegex(done.stdout, "^no ROS master at http://localhost:9: ")

    def test_the_example_trains_with_stable_baselines3(self):
        for name in ("torch", "pandas"):
            if importlib.util.find_spec(name) is None:
                self.skipTest(f"there is no {name}: apt-get install python3-{name}")
        path = HERE.parent / "examples" / "train_sb3.py"
        spec = importlib.util.spec_from_file_location("train_sb3", path)
        example = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(example)
        self.assertGreater(example.main(example.STEPS), 80)

    def assert_same(self, one, other):
        """Compares nested structures of arrays bit by bit."""
        self.assertTrue(data_equivalence(one, other, exact=True), f"{one}\n{other}")


if __name__ == "__main__":
    run_tests("gym", GymTest, WHY_NOT)
