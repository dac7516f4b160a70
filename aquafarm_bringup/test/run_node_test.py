#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""run_node keeps the exit code that roslaunch discards, and restarts servers."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rostest

RUN_NODE = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "run_node"
LIMIT_S = 60


class RunNodeTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.exit_file = pathlib.Path(self.folder.name, "exit")

    def run_node(self, *words):
        return subprocess.run([str(RUN_NODE), f"--exit-file={self.exit_file}", *words], text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=LIMIT_S, check=False)

    def test_the_exit_code_is_kept(self):
        self.assertEqual(7, self.run_node("sh", "-c", "exit 7").returncode)
        self.assertEqual("7\n", self.exit_file.read_text())

    def test_a_failures_last_words_are_kept_and_shown(self):
        done = self.run_node("sh", "-c", r"echo fine; printf '\033[31mno such farm\033[0m\n\n' >&2; "
                             "exit 2")
        self.assertEqual("2\nno such farm\n", self.exit_file.read_text())
        self.assertIn("no such farm", done.stdout)
        self.exit_file.unlink()
        self.run_node("sh", "-c", "echo a warning >&2")
        self.assertEqual("0\n", self.exit_file.read_text())

    def test_a_crash_is_kept(self):
        self.run_node("sh", "-c", "kill -9 $$")
        self.assertEqual("137\n", self.exit_file.read_text())

    def test_the_first_to_end_decides(self):
        self.run_node("sh", "-c", "exit 2")
        self.run_node("sh", "-c", "exit 130")
        self.assertEqual("2\n", self.exit_file.read_text())

    def test_a_server_that_refuses_ends_the_launch(self):
        self.assertEqual(2, self.run_node("--restarts=3", "sh", "-c", "exit 2").returncode)
        self.assertEqual("2\n", self.exit_file.read_text())

    def test_a_killed_server_is_started_again(self):
        mark = pathlib.Path(self.folder.name, "mark")
        done = self.run_node("--restarts=1", "sh", "-c",
                             f"test -e {mark} && exit 5; touch {mark}; kill -9 $$")
        self.assertEqual(5, done.returncode)
        self.assertIn("starting it again; restarts left: 0", done.stdout)

    def test_an_interrupted_server_leaves_no_exit_code(self):
        process = subprocess.Popen([str(RUN_NODE), f"--exit-file={self.exit_file}", "--restarts=3",
                                    "sleep", "60"], start_new_session=True)
        time.sleep(0.5)
        os.killpg(process.pid, signal.SIGINT)
        self.assertEqual(0, process.wait(timeout=LIMIT_S))
        self.assertFalse(self.exit_file.exists())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "run_node", RunNodeTest, sys.argv)
