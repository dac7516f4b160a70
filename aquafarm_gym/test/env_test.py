#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the Python environments without ROS: seeds, infos, autoreset, copies and rejected input.

Runs in the virtual environment given by --venv (venv_tools.py), or in the Python that starts it.
"""
import copy
import importlib.util
import pathlib
import pickle
import sys
import unittest

from venv_tools import enter_venv, run_tests

WHY_NOT = enter_venv()

if not WHY_NOT:
    import aquafarm_core as core
    import aquafarm_gym
    import gymnasium
    import numpy as np
    from aquafarm_gym import (ActionMaskInObservation, FarmEnv, FarmParallelEnv, FarmVectorEnv,
                              TeamVectorEnv, VectorActionMaskInObservation, spaces)
    from gymnasium.utils.env_checker import data_equivalence

REEF = str(pathlib.Path(__file__).resolve().parent / "data" / "reef.yaml")
SHORT = 60  # step limit of farms with short episodes
MODES = ("NextStep", "SameStep", "Disabled")


def short_paper():
    """Returns paper.yaml with episodes of SHORT steps."""
    text = core.Scenario.load(f"{core.SCENARIO_FOLDER}/paper.yaml").yaml
    return core.Scenario.parse(text.replace("step_limit: 5000", f"step_limit: {SHORT}"), "short")


def has(name):
    """Returns whether a package is installed."""
    return importlib.util.find_spec(name) is not None


@unittest.skipIf(WHY_NOT, WHY_NOT)
class EnvTest(unittest.TestCase):
    def assert_same(self, one, other):
        self.assertTrue(data_equivalence(one, other, exact=True), f"{one}\n{other}")

    def test_drawn_seeds_fit_a_signed_64_bit_number(self):
        for _ in range(20):  # NumPy draws 128 bits, so most seeds need the limit
            for env in (FarmEnv(), FarmVectorEnv(2), FarmParallelEnv()):
                env.reset()
                self.assertTrue(0 <= env._episodes.seed < 2**63, env._episodes.seed)

    def test_unseeded_vectors_of_single_environments_play_past_an_episodes_end(self):
        envs = gymnasium.vector.SyncVectorEnv([lambda: FarmEnv(short_paper())] * 8)
        envs.reset()
        ended = 0
        for _ in range(2 * SHORT):
            infos = envs.step(envs.action_space.sample())[4]
            seeds = infos["summary"]["seed"]
            self.assertEqual(seeds.dtype, np.int64)
            ended += np.count_nonzero(infos["reason"])
        self.assertGreaterEqual(ended, 8)

    def test_every_observation_lies_within_its_space_and_the_bounds_are_finite(self):
        for path in sorted(pathlib.Path(core.SCENARIO_FOLDER).glob("*.yaml")):
            for observation in ("features", "planes"):
                env = TeamVectorEnv(4, str(path), observation)
                self.assertTrue(np.isfinite(env.observation_space.low).all())
                self.assertTrue(np.isfinite(env.observation_space.high).all())
                env.reset(seed=1)
                env.action_space.seed(1)
                for _ in range(200):
                    seen = env.step(env.action_space.sample())[0]
                    self.assertTrue(env.observation_space.contains(seen), path)

    def test_features_of_tokens_lie_within_their_space(self):
        scenario = core.Scenario.parse("""
name: tokens
grid: {width: 60, height: 60}
time: {step_limit: 100}
disasters: [{kind: typhoon, speed: 2, radii: [3, 9, 20]}]
view: {tokens: true}
""", "tokens")
        env = TeamVectorEnv(8, scenario, "features")
        self.assertTrue(np.isfinite(env.observation_space.high).all())
        seen, _ = env.reset(seed=1)
        env.action_space.seed(1)
        lowest, highest = seen.min(), seen.max()
        for _ in range(300):
            self.assertTrue(env.observation_space.contains(seen))
            seen = env.step(env.action_space.sample())[0]
            lowest, highest = min(lowest, seen.min()), max(highest, seen.max())
        self.assertLess(lowest, -1.0, "lengths go beyond the map's longer side")
        self.assertGreater(highest, 1.0)

    def test_kinds_grades_and_energy_lie_within_their_space(self):
        scenario = core.Scenario.parse("""
name: kinds
time: {step_limit: 60}
disasters:
  - {kind: red_tide, grade: 4, grade_factors: [0.5, 0.75, 1, 1.5], radii: [3, 9, 20]}
  - {kind: oil_spill, grade: 1}
damage: {exposure_damage: 0.001, kinds: {monitoring: {red_tide: 0}}}
energy: {weight: 0.1, per_km: 1, per_device: 0.5, rough_sea: 1, idle_per_step: 0.1}
view: {mode: partial, monitoring_radius: 4, kinds: true}
""", "kinds")
        env = TeamVectorEnv(4, scenario, "features")
        names = core.FarmBatch(scenario).feature_names
        self.assertEqual(14 + 12, sum(name.split(".")[-1] in spaces.KINDS or ".grade" in name
                                      for name in names))
        env.reset(seed=1)
        env.action_space.seed(1)
        for _ in range(200):
            seen = env.step(env.action_space.sample())[0]
            self.assertTrue(env.observation_space.contains(seen))

    def test_bad_kinds_are_refused_in_one_line(self):
        for keys, words in (
                ("damage: {kinds: {buoy: {wave: 2}}}",
                 "kinds:2: damage.kinds.buoy: unknown key 'buoy'; allowed: temporary_breeding, "
                 "monitoring, breeding_release, deep_water_breeding"),
                ("damage: {kinds: {monitoring: {wave: -1}}}",
                 "kinds:2: damage.kinds.monitoring.wave: got -1, expected [0, 100]"),
                ("view: {mode: partial, monitoring_radius: far}",
                 "kinds:2: view.monitoring_radius: got 'far', expected a number in [0, 1e+06]")):
            with self.assertRaises(ValueError) as refusal:
                core.Scenario.parse(f"name: x\n{keys}\n", "kinds")
            self.assertEqual(words, str(refusal.exception))

    def test_infos_have_the_same_keys_and_numbers_at_every_step(self):
        env = FarmEnv(short_paper())
        _, info = env.reset(seed=3)
        keys, summary = list(info), list(info["summary"])
        over = False
        while not over:
            *_, terminated, truncated, info = env.step(env.action_space.sample())
            over = terminated or truncated
            self.assertEqual((keys, summary), (list(info), list(info["summary"])))
            for value in (*info.values(), *info["summary"].values()):
                self.assertIsInstance(value, (int, float, np.ndarray, dict))
            self.assertEqual(info["summary"]["seed"], 3 if over else 0)
        self.assertEqual(info["summary"]["reason"], info["reason"])
        self.assertGreater(info["summary"]["steps"], 0)
        envs = FarmVectorEnv(4, short_paper())
        keys = list(envs.reset(seed=3)[1])
        for _ in range(2 * SHORT):
            infos = envs.step(envs.action_space.sample())[4]
            self.assertEqual(keys, list(infos))
            for name, value in infos.items():
                if name != "summary":
                    self.assertIn(value.dtype.kind, "iufb")
            self.assertTrue(all(one.dtype.kind in "iufb" for one in infos["summary"].values()))

    @unittest.skipUnless(not WHY_NOT and hasattr(gymnasium.vector, "AutoresetMode"),
                         "autoreset modes need gymnasium >= 1.1")
    def test_each_autoreset_mode_equals_gymnasiums_own_vector_of_single_environments(self):
        for name in MODES:
            mode = gymnasium.vector.AutoresetMode(name)
            ours = FarmVectorEnv(5, short_paper(), autoreset_mode=mode)
            theirs = gymnasium.vector.SyncVectorEnv([lambda: FarmEnv(short_paper())] * 5,
                                                    autoreset_mode=mode)
            self.assertEqual(ours.metadata["autoreset_mode"], mode)
            seeds = [11, 5, 7, 2**62, 0]
            self.check_step(ours.reset(seed=seeds), theirs.reset(seed=seeds))
            rng = np.random.default_rng(1)
            ended = 0
            for _ in range(3 * SHORT):
                actions = rng.integers(0, 10, 5)
                one, other = ours.step(actions), theirs.step(actions)
                for mine, yours in zip(one[1:4], other[1:4]):
                    np.testing.assert_array_equal(mine, yours)
                self.check_step((one[0], one[4]), (other[0], other[4]))
                over = one[2] | one[3]
                ended += np.count_nonzero(over)
                if name == "Disabled" and over.any():
                    self.check_step(ours.reset(options={"reset_mask": over.copy()}),
                                    theirs.reset(options={"reset_mask": over.copy()}), over)
            self.assertGreaterEqual(ended, 10)

    def check_step(self, ours, theirs, where=slice(None)):
        """Compares the (observations, infos) of both environments."""
        np.testing.assert_array_equal(ours[0], theirs[0])
        for key in ("action_mask", "outcome", "reason", "is_success"):
            np.testing.assert_array_equal(ours[1][key][where], theirs[1][key][where], key)
        for key in ours[1]["summary"]:
            np.testing.assert_array_equal(ours[1]["summary"][key][where],
                                          theirs[1]["summary"][key][where], key)
        self.assertEqual("final_obs" in ours[1], "final_obs" in theirs[1])
        if "final_obs" in ours[1]:
            over = ours[1]["_final_obs"]
            np.testing.assert_array_equal(over, theirs[1]["_final_obs"])
            for i in np.flatnonzero(over):
                np.testing.assert_array_equal(ours[1]["final_obs"][i], theirs[1]["final_obs"][i])
            for key in ("reason", "action_mask"):
                np.testing.assert_array_equal(ours[1]["final_info"][key][over],
                                              theirs[1]["final_info"][key][over])

    def test_a_masked_reset_leaves_the_other_farms_as_they_are(self):
        env = FarmVectorEnv(3, "paper", autoreset_mode="Disabled")
        env.reset(seed=4)
        before = env.step(np.array([0, 1, 2]))[0]
        mask = np.array([False, True, False])
        after, infos = env.reset(seed=9, options={"reset_mask": mask, "episode": 20})
        np.testing.assert_array_equal(after[~mask], before[~mask])
        np.testing.assert_array_equal(infos["is_first"], mask)
        self.assertIs(infos["started"], infos["is_first"])  # its name in version 0.1.0
        alone = FarmEnv()
        expected = alone.reset(seed=9, options={"episode": 21})[0]
        np.testing.assert_array_equal(after[1], expected)

    def test_an_episode_by_number_is_of_the_farms_own_seeds(self):
        env, alone = FarmVectorEnv(3), FarmEnv()
        mask = np.array([True, False, True])

        def expect(seen, *starts):
            for one, (seed, episode) in zip(seen, starts):
                np.testing.assert_array_equal(
                    one, alone.reset(seed=seed, options={"episode": episode})[0])

        env.reset(seed=[7, 8, 9])
        expect(env.reset(options={"episode": 5})[0], (7, 5), (8, 5), (9, 5))
        expect(env.reset()[0], (7, 6), (8, 6), (9, 6))
        expect(env.reset(options={"episode": 2, "reset_mask": mask})[0], (7, 2), (8, 6), (9, 2))
        expect(env.reset(seed=4, options={"reset_mask": mask})[0], (4, 0), (8, 6), (4, 2))
        env = pickle.loads(pickle.dumps(env))
        expect(env.reset(options={"episode": 9})[0], (4, 9), (8, 9), (4, 11))
        expect(env.reset(seed=[None, 1, None])[0], (4, 12), (1, 0), (4, 14))
        expect(env.reset(options={"episode": 1})[0], (4, 1), (1, 1), (4, 3))
        env.reset(seed=6)
        expect(env.reset(options={"episode": 1})[0], (6, 1), (6, 2), (6, 3))

    def test_copies_and_pickles_continue_bit_for_bit_and_are_equal(self):
        for make, actions in ((FarmEnv, 3), (lambda: FarmVectorEnv(3), np.array([1, 2, 3])),
                              (FarmParallelEnv, {"ship_0": 1, "ship_1": 2}),
                              (lambda: TeamVectorEnv(2), np.array([[1, 2], [3, 4]]))):
            env = make()
            env.reset(seed=2)
            env.step(actions)
            for other in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
                self.assertEqual(env, other)
                self.assertEqual(hash(env), hash(other))
                self.assert_same(other.step(actions), pickle.loads(pickle.dumps(env)).step(actions))
                self.assertNotEqual(env, other)
                self.assert_same(other.reset(), pickle.loads(pickle.dumps(env)).reset())

    def test_an_id_round_trips_through_json(self):
        spec = gymnasium.make("aquafarm/Paper-v1", observation="index").spec
        again = gymnasium.envs.registration.EnvSpec.from_json(spec.to_json())
        self.assertIsInstance(again.entry_point, str)
        env = gymnasium.make(again)
        self.assertEqual(env.unwrapped.observation, "index")
        self.assertEqual(gymnasium.make("aquafarm/RedTide-v1").unwrapped.farms.name, "red_tide")

    def test_masks_join_the_observation(self):
        env = ActionMaskInObservation(FarmEnv())
        seen, info = env.reset(seed=1)
        self.assertTrue(env.observation_space.contains(seen))
        np.testing.assert_array_equal(seen["action_mask"], info["action_mask"])
        envs = VectorActionMaskInObservation(FarmVectorEnv(4, short_paper(),
                                                           autoreset_mode="SameStep"))
        envs.reset(seed=1)
        lasts = 0
        for _ in range(SHORT + 1):
            seen, *_, infos = envs.step(envs.action_space.sample())
            self.assertTrue(envs.observation_space.contains(seen))
            for last in infos.get("final_obs", ()):
                lasts += last is not None and envs.single_observation_space.contains(last)
        self.assertGreaterEqual(lasts, 4)
        team = VectorActionMaskInObservation(TeamVectorEnv(2))
        self.assertTrue(team.observation_space.contains(team.reset(seed=1)[0]))

    def test_a_mask_has_the_bits_of_the_legal_actions(self):
        legal = np.array([[0b1000000001, 0b1], [0b1111111111, 0]], np.uint16)
        expected = [[[(int(bits) >> k) & 1 for k in range(10)] for bits in row] for row in legal]
        np.testing.assert_array_equal(aquafarm_gym.spaces.action_mask(legal), expected)
        np.testing.assert_array_equal(aquafarm_gym.spaces.action_mask(legal[:, 0]),
                                      [row[0] for row in expected])

    def test_a_state_holds_the_observations_of_all_agents(self):
        for observation in ("features", "planes", "index"):
            env = FarmParallelEnv("two_squads", observation)
            seen = env.reset(seed=1)[0]
            state = env.state()
            self.assertTrue(env.state_space.contains(state))
            parts = [np.atleast_1d(seen[agent]) for agent in env.possible_agents]
            np.testing.assert_array_equal(state, np.concatenate(parts))

    def test_joint_steps_of_many_teams_equal_those_of_one(self):
        envs = TeamVectorEnv(3, REEF)
        one = FarmParallelEnv(REEF)
        seen = envs.reset(seed=6)[0]
        alone = one.reset(seed=6, options={"episode": 1})[0]
        rng = np.random.default_rng(1)
        for _ in range(50):
            if not one.agents:
                break
            actions = rng.integers(0, 10, (3, 3))
            seen, rewards, terminated, truncated, infos = envs.step(actions)
            alone, alone_rewards, *_ = one.step(
                {agent: actions[1, one._number[agent]] for agent in one.agents})
            self.assertEqual(infos["agent_rewards"][1].sum(), rewards[1])
            for agent, observation in alone.items():
                k = one._number[agent]
                np.testing.assert_array_equal(seen[1, k], observation)
                self.assertEqual(infos["agent_rewards"][1, k], alone_rewards[agent])

    def test_the_rewards_of_a_team_add_up_to_the_return_of_the_episode(self):
        for sharing in ("individual", "team"):
            text = pathlib.Path(REEF).read_text("utf-8").replace("step_limit: 400", "step_limit: 60")
            text += f"rewards: {{sharing: {sharing}}}\n"
            envs = TeamVectorEnv(2, core.Scenario.parse(text, sharing))
            self.assertEqual(envs.farms.has_team_rewards, sharing == "team")
            envs.reset(seed=6)
            returns, rng = np.zeros(2), np.random.default_rng(1)
            for _ in range(60):
                _, rewards, terminated, truncated, _ = envs.step(rng.integers(0, 10, (2, 3)))
                returns += rewards
                if (terminated | truncated).any():
                    break
            ended = np.flatnonzero(terminated | truncated)
            self.assertGreater(len(ended), 0)
            for farm, one in zip(ended, envs.farms.finished()):
                self.assertAlmostEqual(returns[farm], one["episode_return"], places=2)

    def test_everything_that_star_imports_is_there(self):
        names = {}
        exec("from aquafarm_gym import *", names)  # as a user without ROS does
        self.assertIn("FarmEnv", names)
        self.assertEqual("RosFarms" in names, has("rospy") and has("aquafarm_msgs"))
        self.assertEqual("FarmVecEnv" in names, has("stable_baselines3"))
        self.assertEqual(aquafarm_gym.__version__, core.VERSION)

    def test_what_does_not_fit_is_refused_in_one_line(self):
        masked = FarmVectorEnv(2, autoreset_mode="Disabled")
        mask = np.array([True, False])
        for call, words in (
                (lambda: FarmEnv(3), "scenario: got 3, expected an aquafarm_core.Scenario, a file"),
                (lambda: FarmEnv().reset(seed=2**63), "reset: seed: got 9223372036854775808, "
                 r"expected a whole number in \[0, 2\*\*63\); pass such a number"),
                (lambda: FarmParallelEnv().reset(seed=2**64), "reset: seed: got 18446744073709551"),
                (lambda: FarmEnv().reset(options={"episode": -1}), r"reset: options\['episode'\]: "
                 r"got -1, expected a whole number in \[0, 2\*\*62\); number the"),
                (lambda: FarmEnv().reset(options={"epsiode": 1}), "reset: options: got 'epsiode', "
                 "expected one of: episode; correct"),
                (lambda: FarmVectorEnv(2, threads=-3), "FarmBatch: threads: got -3, expected a "),
                (lambda: FarmVectorEnv(2**31), "FarmBatch: farms: got 2147483648, expected a "),
                (lambda: FarmVectorEnv(2, autoreset_mode="Never"), "autoreset_mode: got 'Never', "),
                (lambda: FarmVectorEnv(2).reset(seed=[1, 2, 3]), "reset: seed: got 3 seeds, "
                 "expected 2; pass one per farm"),
                (lambda: masked.reset(options={"reset_mask": mask}), "reset: got a reset_mask "
                 "of some farms before the first reset"),
                (lambda: masked.reset(options={"reset_mask": np.array([1, 0])}),
                 r"reset: options\['reset_mask'\]: got array\(\[1, 0\]\), expected a bool array")):
            with self.assertRaisesRegex(ValueError, f"^{words}"):
                call()

    def test_a_farm_that_is_over_is_not_stepped_without_autoreset(self):
        env = FarmVectorEnv(2, short_paper(), autoreset_mode="Disabled")
        env.reset(seed=1)
        with self.assertRaisesRegex(gymnasium.error.ResetNeeded, "^step: the episodes of farms "
                                    r"\[.*\] are over; reset them with options="):
            for _ in range(SHORT + 1):
                env.step(np.zeros(2, int))

    @unittest.skipUnless(has("stable_baselines3"), "there is no stable_baselines3")
    def test_stable_baselines3_steps_many_farms(self):
        from aquafarm_gym import FarmVecEnv
        from stable_baselines3.common.vec_env import VecMonitor
        envs, one = FarmVecEnv(4, short_paper()), FarmEnv(short_paper())
        envs.seed(3)
        np.testing.assert_array_equal(envs.reset()[0], one.reset(seed=3)[0])
        ended, total = 0, 0.0
        for action in np.random.default_rng(2).integers(0, 10, 2 * SHORT + 20):
            seen, rewards, dones, infos = envs.step(np.full(4, action))
            alone, reward, terminated, truncated, _ = one.step(action)
            total += reward
            self.assertEqual((rewards[0], dones[0]), (reward, terminated or truncated))
            if dones[0]:
                ended += 1
                np.testing.assert_array_equal(infos[0]["terminal_observation"], alone)
                self.assertEqual(infos[0]["TimeLimit.truncated"], truncated)
                self.assertAlmostEqual(infos[0]["episode"]["r"], total, delta=0.01)
                total = 0.0
                alone = one.reset(options={"episode": one._episodes.episode + 4})[0]
            np.testing.assert_array_equal(seen[0], alone)
            np.testing.assert_array_equal(envs.env_method("action_masks")[0], one.action_masks())
        self.assertGreaterEqual(ended, 2)
        self.assertEqual(VecMonitor(envs).reset().shape, (4, *envs.observation_space.shape))

    @unittest.skipUnless(has("stable_baselines3"), "there is no stable_baselines3")
    def test_ships_share_a_policy_of_stable_baselines3(self):
        from aquafarm_gym import FarmVecEnv
        text = aquafarm_gym.find_scenario("two_squads").yaml
        squads = core.Scenario.parse(text.replace("step_limit: 5000", "step_limit: 20"), "squads")
        envs, teams = FarmVecEnv(3, squads), TeamVectorEnv(3, squads, autoreset_mode="SameStep")
        self.assertEqual((envs.num_envs, envs.action_masks().shape), (6, (6, 10)))
        envs.seed(3)
        np.testing.assert_array_equal(envs.reset(), np.concatenate(teams.reset(seed=3)[0]))
        rng = np.random.default_rng(2)
        for step in range(1, 41):
            actions = rng.integers(0, 10, 6)
            seen, rewards, dones, infos = envs.step(actions)
            expected, _, terminated, truncated, more = teams.step(actions.reshape(3, 2))
            np.testing.assert_array_equal(seen, np.concatenate(expected))
            last = more.get("final_info", more)
            np.testing.assert_array_equal(rewards, last["agent_rewards"].ravel())
            np.testing.assert_array_equal(dones, np.repeat(terminated | truncated, 2))
            self.assertEqual(dones.all(), step % 20 == 0)
            if dones.all():
                np.testing.assert_array_equal(infos[3]["terminal_observation"],
                                              more["final_obs"][1][1])
                self.assertEqual(infos[2]["episode"]["l"], 20)
        with self.assertRaisesRegex(ValueError, "^scenario smart_devices: got self-propelled dev"):
            FarmVecEnv(2, "smart_devices")


if __name__ == "__main__":
    run_tests("env", EnvTest, WHY_NOT)
