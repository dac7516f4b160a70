#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The sim node with two ships in partial view: the lockstep barrier, paced running, pausing."""
import os
import sys
import threading
import time
import unittest

import rospy
import rostest
from aquafarm_msgs.msg import FarmState, Outcome
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import call, message, state, states  # noqa: E402

HOLD = 10


class Caller(threading.Thread):
    """Sends one command from a separate thread."""

    def __init__(self, ship, action, **fields):
        super().__init__()
        self.fields = dict(ship=ship, action=action, **fields)
        self.result = None
        self.start()

    def run(self):
        self.result = call("command", **self.fields).result


class SimNodePairTest(unittest.TestCase):

    def setUp(self):
        self.assertTrue(call("set_pace", pace="lockstep").ok)
        self.assertTrue(call("pause", paused=False).ok)
        self.assertTrue(call("reset", has_seed=True, seed=3).ok)

    def test_the_farm_steps_when_both_ships_have_spoken(self):
        first = Caller(0, HOLD)
        time.sleep(0.2)
        self.assertEqual(0, state().step)
        second = call("ship_1/move", direction=0).result
        first.join()
        self.assertTrue(first.result.ok, first.result.message)
        self.assertEqual(1, second.step)
        self.assertEqual(second.hash, first.result.hash)

    def test_a_lone_command_times_out_and_changes_nothing(self):
        before = state().hash
        start = time.monotonic()
        result = call("ship_0/move", direction=0).result
        self.assertEqual(Outcome.TIMEOUT, result.code, result.message)
        self.assertLess(time.monotonic() - start, 30.0)
        self.assertEqual(before, state().hash)

    def test_a_barrier_timeout_is_a_warning_in_the_diagnostics(self):
        warnings = []

        def take(array):
            status = array.status[0]
            if status.level == DiagnosticStatus.WARN:
                warnings.append(status.message)

        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, take)
        while subscriber.get_num_connections() == 0:
            rospy.rostime.wallsleep(0.02)
        self.assertEqual(Outcome.TIMEOUT, call("ship_0/move", direction=0).result.code)
        end = time.monotonic() + 60
        while not warnings and time.monotonic() < end:
            rospy.rostime.wallsleep(0.05)
        self.assertEqual(["barrier timed out"], warnings[:1])

    def test_waiting_commands_block_no_other_client(self):
        waiting = [Caller(0, HOLD, token=i + 1) for i in range(20)]
        end = time.monotonic() + 60
        while sum(caller.is_alive() for caller in waiting) > 1:  # each one is superseded by the next
            self.assertLess(time.monotonic(), end, "20 commands did not arrive within 60 s")
            rospy.rostime.wallsleep(0.02)
        start = time.monotonic()
        self.assertEqual(0, state().step)
        self.assertTrue(call("save_state").ok)
        self.assertLess(time.monotonic() - start, 3.5)
        self.assertTrue(call("command", ship=1, action=HOLD).result.ok)
        for caller in waiting:
            caller.join()
        codes = [caller.result.code for caller in waiting]
        self.assertEqual(1, codes.count(Outcome.HELD), codes)
        self.assertEqual(19, codes.count(Outcome.SUPERSEDED), codes)
        self.assertEqual(1, state().step)

    def test_paced_ships_without_a_command_hold(self):
        recorder = states()
        self.assertTrue(call("set_pace", pace="paced", rate_hz=20.0).ok)
        recorder.wait(lambda m: m[-1].step >= 5, "five steps")
        self.assertTrue(all(s.outcome == Outcome.HELD for s in recorder.messages[-1].ships))
        self.assertEqual(Outcome.WRONG_PACE, call("step", actions=[0, 0]).code)

    def test_paced_commands_are_accepted_at_once(self):
        self.assertTrue(call("set_pace", pace="paced", rate_hz=0.2).ok)
        start = time.monotonic()
        result = call("ship_0/move", direction=0).result
        self.assertEqual(Outcome.ACCEPTED, result.code, result.message)
        self.assertLess(time.monotonic() - start, 4.0)
        got = message("state", FarmState, lambda m: m.step == result.step)
        self.assertNotEqual(Outcome.HELD, got.ships[0].outcome)
        self.assertEqual(Outcome.HELD, got.ships[1].outcome)

    def test_paused_nothing_advances(self):
        call("set_pace", pace="paced", rate_hz=50.0)
        call("pause", paused=True)
        before = state()
        self.assertTrue(before.paused)
        time.sleep(0.3)
        self.assertEqual(before.hash, state().hash)
        self.assertEqual(Outcome.PAUSED, call("ship_0/move", direction=0).result.code)

    def test_an_observation_hides_what_the_ship_cannot_know(self):
        whole = state()
        seen = state(observation=True, ship=1)
        self.assertEqual((1, 0), (seen.observer, seen.hash))
        self.assertEqual([(d.x, d.y) for d in whole.devices], [(d.x, d.y) for d in seen.devices])
        self.assertTrue(seen.disasters[0].known)  # from the bulletin of step 0
        published = message("ship_1/observation", FarmState)
        self.assertEqual(1, published.observer)


if __name__ == "__main__":
    rospy.init_node("sim_node_pair_test")
    rostest.rosrun("aquafarm_sim", "sim_node_pair", SimNodePairTest, sys.argv)
