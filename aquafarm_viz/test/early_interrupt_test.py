#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends viz_node also during the first 0.6 s after its start."""
import signal
import subprocess
import sys
import time
import unittest

import roslib.packages
import rostest

LIMIT_S = 60  # roslaunch kills a node after 15 s, ./aquafarm after 120 s
DELAYS_S = [0.04 * i for i in range(1, 16)]


class EarlyInterruptTest(unittest.TestCase):

    def start(self):
        program, = roslib.packages.find_node("aquafarm_viz", "viz_node")
        process = subprocess.Popen([program, "__name:=viz_early"], stderr=subprocess.PIPE,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_an_interrupt_during_the_start_ends_the_node(self):
        lost = []
        for delay in DELAYS_S:
            process = self.start()
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            try:
                process.wait(LIMIT_S)
            except subprocess.TimeoutExpired:
                lost.append(round(delay, 2))
                process.kill()
                break
        self.assertEqual([], lost, "seconds after the start at which Ctrl-C was lost")


if __name__ == "__main__":
    rostest.rosrun("aquafarm_viz", "early_interrupt_test", EarlyInterruptTest, sys.argv)
