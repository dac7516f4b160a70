#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of learners of other packages in the benchmark: the files that they write.

Runs in the virtual environment given by --venv (venv_tools.py), or in the Python that starts it.
"""
import contextlib
import csv
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

from venv_tools import enter_venv, run_tests

WHY_NOT = enter_venv()

if not WHY_NOT:
    import aquafarm_core as core
    import aquafarm_gym
    import numpy as np
    from aquafarm_gym import external


# The layout is fixed and there are no disasters, so all episodes start alike.
STILL = """
name: still
grid: {width: 7, height: 6}
time: {step_limit: 50}
layout: {mode: fixed, seed: 1, ports: {count: 1}, devices: {count: 1}}
ships: {count: 1}
"""


class Sample:
    """Explores with random actions, and takes the last legal action when it is evaluated."""

    def __init__(self, env, seed):
        self.env, self.random = env, np.random.default_rng(seed)

    def train(self):
        """Plays until the environment raises EpisodesOver."""
        while True:
            self.env.reset()
            over = False
            while not over:
                _, _, terminated, truncated, _ = self.env.step(self.random.integers(0, 10))
                over = terminated or truncated

    def act(self, observation, mask):
        """Returns the last legal action: deterministic, and never illegal."""
        assert observation.shape == self.env.observation_space.shape
        return int(np.flatnonzero(mask)[-1])


class Lazy(Sample):
    """Does not train at all."""

    def train(self):
        """Returns at once."""


@unittest.skipIf(WHY_NOT, WHY_NOT)
class ExternalTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.run_dir = pathlib.Path(folder.name) / "run"

    def learn(self, *words, make=Sample):
        """Runs the program of a learner; returns (exit code, what it said)."""
        sys.argv = ["learner", *words, "--run-dir", str(self.run_dir), "--name", "mine"]
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(said):
            code = external.main(make)
        return code, said.getvalue()

    def test_it_shows_progress_as_the_benchmark_reads_it(self):
        with unittest.mock.patch.object(external, "PROGRESS_PERIOD_S", 0.0):
            code, said = self.learn("paper", "--episodes", "2", "--max-steps", "5",
                                    "--evaluation-episodes", "1")
        self.assertEqual(code, 0, said)
        self.assertEqual(said.splitlines()[:2], ["episodes 1 / 2", "episodes 2 / 2"])

    def test_a_run_has_the_files_of_the_benchmark(self):
        code, said = self.learn("paper", "--episodes", "3", "--max-steps", "50", "--seed", "4",
                                "--evaluation-episodes", "2", "--evaluation-seed", "3")
        self.assertEqual(code, 0, said)
        with open(self.run_dir / "metrics.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["number"] for row in rows], ["1", "2", "3"])
        self.assertEqual([row["total_steps"] for row in rows], ["50", "100", "150"])
        self.assertEqual({row["seed"] for row in rows}, {"4"})
        summary = json.loads((self.run_dir / "evaluation.json").read_text())
        with open(self.run_dir / "evaluation.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        returns = [float(row["return"]) for row in rows]
        self.assertEqual([row["seed"] for row in rows], [str(2**63 + 3)] * 2)
        self.assertAlmostEqual(summary["return_per_episode"], np.mean(returns), places=3)
        self.assertAlmostEqual(summary["return_per_step"], sum(returns) / 100, places=4)
        self.assertEqual((summary["complete"], summary["episodes"], summary["success_rate"],
                          summary["steps_per_episode"], summary["distinct_episodes"]),
                         (True, 2, 0, 50, 2))
        self.assertEqual((summary["scenario"], summary["training_steps"]), ("paper", 150))
        settings = json.loads((self.run_dir / "run.json").read_text())
        self.assertEqual((settings["algorithm"], settings["options"]), ("mine", ""))

    def test_the_evaluation_plays_the_episodes_of_aquafarm_evaluate(self):
        scenario = external.with_limit(aquafarm_gym.find_scenario("paper"), 300)
        learner = Sample(aquafarm_gym.FarmEnv(scenario), 1)
        learner.act = lambda observation, mask: core.HOLD
        records, starts = external.evaluate(learner, scenario, "features", 5, 3)
        # aquafarm_evaluate do_nothing paper --episodes 5 --seed 3 --max-steps 300
        self.assertEqual([one["episode_return"] for one in records],
                         [-462, -814, -463, -651, -587])
        self.assertEqual(starts, 5)

    def test_equal_starts_count_as_one_distinct_episode(self):
        scenario = external.with_limit(core.Scenario.parse(STILL, "still"), 4)
        learner = Sample(aquafarm_gym.FarmEnv(scenario), 1)
        _, starts = external.evaluate(learner, scenario, "features", 5, 3)
        self.assertEqual(starts, 1)

    def test_the_health_of_deliveries_is_a_mean_over_episodes_with_one(self):
        other = {name: 1.0 for name in ("episode_return", "steps", "success", "crashes",
                                        "steps_in_disaster", "energy", "distance")}
        records = [{**other, "delivered": count, "delivered_health": health}
                   for count, health in ((1, 0.5), (3, 1.0), (0, 0.0))]
        self.assertAlmostEqual(external.summary_of(records)["delivered_health"], 0.75)

    def test_a_learner_that_stops_early_has_no_row_in_the_benchmark(self):
        code, said = self.learn("paper", "--episodes", "3", "--max-steps", "50", make=Lazy)
        self.assertEqual((code, said.count("\n")), (2, 1), said)
        self.assertIn("mine: train() ended after 0 episodes, expected 3", said)
        self.assertFalse((self.run_dir / "evaluation.json").exists())

    def test_what_does_not_fit_ends_with_code_2_and_one_line(self):
        for scenario, words in (("two_squads", "scenario two_squads: got 2 agents, expected 1; "),
                                ("none", "scenario: got 'none', expected ")):
            code, said = self.learn(scenario)
            self.assertEqual((code, said.count("\n")), (2, 1), said)
            self.assertIn(words, said)

    def test_numbers_out_of_range_end_with_code_2_and_what_is_expected(self):
        for words in (("--seed", "-1"), ("--seed", str(2**63)), ("--episodes", "0"),
                      ("--evaluation-episodes", "many")):
            done = subprocess.run([sys.executable, "-c", "from aquafarm_gym import external; "
                                   "external.main(None)", "paper", "--run-dir", self.run_dir,
                                   *words], capture_output=True, text=True, check=False, timeout=60)
            self.assertEqual(2, done.returncode, words)
            self.assertIn(f"argument {words[0]}: got '{words[1]}', expected a whole number from ",
                          done.stderr)


if __name__ == "__main__":
    run_tests("external", ExternalTest, WHY_NOT)
