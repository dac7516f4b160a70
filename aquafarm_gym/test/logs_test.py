#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the curves of runs. tools/check_python runs this file.

It needs tensorboard; the test of Weights & Biases also needs wandb.
"""
import contextlib
import importlib.util
import io
import math
import os
import pathlib
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

from aquafarm_gym import logs

HEADER = "number,total_steps,return,reason,success,loss"


def has(name):
    """Returns whether a package is installed."""
    return importlib.util.find_spec(name) is not None


def write_run(folder, rows, mode="w"):
    """Writes metrics.csv with a row for each k in `rows`: return k, and loss k (NaN for even k)."""
    folder.mkdir(exist_ok=True)
    with open(folder / "metrics.csv", mode, encoding="utf-8") as file:
        if mode == "w":
            file.write(HEADER + "\n")
        for k in rows:
            file.write(f"{k},{10 * k},{k}.0,step_limit,{k % 2},{k if k % 2 else math.nan}\n")
    return folder


def read(run):
    """Returns {tag: [(step, value)]} of the event files of a run, as TensorBoard reads them."""
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator
    events = EventAccumulator(str(run / "tensorboard"))
    events.Reload()
    return {tag: [(one.step, one.value) for one in events.Scalars(tag)]
            for tag in events.Tags()["scalars"]}


@unittest.skipUnless(has("tensorboard"), "not installed: tensorboard")
class TensorBoardTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.home = pathlib.Path(self.folder.name)

    def test_tensorboard_reads_the_means_of_windows(self):
        runs = [write_run(self.home / name, range(1, last + 1)) for name, last in (("a", 7),
                                                                                   ("b", 4))]
        self.assertEqual(logs.log_runs(runs, window=4), [2, 1])
        seen = read(runs[0])
        self.assertEqual(seen["episode/return"], [(40, 2.5), (70, 6.0)])
        self.assertEqual(seen["learner/loss"], [(40, 2.0), (70, 6.0)])  # without NaN
        self.assertEqual(seen["episode/success_rate"][0], (40, 0.5))
        self.assertEqual(set(seen), {"episode/return", "episode/success_rate", "learner/loss"})
        logs.log_runs(runs, window=4)  # a second call replaces the first
        self.assertEqual(read(runs[0]), seen)

    def test_following_adds_new_episodes_and_starts_again_after_a_resume(self):
        run = write_run(self.home / "run", range(1, 9))
        period, logs.PERIOD_S = logs.PERIOD_S, 0.05
        follower = threading.Thread(target=logs.log_runs, args=([run], "tensorboard", 2, True))
        follower.start()
        time.sleep(0.5)
        write_run(run, range(1, 4))  # resumed from a checkpoint after three episodes
        time.sleep(0.5)
        write_run(run, range(4, 7), "a")
        (run / "policy.ckpt").touch()
        follower.join(30)
        logs.PERIOD_S = period
        self.assertFalse(follower.is_alive())
        self.assertEqual(read(run)["episode/return"], [(20, 1.5), (40, 3.5), (60, 5.5)])

    def test_ctrl_c_before_all_runs_have_begun_logs_those_that_have(self):
        run = write_run(self.home / "run", range(1, 5))
        with unittest.mock.patch.object(logs.time, "sleep", side_effect=KeyboardInterrupt):
            self.assertEqual([2, 0], logs.log_runs([run, self.home / "later"], window=2, follow=True))

    def test_what_is_wrong_is_said_in_one_line(self):
        run = write_run(self.home / "run", range(1, 3))
        with open(run / "metrics.csv", "a", encoding="utf-8") as file:
            file.write("3,30,x\n")
        for given, words in ((self.home, "got no metrics.csv, expected a run folder"),
                             (run, "metrics.csv: got line '3,30,x', expected 6 cells")):
            sys.argv = ["logs", str(given)]
            with contextlib.redirect_stderr(io.StringIO()) as said:
                self.assertEqual(logs.main(), 2)
            self.assertIn(words, said.getvalue())
            self.assertEqual(said.getvalue().count("\n"), 1)

    @unittest.skipUnless(has("wandb"), "not installed: wandb")
    def test_weights_and_biases_gets_an_offline_run(self):
        run = write_run(self.home / "run", range(1, 9))
        os.environ["WANDB_SILENT"] = "true"
        self.assertEqual(logs.log_runs([run], "wandb", 4), [2])
        self.assertEqual(len(list(run.glob("wandb/offline-run-*/run-*.wandb"))), 1)


if __name__ == "__main__":
    # wandb refuses an exit code that is not an int; unittest.main gives a bool.
    sys.exit(int(not unittest.main(exit=False).result.wasSuccessful()))
