#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The main job on real input, In-Fa 2021 off Dongji: train, record, verify and replay."""
import json
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
from sensor_msgs.msg import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, free_port, verify  # noqa: E402


class MainJobTest(unittest.TestCase):

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_main_job_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def train(self):
        """Trains with one command; returns its run folder and the results of greedy and RANDOM."""
        run = self.folder / "run"
        with Ranch("train", "scenario:=zhoushan_infa_2021", "steps:=3000000", "viz:=false",
                   "evaluation_episodes:=100", "random_episodes:=50",
                   f"run_dir:={run}") as ranch:
            self.assertEqual(0, ranch.exit_code(150), ranch.words())
        return run, *(json.loads((run / f"{name}.json").read_text())
                      for name in ("evaluation", "evaluation_random"))

    def record(self, run):
        """Records an episode of the trained policy; returns its bag."""
        with Ranch("evaluate", "scenario:=zhoushan_infa_2021", f"policy:={run}", "episodes:=1",
                   "record:=all", "viz:=false", f"record_dir:={self.folder}") as ranch:
            self.assertEqual(0, ranch.exit_code(60), ranch.words())
        bags = list(self.folder.glob("episode_*.bag"))
        self.assertEqual(1, len(bags))
        return bags[0]

    def replay(self, bag):
        """Replays the bag without a simulator and collects pictures that differ from each other."""
        pictures = set()
        with Ranch("replay", f"bag:={bag}", "headless:=true", port=free_port()) as ranch:
            os.environ.update(ranch.environment)
            ranch.wait_for(rosgraph.is_master_online, 60)
            rospy.init_node("main_job_test", disable_signals=True)
            subscriber = rospy.Subscriber("/aquafarm/image", Image,
                                          lambda image: pictures.add(hash(bytes(image.data))))
            self.addCleanup(subscriber.unregister)
            ranch.wait_for(lambda: len(pictures) > 3, 60)

    def test_a_policy_for_in_fa_beats_random_and_its_bag_replays(self):
        run, greedy, chance = self.train()
        self.assertGreaterEqual(greedy["success_rate"], 0.95)
        self.assertLess(chance["success_rate"], 0.05)
        self.assertGreater(greedy["return_per_episode"], chance["return_per_episode"] + 1000)
        bag = self.record(run)
        code, words = verify(bag)
        self.assertEqual(0, code, words)
        with rosbag.Bag(str(bag)) as opened:
            spec = next(opened.read_messages("/aquafarm/spec")).message
            self.assertEqual("zhoushan_infa_2021", spec.scenario_name)
            states = [m.message for m in opened.read_messages("/aquafarm/state")]
        self.assertNotEqual((states[0].disasters[0].x, states[0].disasters[0].y),
                            (states[-1].disasters[0].x, states[-1].disasters[0].y))
        self.replay(bag)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "main_job", MainJobTest, sys.argv)
