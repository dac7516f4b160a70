#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of planners and saved policies from Python. They need no package from PyPI.

The returns of `EVALUATED` are those that aquafarm_evaluate writes for the same episodes
(--episodes 5 --farms 5 --seed 3 --max-steps 300).
"""
import csv
import pathlib
import subprocess
import tempfile
import unittest

import aquafarm_core as core
import numpy as np
from venv_tools import run_tests

DATA = pathlib.Path(__file__).resolve().parent / "data"
ROOT = DATA.parents[2]
OLD_RUNS = ROOT / "aquafarm_agents" / "core" / "test" / "data" / "version_0_1_0"
EVALUATION_SEED = 2**63 + 3  # of aquafarm_evaluate --seed 3
EVALUATED = {
    "planner": [280.60928, 265.60928, 271.60928, 276.60928, 273.60928],
    "clairvoyant": [280.60928, 280.60928, 280.60928, 276.60928, 280.60928],
    "fetch_by_value": [276.60928, 211.60928, 241.60928, 253.60928, 262.60928],
    "do_nothing": [-462, -814, -463, -651, -587],
}


def shipped(name, step_limit=300):
    """Returns a shipped scenario with another step limit."""
    text = core.Scenario.load(f"{core.SCENARIO_FOLDER}/{name}.yaml").yaml
    return core.Scenario.parse(text.replace("step_limit: 5000", f"step_limit: {step_limit}"), name)


def play(batch, policy):
    """Plays the present episode of each farm; returns the records by farm."""
    records = {}
    while len(records) < batch.farms:
        batch.step(policy.act(batch))
        for one in batch.finished():
            records.setdefault(one["farm"], one)
    return [records[i] for i in range(batch.farms)]


class PlanningTest(unittest.TestCase):
    def test_policies_play_as_in_aquafarm_evaluate(self):
        paper = shipped("paper")
        for name, expected in EVALUATED.items():
            batch = core.FarmBatch(paper, 5)
            batch.reset(EVALUATION_SEED)
            records = play(batch, core.Policy(name, paper, 5, EVALUATION_SEED))
            np.testing.assert_allclose([one["episode_return"] for one in records], expected,
                                       rtol=1e-6, err_msg=name)

    def test_a_network_plays_as_in_aquafarm_evaluate(self):
        """Runs both programs here, because another processor may round differently."""
        program = evaluate_program()
        if program is None:
            self.skipTest("aquafarm_evaluate is not built here")
        paper = shipped("paper")
        with tempfile.TemporaryDirectory() as folder:
            result = pathlib.Path(folder, "evaluation")
            subprocess.run([program, DATA / "ppo", "paper", "-e", "5", "-f", "5", "-s", "3",
                            "--max-steps", "300", "-w", result], check=True, timeout=300,
                           stdout=subprocess.DEVNULL)
            with open(f"{result}.csv", newline="", encoding="utf-8") as file:
                expected = [float(row["return"]) for row in csv.DictReader(file)]
        batch = core.FarmBatch(paper, 5)
        batch.reset(EVALUATION_SEED)
        records = play(batch, core.Policy(str(DATA / "ppo"), paper, 5, EVALUATION_SEED))
        np.testing.assert_allclose([one["episode_return"] for one in records], expected, rtol=1e-4)

    def test_the_shipped_generalist_plays_a_farm_without_tokens(self):
        paper = shipped("paper")
        batch = core.FarmBatch(paper, 5)
        batch.reset(EVALUATION_SEED)
        returns = [one["episode_return"] for one in play(batch, core.Policy("generalist", paper, 5))]
        self.assertGreater(np.mean(returns), 0.8 * np.mean(EVALUATED["clairvoyant"]))

    def test_a_table_of_the_first_version_plays(self):
        run = OLD_RUNS / "q_learning"
        tiny = core.Scenario.load(str(run / "scenario.yaml"))
        batch = core.FarmBatch(tiny, 3)
        batch.reset(EVALUATION_SEED)
        for one in play(batch, core.Policy(str(run), tiny, 3)):
            self.assertAlmostEqual(one["episode_return"], 90.71126, places=4)

    def test_random_actions_repeat_with_their_seed(self):
        paper = shipped("paper")
        batch = core.FarmBatch(paper, 4)
        batch.reset(1)
        one, same, other = (core.Policy("random", paper, 4, seed) for seed in (5, 5, 6))
        first = [one.act(batch) for _ in range(20)]
        np.testing.assert_array_equal(first, [same.act(batch) for _ in range(20)])
        self.assertTrue((np.array(first) != [other.act(batch) for _ in range(20)]).any())
        one.begin(5)
        np.testing.assert_array_equal(first, [one.act(batch) for _ in range(20)])

    def test_the_clairvoyant_return_is_that_of_the_played_plan(self):
        paper = shipped("paper")
        batch = core.FarmBatch(paper, 3)
        batch.reset(8)
        planner = core.Planner(paper)
        for farm in range(3):
            actions, value = planner.solve(batch, farm)
            alone = core.FarmBatch(paper, 1)
            alone.reset(8, farm)
            for action in actions:
                alone.step(np.array([[action]], np.uint8))
            self.assertAlmostEqual(alone.finished()[0]["episode_return"], value, places=3)
            again, _ = planner.solve(alone)
            self.assertEqual(len(again), 0)  # the episode is over
            forecast = core.Planner(paper, clairvoyant=False).solve(batch, farm)[0]
            self.assertGreater(len(forecast), 0)

    def test_no_team_exceeds_the_bound(self):
        squads = shipped("two_squads")
        batch = core.FarmBatch(squads, 3)
        batch.reset(EVALUATION_SEED)
        bounds = [core.team_bound(batch, farm) for farm in range(3)]
        self.assertAlmostEqual(np.mean(bounds), 615.9, delta=0.1)  # aquafarm_evaluate --bound
        for name, expected in (("clairvoyant", [601.9015, 611.9015, 611.9015]),
                               ("planner", [599.9014, 611.9015, 553.4191])):
            batch.reset(EVALUATION_SEED)
            returns = [one["episode_return"] for one in play(batch, core.Policy(name, squads, 3))]
            np.testing.assert_allclose(returns, expected, rtol=1e-5)
            self.assertTrue((np.array(returns) <= bounds).all())

    def test_what_does_not_fit_is_refused_in_one_line(self):
        paper, squads = shipped("paper"), shipped("two_squads")
        batch = core.FarmBatch(paper, 2)
        batch.reset(1)
        batch.step(np.full((2, 1), core.HOLD, np.uint8))
        tiny = core.Scenario.load(str(OLD_RUNS / "dqn" / "scenario.yaml"))
        for call, words in (
                (lambda: core.Policy("plannner", paper), "policy: got 'plannner', expected one of: "
                 "clairvoyant, do_nothing, fetch_by_value, planner, random, generalist; or a run folder"),
                (lambda: core.Policy(str(OLD_RUNS / "dqn"), tiny), ".*policy.ckpt: got a policy of "
                 "dqn, which this package cannot play; expected one of: .*sarsa; evaluate it"),
                (lambda: core.Policy(str(OLD_RUNS / "q_learning"), paper), ".*policy.ckpt: "),
                (lambda: core.Policy("planner", paper, 0), "Policy: farms: got 0, expected a whole"),
                (lambda: core.Policy("planner", paper, 3).act(batch), "Policy: got a batch of 2 "
                 "farms of paper, expected 3 of paper; make"),
                (lambda: core.Planner(squads), "Planner: got 2 agents, expected 1; use Policy"),
                (lambda: core.Planner(paper).solve(batch, 2), "Planner: farm: got 2, expected a"),
                (lambda: core.team_bound(batch), "team_bound: got a farm at step 1, expected step "
                 "0; reset")):
            with self.assertRaisesRegex(ValueError, f"^{words}"):
                call()


def evaluate_program():
    """Returns the path of aquafarm_evaluate; None if it is not built here."""
    try:
        import roslib.packages
        found = roslib.packages.find_node("aquafarm_agents", "aquafarm_evaluate")
    except Exception:  # pylint: disable=broad-except; no ROS here, or no such package
        return None
    return found[0] if found else None


if __name__ == "__main__":
    run_tests("planning", PlanningTest, "")
