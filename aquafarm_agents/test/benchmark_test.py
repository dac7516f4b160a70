#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A small benchmark: what it ends in, killed, resumed, interrupted, refused."""
import csv
import dataclasses
import json
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest

import rostest
from matplotlib import image

from aquafarm_benchmark import runs

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from processes import DATA, Program, program  # noqa: E402

FIGURES = {"rewards", "average_rewards", "mean_square_error", "mean_score", "repeated_trainings",
           "route_random", "route_q_learning", "route_planner", "route_clairvoyant"}


def is_running(words):
    """Whether a process has these words in its command line."""
    for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if words in path.read_bytes().decode(errors="replace"):
                return True
        except OSError:
            continue  # it has just ended
    return False


class BenchmarkTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="aquafarm_benchmark_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, output, *arguments, episodes=150):
        return Program(self, program("aquafarm_agents", "aquafarm_benchmark"), DATA / "tiny.yaml",
                       "--output", self.folder / output, "--runs", "2", "--episodes", episodes,
                       "--evaluation-episodes", "30", "--programs",
                       pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent,
                       *arguments)

    def test_it_ends_in_tables_and_figures(self):
        one = self.start("out", "--algorithms", "random,q_learning,planner", episodes=400)
        self.assertEqual(0, one.code(180), one.words())
        everything = json.loads((self.folder / "out/results.json").read_text())
        rows = {row["name"]: row for row in everything["table"]}
        self.assertEqual(["random", "q_learning", "planner", "clairvoyant"], list(rows))
        self.assertAlmostEqual(1.0, rows["clairvoyant"]["share_of_optimum"], places=5)
        self.assertEqual(1.0, rows["q_learning"]["success_rate"])
        self.assertGreater(rows["q_learning"]["share_of_optimum"], 0.9)
        self.assertEqual(1.0, rows["q_learning"]["stability"])
        self.assertLess(rows["random"]["ea_paper"], rows["q_learning"]["ea_paper"])
        self.assertEqual([1, 2], [run["seed"] for run in everything["runs"]["q_learning"]])
        self.assertEqual("tiny", everything["settings"]["scenario_name"])
        self.assertTrue(everything["settings"]["scenario_hash"])
        with open(self.folder / "out/table.csv", newline="") as file:
            self.assertEqual(len(rows), len(list(csv.DictReader(file))))
        self.assertIn("| *Q-learning, paper* |", one.words())
        pictures = {path.stem: path for path in (self.folder / "out/figures").glob("*.png")}
        self.assertEqual(FIGURES, set(pictures))
        for name, path in pictures.items():
            self.assertGreater(image.imread(path).std(), 0.05, name)

    def test_killed_it_goes_on_and_ends_in_the_same_numbers(self):
        arguments = ("--algorithms", "q_learning", "--jobs", "2")
        whole = self.start("whole", *arguments, episodes=60000)
        self.assertEqual(0, whole.code(), whole.words())
        part = self.start("parts", *arguments, episodes=60000)
        trainings = self.folder / "parts/runs/q_learning"
        part.wait_for(lambda: len(list(trainings.glob("*/metrics.csv"))) == 2, "two trainings")
        part.send(signal.SIGKILL)
        part.code()
        end = time.monotonic() + 30.0
        while is_running(str(trainings)):  # the trainings save and end by themselves
            self.assertLess(time.monotonic(), end, "the trainings outlive the benchmark")
            time.sleep(0.05)
        rest = self.start("parts", *arguments, episodes=60000)
        self.assertEqual(0, rest.code(), rest.words())
        for name in ("runs.csv", "table.csv", "table.md"):
            self.assertEqual((self.folder / "whole" / name).read_text(),
                             (self.folder / "parts" / name).read_text(), name)
        # What is finished is not done again.
        before = {path: path.stat().st_mtime_ns for path in trainings.rglob("policy.ckpt")}
        self.assertEqual(2, len(before))
        again = self.start("parts", *arguments, episodes=60000)
        self.assertEqual(0, again.code(), again.words())
        self.assertIn("3 of 3 runs are there already", again.words())
        self.assertEqual(before, {path: path.stat().st_mtime_ns
                                  for path in trainings.rglob("policy.ckpt")})

    def test_interrupted_it_says_how_to_go_on(self):
        one = self.start("out", "--algorithms", "q_learning", episodes=10000000)
        one.wait_for(lambda: list(self.folder.glob("out/runs/q_learning/*/metrics.csv")),
                     "a training")
        one.send(signal.SIGINT)
        self.assertEqual(130, one.code(), one.words())
        self.assertIn("the same command goes on from here", one.words())
        self.assertTrue(list(self.folder.glob("out/runs/q_learning/*/checkpoints/step_*.ckpt")))

    def test_a_failed_run_is_told_and_the_others_are_kept(self):
        jobs = [runs.Job(name, name, self.folder / name, self.folder / name / "evaluation.json",
                         [["sh", "-c", command]], 1.0)
                for name, command in (
                    ("good", f"echo '{{\"complete\": true}}' >{self.folder}/good/evaluation.json"),
                    ("bad", "echo the disk is full; exit 3"), ("unfit", "echo too large; exit 2"))]
        words = []
        with self.assertRaisesRegex(runs.RunFailed, "^bad: exit code 3: the disk is full"):
            runs.run_all(jobs, 2, words.append)
        self.assertIn("failed: bad: exit code 3", words[0])
        self.assertTrue(runs.is_complete(jobs[0].result))
        unfit = dataclasses.replace(jobs[2], next_command=0)
        self.assertEqual({"unfit": "too large"}, runs.run_all([unfit], 1, words.append))

    def test_arguments_are_refused_with_what_is_allowed(self):
        (self.folder / "full").mkdir()
        (self.folder / "full/thesis.txt").write_text("dear")
        for arguments, words in (
                (("--algorithms", "dqm"), "algorithms: got 'dqm', expected some of: random"),
                (("--profile", "long"), "profile: got 'long', expected one of: full, quick"),
                (("--runs", "-1"), "runs: got -1, expected 1 or more"),
                (("--output", self.folder / "full"), "is not empty and holds no benchmark"),
                (("--programs", self.folder), "there is no aquafarm_evaluate in")):
            with self.subTest(arguments=arguments):
                one = self.start("out", *arguments)
                self.assertEqual(2, one.code(), one.words())
                self.assertIn(words, one.words())
        unknown = Program(self, program("aquafarm_agents", "aquafarm_benchmark"), "atlantis",
                          "--output", self.folder / "out", "--programs",
                          pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent)
        self.assertEqual(2, unknown.code(), unknown.words())
        self.assertIn("scenario: got 'atlantis', expected a file or one of: paper, partial",
                      unknown.words())
        first = self.start("out", "--algorithms", "random", episodes=5)
        self.assertEqual(0, first.code(), first.words())
        other = self.start("out", "--algorithms", "random", episodes=6)
        self.assertEqual(2, other.code(), other.words())
        self.assertIn("holds a benchmark with episodes 5, got 6", other.words())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_agents", "benchmark", BenchmarkTest, sys.argv)
