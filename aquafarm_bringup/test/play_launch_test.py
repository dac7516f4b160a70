#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A ship is driven from a terminal through play.launch, as a user would do it."""
import os
import pathlib
import pty
import shutil
import sys
import tempfile
import unittest

import rosbag
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, verify  # noqa: E402

START_LIMIT_S = 60
KEY_LIMIT_S = 60


class PlayLaunchTest(unittest.TestCase):

    def setUp(self):
        self._keys, self._terminal = pty.openpty()
        self.addCleanup(os.close, self._keys)
        self.addCleanup(os.close, self._terminal)

    def play(self, *arguments):
        return Ranch("play", "viz:=false", *arguments, stdin=self._terminal)

    def episode_of(self, bag):
        """Returns the summary of the episode in a bag."""
        with rosbag.Bag(str(bag)) as source:
            found = [message for topic, message, _ in source.read_messages()
                     if topic.endswith("/episode")]
        self.assertEqual(1, len(found))
        return found[0]

    def press(self, ranch, key, words):
        """Presses a key and waits for the expected output."""
        os.write(self._keys, key)
        ranch.wait_for(lambda: words in ranch.words(), KEY_LIMIT_S)

    def test_keys_drive_the_ship_and_q_ends_with_zero(self):
        with self.play() as ranch:
            ranch.wait_for(lambda: "driving ship 0" in ranch.words(), START_LIMIT_S)
            self.press(ranch, b"\x1b[A", "N        step 1: ")
            self.press(ranch, b"p", "pickup   step 2: illegal pickup, reward -10")
            self.press(ranch, b"m", "disaster 0 at (")
            self.press(ranch, b"r", "episode 1 of seed 1")
            self.press(ranch, b"7", "got ship 7, expected one of 0 to 0")
            self.press(ranch, b"x", "no such key: 'x'")
            os.write(self._keys, b"q")
            self.assertEqual(0, ranch.exit_code(60))

    def test_each_finished_episode_is_kept_in_a_bag_that_verifies(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_played_"))
        self.addCleanup(shutil.rmtree, folder)
        scenario = folder / "short.yaml"
        scenario.write_text("name: short\ngrid: {width: 6, height: 6}\ntime: {step_limit: 2}\n"
                            "layout: {rocks: {count: [0, 0]}, ports: {count: 1}, "
                            "devices: {count: 1}}\n")
        with self.play(f"scenario:={scenario}", f"record_dir:={folder}/played",
                       "evaluation_seed:=1000") as ranch:
            ranch.wait_for(lambda: "driving ship 0" in ranch.words(), START_LIMIT_S)
            self.assertIn(f"episode 0 of seed {1000 | 1 << 63}", ranch.words())
            self.press(ranch, b"k", "N        step 1: ")
            self.press(ranch, b"p", "the episode is over: step limit")
            self.press(ranch, b"r", "episode 1 of seed")
            self.press(ranch, b"k", "N        step 1: ")  # abandoned
            os.write(self._keys, b"q")
            self.assertEqual(0, ranch.exit_code(20))
        bags = list((folder / "played").glob("*.bag"))
        self.assertEqual(1, len(bags), bags)
        code, words = verify(*bags)
        self.assertEqual(0, code, words)
        summary = self.episode_of(bags[0])
        self.assertEqual((0, 1000 | 1 << 63, 2),
                         (summary.episode, summary.seed, summary.steps))

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
