#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Key handling and output of the keyboard node."""
import contextlib
import io
import os
import pathlib
import pty
import subprocess
import sys
import unittest
from unittest import mock

import rospy
import rostest
from aquafarm_msgs.msg import (Cell, CommandResult, DeviceState, DisasterState, FarmSpec, FarmState,
                               Outcome, PortInfo, RewardTerms, RockInfo, ShipState)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import load_script  # noqa: E402

keyboard = load_script("keyboard")


class KeyboardTest(unittest.TestCase):

    def test_an_arrow_key_is_one_key(self):
        self.assertEqual(["\x1b[A", "p", "\x1bOC"], keyboard.split_keys("\x1b[Ap\x1bOC"))

    def test_every_action_has_a_key(self):
        self.assertLessEqual(set(keyboard.ACTIONS), set(keyboard.KEYS.values()))

    def test_a_step_is_shown_with_its_terms_and_the_legal_actions(self):
        result = CommandResult(ok=True, code=Outcome.CRASH, step=7, reward=-2.5,
                               terms=RewardTerms(crash=-2.5), legal_actions=0x1FF)
        self.assertEqual("step 7: crash, reward -2.5 (crash -2.5); legal: moves, pickup",
                         keyboard.describe(result))

    def test_the_end_is_shown_with_its_reason(self):
        result = CommandResult(ok=True, terminated=True, reason=FarmState.ALL_RETRIEVED)
        self.assertIn("the episode is over: all retrieved", keyboard.describe(result))

    def test_a_refusal_is_shown_with_its_code(self):
        result = CommandResult(code=Outcome.EPISODE_OVER, message="reset first")
        self.assertEqual("episode over: reset first", keyboard.describe(result))

    def test_only_decimal_digits_choose_a_ship(self):
        node = keyboard.Keyboard.__new__(keyboard.Keyboard)
        node._spec, node._ship = FarmSpec(agents=2), 0
        with contextlib.redirect_stdout(io.StringIO()) as shown:
            for key in ("²", "٣", "1"):
                self.assertTrue(node.act(key))
        self.assertEqual([*(f"no such key: '{key}'; ? lists the keys" for key in "²٣"),
                          "driving ship 1"], shown.getvalue().splitlines())

    def test_a_service_without_a_response_is_shown_without_an_outcome(self):
        node = keyboard.Keyboard.__new__(keyboard.Keyboard)
        node._spec, node._state, node._ship = FarmSpec(agents=1), FarmState(), 0
        error = rospy.ServiceException("ship_0/move did not respond within 15 s")
        with mock.patch.object(keyboard, "call", side_effect=error), \
                mock.patch.object(rospy, "is_shutdown", return_value=False), \
                contextlib.redirect_stdout(io.StringIO()) as shown:
            self.assertTrue(node.act("k"))
        self.assertEqual("N        no result: ship_0/move did not respond within 15 s\n",
                         shown.getvalue())

    def test_the_map_has_north_at_the_top(self):
        spec = FarmSpec(width=3, height=2, islands=[Cell(0, 0)], ports=[PortInfo(0, Cell(1, 0))],
                        rocks=[RockInfo(Cell(2, 1), -3.0)])
        state = FarmState(ships=[ShipState(id=0, x=1, y=1, active=True)],
                          devices=[DeviceState(x=2, y=0)])
        self.assertEqual(".0o\n#Pd", keyboard.draw_map(spec, state))

    def test_the_map_shows_the_area_of_a_disaster(self):
        spec = FarmSpec(width=5, height=3)
        storm = DisasterState(x=2, y=1, radii=[0.5, 1], risks=[-20, -5], steps_left=9, known=True)
        drawn = keyboard.draw_map(spec, FarmState(disasters=[storm]))
        self.assertEqual("..~..\n.~~~.\n..~..", drawn[:17])
        # Only to the north-east; due east is a part of the south-east.
        storm.quadrants = [0.5, 0.5, 0.5, 0.5, 2, 0, 0, 0]
        drawn = keyboard.draw_map(spec, FarmState(disasters=[storm]))
        self.assertEqual("..~~.\n..~..\n.....", drawn[:17])
        storm.steps_left = 0
        self.assertNotIn("~", keyboard.draw_map(spec, FarmState(disasters=[storm])))

    def test_an_unknown_parameter_of_the_node_is_refused_with_those_it_has(self):
        self.assertEqual("~shpi: unknown parameter (did you mean 'ship'?), expected one of: ship, evaluation_seed",
                         keyboard.unknown_parameter("/a/keyboard", ["/a/keyboard/ship", "/run_id",
                                                                    "/a/keyboard/shpi"]))
        self.assertEqual("", keyboard.unknown_parameter("/a/keyboard", [
            "/a/keyboard/ship", "/a/keyboard_2/speed", "/b/a/keyboard/speed", "/a/keyboard"]))

    def test_a_started_node_refuses_an_unknown_parameter(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        self.addCleanup(os.close, theirs)
        done = subprocess.run([keyboard.__file__, "__name:=keys", "_shpi:=1"], stdin=theirs, text=True,
                              stderr=subprocess.PIPE, timeout=60, check=False)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn("keyboard: ~shpi: unknown parameter (did you mean 'ship'?)", done.stderr)

    def test_without_a_terminal_it_says_what_it_needs(self):
        done = subprocess.run([keyboard.__file__], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True, timeout=60, check=False)
        self.assertEqual(2, done.returncode)
        self.assertIn("input is not a terminal", done.stderr)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "keyboard", KeyboardTest, sys.argv)
