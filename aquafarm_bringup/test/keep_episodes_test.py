#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Episodes kept while a ranch is trained on: whole, verifiable, also when the farm is killed."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, verify  # noqa: E402

TRAIN = ["algorithm:=q_learning", "farms:=1", "evaluation_episodes:=0", "random_episodes:=0",
         "viz:=false"]


class KeepEpisodesTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_keep_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def bags(self):
        return sorted(self.folder.rglob("episode_*.bag"))

    def test_a_training_keeps_every_episode_in_its_run_folder(self):
        with Ranch("train", *TRAIN, "episodes:=8", "record:=all",
                   f"run_dir:={self.folder / 'run'}") as ranch:
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
            self.assertIn("keeping episodes (all) in", ranch.words())
        self.assertEqual([f"episode_{i:08d}_seed_1" for i in range(8)],
                         [bag.name.split("_return_")[0] for bag in self.bags()])
        self.assertEqual({self.folder / "run" / "episodes"}, {bag.parent for bag in self.bags()})
        code, words = verify(*self.bags())
        self.assertEqual(0, code, words)
        self.assertEqual(8, words.count(": identical: 1 episode, "), words)
        with rosbag.Bag(str(self.bags()[0])) as bag:
            topics = bag.get_type_and_topic_info().topics
            self.assertLessEqual({f"/aquafarm/{name}" for name in (
                "spec", "state", "chart", "risk", "episode")}, set(topics))
            self.assertEqual("lz4", bag.get_compression_info().compression)
            summary = next(bag.read_messages("/aquafarm/episode")).message
            self.assertEqual(summary.steps + 1, topics["/aquafarm/state"].message_count)
            self.assertIn(f"_return_{summary.episode_return:+.1f}.bag", self.bags()[0].name)

    def test_a_killed_farm_leaves_only_whole_bags(self):
        with Ranch("train", *TRAIN, "episodes:=100000", "record:=all", "sim_restarts:=0",
                   "sim_timeout_s:=1", f"run_dir:={self.folder / 'run'}") as ranch:
            ranch.wait_for(lambda: len(self.bags()) >= 5, 60)
            os.kill(ranch.node_pid("sim_node"), signal.SIGKILL)
            ranch.exit_code(60)
        self.assertGreaterEqual(len(self.bags()), 5)
        code, words = verify(*self.bags())
        self.assertEqual(0, code, words)
        self.assertLessEqual(len(list(self.folder.rglob("*.active"))), 1)

    def test_a_recording_that_was_cut_off_is_told_so_and_can_be_reindexed(self):
        with Ranch("evaluate", "policy:=random", "episodes:=1", "record:=all", "viz:=false",
                   f"record_dir:={self.folder}") as ranch:
            self.assertEqual(0, ranch.exit_code(60), ranch.words())
        whole = self.bags()[0]
        cut = self.folder / "cut.bag"
        # What a kill leaves: chunks without the index that closing writes at the end.
        with rosbag.Bag(str(whole)) as bag:
            end = bag._index_data_pos
        data = bytearray(whole.read_bytes()[:end])
        place = data.index(b"index_pos=") + len(b"index_pos=")
        data[place:place + 8] = bytes(8)
        cut.write_bytes(data)
        code, words = verify(cut)
        self.assertEqual(2, code, words)
        self.assertIn("its recording was killed; 'rosbag reindex' it first", words)
        subprocess.run(["rosbag", "reindex", str(cut)], check=True, timeout=60,
                       capture_output=True)
        code, words = verify(cut)
        self.assertEqual(0, code, words)

    def test_a_wrong_choice_ends_the_launch_with_its_line(self):
        with Ranch("evaluate", "policy:=random", "record:=some", "viz:=false") as ranch:
            self.assertEqual(2, ranch.exit_code(60), ranch.words())
            self.assertIn("~keep: got 'some', expected none, all, every:N, best, worst or failures",
                          ranch.words())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "keep_episodes", KeepEpisodesTest, sys.argv)
