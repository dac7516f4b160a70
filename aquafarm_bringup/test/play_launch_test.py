#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A ship is driven from a terminal through play.launch, as a user would do it."""
import os
import pathlib
import pty
import sys
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch  # noqa: E402

START_LIMIT_S = 60
KEY_LIMIT_S = 60


class PlayLaunchTest(unittest.TestCase):

    def setUp(self):
        self._keys, self._terminal = pty.openpty()
        self.addCleanup(os.close, self._keys)
        self.addCleanup(os.close, self._terminal)

    def play(self, *arguments):
        return Ranch("play", "viz:=false", *arguments, stdin=self._terminal)

    def press(self, ranch, key, words):
        """Presses a key and waits for the expected output."""
        os.write(self._keys, key)
        ranch.wait_for(lambda: words in ranch.words(), KEY_LIMIT_S)

    def test_keys_drive_the_ship_and_q_ends_with_zero(self):
        with self.play() as ranch:
            ranch.wait_for(lambda: "driving ship 0" in ranch.words(), START_LIMIT_S)
            self.press(ranch, b"\x1b[A", "N        step 1: ")
            self.press(ranch, b"p", "pickup   step 2: ILLEGAL_PICKUP, reward -10")
            self.press(ranch, b"m", "disaster 0 at (")
            self.press(ranch, b"r", "episode 1 of seed 1")
            self.press(ranch, b"7", "got ship 7, expected one of 0 to 0")
            self.press(ranch, b"x", "no such key: 'x'")
            os.write(self._keys, b"q")
            self.assertEqual(0, ranch.exit_code(60))

    def test_a_ship_that_the_farm_has_not_is_refused_with_those_it_has(self):
        for ship in ("9", "-1", "abc"):
            with self.subTest(ship=ship), self.play(f"ship:={ship}") as ranch:
                self.assertEqual(2, ranch.exit_code(START_LIMIT_S))
                self.assertIn(f"keyboard: got ship {ship}, expected one of 0 to 0", ranch.words())

    def test_ships_that_are_not_driven_hold(self):
        with self.play("scenario:=two_squads") as ranch:
            ranch.wait_for(lambda: "driving ship 0" in ranch.words(), START_LIMIT_S)
            self.press(ranch, b"k", "N        step 1: ")
            self.press(ranch, b"1", "driving ship 1")
            self.press(ranch, b"j", "S        step 2: ")


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "play_launch", PlayLaunchTest, sys.argv)
