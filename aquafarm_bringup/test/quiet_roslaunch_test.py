#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""quiet_roslaunch prints what nodes print, and roslaunch's own messages only if something failed."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import free_port  # noqa: E402

PROGRAM = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "quiet_roslaunch"
LAUNCH = """<launch>
  <param name="speed" value="4"/>
  <node pkg="aquafarm_bringup" type="run_node" name="node" required="true" output="screen"
        args="{}"/>
</launch>
"""


class QuietRoslaunchTest(unittest.TestCase):

    def launch(self, command, *arguments):
        """Launches a node that runs a command; returns (exit code, output)."""
        port = free_port()
        with tempfile.NamedTemporaryFile("w", suffix=".launch") as file:
            file.write(LAUNCH.format(command))
            file.flush()
            done = subprocess.run(
                [PROGRAM, "-p", str(port), file.name, *arguments], text=True, timeout=60,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                check=False, env=dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{port}"))
        return done.returncode, done.stdout

    def test_a_good_end_shows_the_node_s_lines_alone(self):
        code, words = self.launch("echo hello")
        self.assertEqual(0, code, words)
        self.assertEqual(1, len(words.splitlines()), words)
        self.assertTrue(words.startswith("hello "), words)  # roslaunch adds arguments

    def test_a_failed_node_is_reported_without_colours(self):
        words = self.launch("false")[1]
        self.assertIn("REQUIRED process [node", words)
        self.assertIn("exit code 1", words)
        self.assertNotIn("\x1b", words)
        self.assertNotIn("PARAMETERS", words)

    def test_a_signal_while_the_launch_file_is_loaded_ends_it_without_a_word(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "roslaunch.py").write_text(
                "import os, sys, time\n"
                "def main(words):\n    os.kill(os.getpid(), int(words[1]))\n    time.sleep(50)\n")
            for number in (signal.SIGINT, signal.SIGTERM):
                done = subprocess.run(
                    ["env", "--default-signal=INT", PROGRAM, str(int(number))], text=True, timeout=40,
                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                    env=dict(os.environ, PYTHONPATH=folder))
                self.assertEqual((130, ""), (done.returncode, done.stdout), number)

    def test_what_roslaunch_refuses_is_shown(self):
        code, words = self.launch("echo hello", "other:=1", "--no-such-option")
        self.assertNotEqual(0, code)
        self.assertIn("no such option: --no-such-option", words)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "quiet_roslaunch", QuietRoslaunchTest, sys.argv)
