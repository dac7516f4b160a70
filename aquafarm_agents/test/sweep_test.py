#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of aquafarm_sweep with a script in the place of aquafarm_train."""
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import rosunit

from aquafarm_benchmark import cli, sweep

# Its return is 10 * gamma + seed; it refuses gamma=bad and fails with gamma=broken.
TRAIN = """#!/usr/bin/python3
import json, pathlib, sys
words = sys.argv
run = pathlib.Path(words[words.index("--run-dir") + 1])
seed = int(words[words.index("--seed") + 1])
gamma = [w for w in words if w.startswith("gamma=")][0][6:]
if gamma == "bad":
    print("gamma: got 'bad', expected a number")
    sys.exit(2)
if gamma == "broken":
    print("out of memory")
    sys.exit(1)
run.mkdir(parents=True, exist_ok=True)
with open(run / "calls", "a") as calls:
    calls.write(" ".join(words[1:]) + "\\n")
(run / "evaluation.json").write_text(json.dumps({
    "complete": True, "return_per_episode": 10 * float(gamma) + seed, "success_rate": 0.5}))
"""


class SweepTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.home = pathlib.Path(folder.name)
        train = self.home / "aquafarm_train"
        train.write_text(TRAIN)
        train.chmod(0o755)

    def sweep(self, *words, output="out"):
        """Runs the command; returns (exit code, what it said)."""
        with contextlib.redirect_stdout(io.StringIO()) as said, \
                contextlib.redirect_stderr(said):
            code = sweep.main(["paper", "ppo", "--output", str(self.home / output), "--programs",
                               str(self.home), *words])
        return code, said.getvalue()

    def test_the_table_has_every_combination_best_first(self):
        code, said = self.sweep("--set", "gamma=0.5,0.9", "--set", "hidden_size=64,128",
                                "--seeds", "1-3", "--steps", "7")
        self.assertEqual(code, 0, said)
        table = (self.home / "out" / "table.csv").read_text().splitlines()
        self.assertEqual(len(table), 5)
        self.assertRegex(table[1], r"^gamma=0.9 hidden_size=64,3,11.0,2\.48")
        self.assertRegex(table[4], r"^gamma=0.5 hidden_size=128,3,7.0,")
        self.assertIn("| gamma=0.9 hidden_size=64 | 3 | 11.0 | 2.5 | 50.0 % |", said)
        run = self.home / "out" / "runs" / "001_seed_2"
        self.assertIn("--seed 2", (run / "calls").read_text())
        self.assertIn("--steps 7 --set gamma=0.5 --set hidden_size=128",
                      (run / "calls").read_text())

    def test_the_same_command_keeps_what_is_there_and_more_seeds_join(self):
        self.sweep("--set", "gamma=0.5", "--seeds", "1")
        code, said = self.sweep("--set", "gamma=0.5", "--seeds", "1-2")
        self.assertEqual(code, 0, said)
        run = self.home / "out" / "runs" / "000_seed_1"
        self.assertEqual(len((run / "calls").read_text().splitlines()), 1)
        self.assertIn("gamma=0.5,2,6.5,", (self.home / "out" / "table.csv").read_text())

    def test_refused_options_and_failures_are_reported(self):
        code, said = self.sweep("--set", "gamma=0.5,bad", "--seeds", "1-2")
        self.assertEqual(code, 2)
        self.assertIn("refused: gamma=bad: gamma: got 'bad', expected a number", said)
        self.assertIn("| gamma=0.5 | 2 |", said)
        code, said = self.sweep("--set", "gamma=broken", "--seeds", "1", output="other")
        self.assertEqual(code, 4)
        self.assertIn("out of memory", said)

    def test_refused_defaults_are_named(self):
        (self.home / "aquafarm_train").write_text("#!/bin/sh\necho 'too many states'; exit 2\n")
        code, said = self.sweep("--seeds", "1")
        self.assertEqual(code, 2)
        self.assertIn("refused: (defaults): too many states", said)

    def test_the_default_number_of_jobs_is_that_of_the_usable_cores(self):
        with mock.patch("os.sched_getaffinity", return_value={0, 3}):
            self.assertEqual(sweep.arguments(["paper", "ppo", "--output", "out"]).jobs, 2)

    def test_wrong_arguments_are_refused_in_one_line(self):
        self.sweep("--set", "gamma=0.5", "--seeds", "1")
        for words, expected in (
                (("--set", "gamma"), "--set: got 'gamma', expected key=value"),
                (("--set", "gamma=1,,2"), "--set: got 'gamma=1,,2'"),
                (("--set", "a=1", "--set", "a=2"), "--set: got a, a, expected each key once"),
                (("--seeds", "3-1"), "--seeds: got '3-1', expected different numbers"),
                (("--seeds", "1,1"), "--seeds: got '1,1'"),
                (("--jobs", "0"), "--jobs: got 0, expected at least 1"),
                (("--scheduler", "cloud"), "scheduler: got 'cloud', expected local, slurm or an "),
                (("--set", "gamma=0.9"), "--output: got ")):
            code, said = self.sweep(*words)
            self.assertEqual(code, 2, said)
            self.assertIn(f"aquafarm_sweep: {expected}", said)
            self.assertEqual(said.count("\n"), 1, said)

    def test_a_learner_of_another_package_is_a_row_of_the_benchmark(self):
        for name in ("aquafarm_train", "aquafarm_evaluate"):
            (self.home / name).write_text(TRAIN)
            (self.home / name).chmod(0o755)
        options = cli.parse(["paper", "--algorithms", "random", "--runs", "2", "--episodes", "7",
                             "--evaluation-episodes", "9", "--learner", "none", "--learner",
                             "mine=python3 'my file.py' --fast", "--programs", str(self.home)])
        self.assertEqual([one.name for one in options.learners], ["mine"])
        jobs = cli.make_jobs(options, options.learners, self.home)
        self.assertEqual([job.name for job in jobs], ["mine 1", "mine 2"])
        run = str(self.home / "runs" / "mine" / "seed_2")
        self.assertEqual(jobs[1].commands, [[
            "python3", "my file.py", "--fast", "paper", "--name", "mine", "--max-steps", "0",
            "--episodes", "7", "--seed", "2", "--evaluation-episodes", "9", "--evaluation-seed",
            "1000", "--run-dir", run]])
        for learner, words in (("mine", "learner: got 'mine', expected NAME=COMMAND"),
                               ("Mine=x", "learner: got 'Mine=x'"), ("a='x", "learner: got "),
                               ("dqn=x", "learner: got 'dqn', expected a name that no other")):
            with self.assertRaisesRegex(cli.BadInput, f"^{words}"):
                cli.parse(["--learner", learner])

    def test_the_interval_is_that_of_students_t(self):
        mean, half = sweep.interval([1.0, 2.0, 3.0])
        self.assertEqual(mean, 2.0)
        self.assertAlmostEqual(half, 4.303 / 3 ** 0.5, places=3)


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "sweep", SweepTest, sys.argv)
