#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Start and end of the sim node: refused parameters, shutdown and recording."""
import os
import signal
import subprocess
import sys
import unittest

import roslib.packages
import rospy
import rostest
from aquafarm_msgs.msg import FarmSpec, FarmState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import LIMIT_S, Recorder, call  # noqa: E402

SIM_NODE = roslib.packages.find_node("aquafarm_sim", "sim_node")[0]
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")
LONE = os.path.join(DATA, "lone.yaml")


def start(*arguments):
    """Starts a sim node with a unique name, so that no parameters of other nodes remain."""
    start.count = getattr(start, "count", 0) + 1
    return subprocess.Popen([SIM_NODE, f"__name:=sim_{start.count}", *arguments], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


class SimNodeStartTest(unittest.TestCase):

    def refusal(self, *arguments):
        process = start(*arguments)
        words = process.communicate(timeout=LIMIT_S)[0]
        self.assertEqual(2, process.returncode, words)
        return words

    def test_an_unknown_scenario_is_answered_with_those_there_are(self):
        words = self.refusal("_scenario:=papr")
        self.assertIn("scenario: got 'papr', expected the path of a file or one of ", words)
        self.assertIn("paper", words)

    def test_an_unknown_parameter_is_refused(self):
        self.assertIn("~farm: unknown parameter (did you mean 'farms'?), expected one of: scenario,",
                      self.refusal("_scenario:=" + LONE, "_farm:=3"))

    def test_parameters_out_of_range_are_refused(self):
        for argument, words in (("_rate_hz:=-1", "rate_hz: got -1, expected [0.001, 1000]"),
                                ("_farms:=0", "farms: got 0, expected [1, 4096]"),
                                ("_farms:=many", "farms: got another type"),
                                ("_seed:=1.5", "~seed: got 1.5, expected a whole number"),
                                ("_pace:=fast", "pace: got 'fast', expected lockstep or paced")):
            self.assertIn(words, self.refusal("_scenario:=" + LONE, argument))

    def test_interrupted_or_terminated_it_ends_with_zero(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = start("_scenario:=" + LONE, "_pace:=paced")
            rospy.wait_for_service("get_state", timeout=LIMIT_S)
            process.send_signal(number)
            words = process.communicate(timeout=LIMIT_S)[0]
            self.assertEqual(0, process.returncode, words)

    def test_recording_publishes_every_step(self):
        process = start("_scenario:=" + LONE, "_record:=true", "_publish_hz:=1")
        self.addCleanup(process.communicate)
        self.addCleanup(process.terminate)
        recorder = Recorder("state", FarmState)
        specs = Recorder("spec", FarmSpec)
        rospy.wait_for_service("command", timeout=LIMIT_S)
        recorder.wait(len, "a first state")
        specs.wait(len, "a first spec")
        reset = call("reset", has_seed=True, seed=4)
        for step in range(300):
            call("step", actions=[step % 10])
        recorder.wait(lambda m: (m[-1].episode, m[-1].step) == (1, 99), "the last step")
        numbers = [(m.seed, m.episode, m.step) for m in recorder.messages]
        begin = numbers.index((4, reset.episode, 0))
        self.assertEqual([(4, 0, k) for k in range(201)] + [(4, 1, k) for k in range(100)],
                         numbers[begin:])
        stamps = [m.header.stamp.to_nsec() for m in recorder.messages]
        self.assertEqual(sorted(set(stamps)), stamps)
        self.assertEqual([0, 1], [m.episode for m in specs.messages if m.seed == 4])


if __name__ == "__main__":
    rospy.init_node("sim_node_start_test")
    rostest.rosrun("aquafarm_sim", "sim_node_start", SimNodeStartTest, sys.argv)
