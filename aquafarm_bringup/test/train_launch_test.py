#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Training through ROS from start to end, with faults and wrong input."""
import os
import pathlib
import shlex
import signal
import struct
import sys
import tempfile
import time
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch  # noqa: E402

ARGUMENT_REFUSED = 2
RUN_FOLDER_FAILED = 3
SIM_LOST = 4
INTERRUPTED = 130
START_LIMIT_S = 60


class TrainLaunchTest(unittest.TestCase):

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="aquafarm_run_")
        self.addCleanup(self._folder.cleanup)
        self.run_dir = pathlib.Path(self._folder.name) / "run"

    def train(self, *arguments):
        return Ranch("train", f"run_dir:={self.run_dir}", "viz:=false", "checkpoint_period_s:=0.5",
                     "evaluation_episodes:=20", "random_episodes:=20", *arguments)

    def wait_until_training(self, ranch):
        """Waits for the first line of metrics."""
        metrics = self.run_dir / "metrics.csv"
        ranch.wait_for(lambda: metrics.exists() and metrics.read_text().count("\n") > 1,
                       START_LIMIT_S)

    def test_a_short_training_ends_with_zero_a_summary_and_a_run_folder(self):
        with self.train("episodes:=64") as ranch:
            self.assertEqual(0, ranch.exit_code(60), ranch.words())
            for word in ("return", "success", str(self.run_dir)):
                self.assertIn(word, ranch.words())
            for word in ("log_curves", "usage:"):  # without log:= no node logs curves
                self.assertNotIn(word, ranch.words())
        names = {path.name for path in self.run_dir.rglob("*")}
        self.assertLessEqual({"metrics.csv", "scenario.yaml"}, names)
        self.assertFalse([name for name in names if name.endswith((".tmp", ".part"))])

    def test_with_log_its_curves_are_event_files_of_tensorboard(self):
        with self.train("episodes:=320", "log:=tensorboard") as ranch:
            self.assertEqual(0, ranch.exit_code(60), ranch.words())
        events, = (self.run_dir / "tensorboard").glob("events.out.tfevents.*")
        content, texts = events.read_bytes(), []
        while content:
            length, = struct.unpack("<Q", content[:8])
            texts.append(content[12:12 + length])
            content = content[12 + length + 4:]
        self.assertIn(b"brain.Event:2", texts[0])
        self.assertEqual(7, len(texts[1:]), "means of 50 episodes and a rest of 20")
        for text in texts[1:]:
            self.assertIn(b"episode/return", text)

    def test_an_unknown_algorithm_ends_at_once_and_lists_what_there_is(self):
        with self.train("algorithm:=alphago") as ranch:
            self.assertEqual(ARGUMENT_REFUSED, ranch.exit_code(START_LIMIT_S))
            for word in ("alphago", "random", "q_learning", "sarsa"):
                self.assertIn(word, ranch.words())

    def test_an_unknown_scenario_ends_at_once_and_lists_what_there_is(self):
        with self.train("scenario:=atlantis") as ranch:
            self.assertEqual(ARGUMENT_REFUSED, ranch.exit_code(START_LIMIT_S))
            for word in ("atlantis", "paper", "procedural", "red_tide", "zhoushan_infa_2021"):
                self.assertIn(word, ranch.words())

    def test_every_launch_with_a_farm_refuses_an_unknown_scenario(self):
        for launch, *arguments in (("sim", "headless:=true"), ("record", "viz:=false"),
                                   ("evaluate", "policy:=random", "viz:=false")):
            with self.subTest(launch), Ranch(launch, "scenario:=atlantis", *arguments) as ranch:
                self.assertEqual(ARGUMENT_REFUSED, ranch.exit_code(START_LIMIT_S), ranch.words())
                for word in ("atlantis", "paper", "zhoushan_infa_2021"):
                    self.assertIn(word, ranch.words())

    def test_a_benchmark_is_launched_and_leaves_its_table(self):
        output = self.run_dir.parent / "benchmark"
        with Ranch("benchmark", "algorithms:=random,q_learning", "runs:=1", "episodes:=150",
                   "evaluation_episodes:=5", f"output:={output}", "report:=none") as ranch:
            self.assertEqual(0, ranch.exit_code(120), ranch.words())
            self.assertIn(f"tables and figures are in {output}", ranch.words())
        table = (output / "table.md").read_text(encoding="utf-8")
        for name in ("RANDOM", "Q-learning", "*Q-learning, paper*"):
            self.assertIn(name, table)

    def test_a_run_folder_that_cannot_be_made_ends_at_the_start(self):
        self.run_dir.parent.joinpath("file").write_text("in the way")
        self.run_dir = self.run_dir.parent / "file" / "run"
        with self.train() as ranch:
            self.assertEqual(RUN_FOLDER_FAILED, ranch.exit_code(START_LIMIT_S))
            self.assertIn(str(self.run_dir), ranch.words())

    def test_a_lost_sim_node_is_reported_and_ends_the_training_after_the_limit(self):
        with self.train("sim_restarts:=0", "sim_timeout_s:=3") as ranch:
            self.wait_until_training(ranch)
            os.kill(ranch.node_pid("sim_node"), signal.SIGKILL)
            killed = time.monotonic()
            ranch.wait_for(lambda: "the sim node is gone; waiting up to 3 s" in ranch.words(), 60)
            self.assertEqual(SIM_LOST, ranch.exit_code(60), ranch.words())
            self.assertGreater(time.monotonic() - killed, 2.5)
        self.assertTrue(list(self.run_dir.rglob("step_*.ckpt")), "nothing was saved")

    def test_a_training_continues_after_its_sim_node_returns(self):
        with self.train("episodes:=8000") as ranch:
            self.wait_until_training(ranch)
            os.kill(ranch.node_pid("sim_node"), signal.SIGKILL)
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
            self.assertIn("starting it again", ranch.words())

    def test_ctrl_c_saves_and_resume_ends_in_the_bits_of_a_run_never_stopped(self):
        begun = ("episodes:=3000", "algorithm:=sarsa", "options:=gamma=0.9 mask_illegal=true",
                 "exploration:=epsilon_greedy:0.2", "credit:=shared", "seed:=3", "farms:=32")
        with self.train(*begun, "checkpoint_period_s:=1000") as ranch:
            self.wait_until_training(ranch)
            ranch.interrupt()
            self.assertEqual(INTERRUPTED, ranch.exit_code(60), ranch.words())
            suggested = next(line for line in ranch.words().splitlines()
                             if line.startswith("resume "))
        words = shlex.split(suggested)
        self.assertEqual(["resume", "roslaunch", "aquafarm_bringup", "train.launch"], words[:4])
        self.assertEqual(["resume:=true", f"run_dir:={self.run_dir}"], words[-2:])
        with self.train(*words[4:-1]) as ranch:  # the limit is that of the run
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
        parts, self.run_dir = self.run_dir, self.run_dir.parent / "whole"
        with self.train(*begun) as ranch:
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
        for name in ("metrics.csv", "policy.ckpt", "evaluation.csv"):
            self.assertEqual((self.run_dir / name).read_bytes(), (parts / name).read_bytes(), name)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "train_launch", TrainLaunchTest, sys.argv)
