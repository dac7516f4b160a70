#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A bag contains complete episodes, and replay shows them without a simulator."""
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import rosbag
import rosgraph
import rospy
import rostest
from sensor_msgs.msg import CompressedImage, Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, free_port  # noqa: E402

EPISODES = 2
PORT = free_port()


class RecordReplayTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_bag_"))
        cls.bag = cls.folder / "day.bag"
        with Ranch("record", "of:=evaluate", "policy:=random", f"episodes:={EPISODES}",
                   f"bag:={cls.bag}", "viz:=false", "rate_hz:=100") as ranch:
            cls.code = ranch.exit_code(90)
            cls.words = ranch.words()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def messages(self, *topics):
        with rosbag.Bag(str(self.bag)) as bag:
            return [message for _, message, _ in bag.read_messages(topics)]

    def test_recording_ends_with_zero_and_a_closed_bag(self):
        self.assertEqual(0, self.code, self.words)
        self.assertIn("day.bag", [path.name for path in self.folder.iterdir()])
        self.assertFalse(list(self.folder.glob("*.active")))

    def test_the_spec_of_each_episode_says_which_it_is(self):
        specs = self.messages("/aquafarm/spec")
        self.assertTrue(specs)
        states = self.messages("/aquafarm/state")
        self.assertLessEqual({state.episode for state in states}, {spec.episode for spec in specs})
        for spec in specs:
            self.assertTrue(spec.version and spec.scenario_name and spec.scenario_hash)

    def test_the_steps_of_each_episode_are_without_a_gap(self):
        episodes = {}
        for state in self.messages("/aquafarm/state"):
            steps = episodes.setdefault(state.episode, [])
            if not steps or steps[-1] != state.step:  # the last state is latched
                steps.append(state.step)
        self.assertGreaterEqual(len(episodes), EPISODES)
        for episode, steps in episodes.items():
            self.assertEqual(list(range(len(steps))), steps, episode)

    def test_every_state_has_a_hash_and_stamps_only_grow(self):
        states = self.messages("/aquafarm/state")
        self.assertTrue(all(state.hash for state in states))
        stamps = [state.header.stamp for state in states]
        self.assertEqual(sorted(stamps), stamps)

    def test_the_summaries_agree_with_the_states(self):
        last = {state.episode: state for state in self.messages("/aquafarm/state")}
        summaries = [s for s in self.messages("/aquafarm/episode") if s.farm == 0]
        self.assertGreaterEqual(len(summaries), EPISODES)
        for summary in summaries:
            self.assertEqual(summary.steps, last[summary.episode].step)
            self.assertEqual(summary.reason, last[summary.episode].reason)

    def test_replay_draws_the_bag_and_no_farm_runs(self):
        images, compressed = [], []
        with Ranch("replay", f"bag:={self.bag}", "headless:=true", port=PORT) as ranch:
            os.environ.update(ranch.environment)
            ranch.wait_for(rosgraph.is_master_online, 60)
            rospy.init_node("replay_test", disable_signals=True)
            rospy.Subscriber("/aquafarm/image", Image, images.append)
            rospy.Subscriber("/aquafarm/image/compressed", CompressedImage, compressed.append)
            ranch.wait_for(
                lambda: compressed and len({bytes(image.data) for image in images}) > 1, 60)
            nodes = rosgraph.Master("/replay_test").getSystemState()
            names = {name for kind in nodes for _, users in kind for name in users}
            self.assertLessEqual({"/aquafarm/viz", "/aquafarm/replay"}, names)
            self.assertNotIn("/aquafarm/sim", names)
        self.assertGreater(images[0].width * images[0].height, 0)

    def test_a_bag_holds_what_other_viewers_draw_and_replay_draws_it_again(self):
        bag = self.folder / "drawn.bag"
        with Ranch("record", "of:=evaluate", "policy:=random", "episodes:=1", f"bag:={bag}",
                   "rate_hz:=100") as ranch:
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
        with rosbag.Bag(str(bag)) as opened:
            topics = opened.get_type_and_topic_info().topics
        self.assertEqual("visualization_msgs/MarkerArray", topics["/aquafarm/markers"].msg_type)
        self.assertEqual("nav_msgs/Path", topics["/aquafarm/ship_0/route"].msg_type)
        port = free_port()
        with Ranch("replay", f"bag:={bag}", "headless:=true", port=port) as ranch:
            master = rosgraph.Master("/who", master_uri=f"http://127.0.0.1:{port}")

            def drawers():
                try:
                    return dict(master.getSystemState()[0]).get("/aquafarm/markers")
                except OSError:
                    return None
            ranch.wait_for(drawers, 60)
            ranch.wait_for(lambda: "/aquafarm/replay" in {
                name for _, users in master.getSystemState()[0] for name in users}, 60)
            self.assertEqual(["/aquafarm/viz"], drawers())

    def test_a_bag_that_cannot_be_written_or_read_leaves_a_code(self):
        with Ranch("record", "of:=evaluate", "policy:=random", "bag:=/nowhere/x.bag",
                   "viz:=false") as ranch:
            self.assertNotIn(ranch.exit_code(60), (0, 130), ranch.words())
        with Ranch("replay", "bag:=/nowhere/x.bag", "headless:=true") as ranch:
            self.assertNotEqual(0, ranch.exit_code(60), ranch.words())

    def test_a_path_with_a_blank_is_one_path(self):
        bag = self.folder / "a day.bag"
        with Ranch("record", "of:=evaluate", "policy:=random", "episodes:=1", f"bag:={bag}",
                   "viz:=false", "rate_hz:=100") as ranch:
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
        self.assertTrue(bag.exists())
        bag.unlink()


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "record_replay", RecordReplayTest, sys.argv)
