#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Episodes recorded during a training are complete and verifiable, also if the farm is killed."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, verify  # noqa: E402

TRAIN = ["algorithm:=q_learning", "farms:=1", "evaluation_episodes:=0", "random_episodes:=0",
         "viz:=false"]
INDEX = b"index_pos="  # field of a bag's header; its value is 0 until the bag is closed
FIRST_CHUNK = 4117  # offset of the first chunk in every bag [bytes]
CHUNK = b"op=\x05"


def second_chunk(content):
    """Returns the offset of a bag's second chunk, or None if its header is not complete."""
    begin = FIRST_CHUNK
    while begin + 4 <= len(content):
        data = begin + 4 + int.from_bytes(content[begin:begin + 4], "little")
        if data > len(content):
            return None
        if begin > FIRST_CHUNK and CHUNK in content[begin + 4:data]:
            return begin
        begin = data + 4 + int.from_bytes(content[data:data + 4], "little")
    return None


def is_stopped(pid):
    """Returns whether each thread of a process is suspended."""
    try:
        return all((task / "stat").read_text().rpartition(")")[2].split()[0] == "T"
                   for task in pathlib.Path(f"/proc/{pid}/task").iterdir())
    except OSError:  # a thread has just ended
        return False


def reindex(bag):
    subprocess.run(["rosbag", "reindex", "--force", str(bag)], check=True, timeout=60,
                   capture_output=True)


class KeepEpisodesTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_keep_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def bags(self):
        return sorted(self.folder.rglob("episode_*.bag"))

    def cut(self, whole, end):
        """Writes the first bytes of a bag as a killed recorder leaves them; returns the new bag."""
        data = bytearray(whole.read_bytes()[:end])
        place = data.index(INDEX) + len(INDEX)
        data[place:place + 8] = bytes(8)
        bag = self.folder / "cut.bag"
        bag.write_bytes(data)
        return bag

    def half_written(self):
        """Returns an unfinished bag that `rosbag reindex` can repair, or None.

        The file contains the first chunk, the index of this chunk and the header of the second one.
        """
        for bag in self.folder.rglob("*.partial"):
            try:
                content = bag.read_bytes()
            except FileNotFoundError:  # it is complete now
                continue
            if int.from_bytes(content[content.find(INDEX) + len(INDEX):][:8], "little") != 0:
                continue  # it is complete but not renamed yet
            if second_chunk(content):
                return bag
        return None

    def stop_in_a_bag(self, pid, limit_s):
        """Stops a sim node between the first and the last chunk of a bag; returns the bag."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if self.half_written():
                os.kill(pid, signal.SIGSTOP)
                try:
                    while not is_stopped(pid) and time.monotonic() < end:
                        time.sleep(0.001)
                    bag = self.half_written()
                except BaseException:
                    os.kill(pid, signal.SIGCONT)
                    raise
                if bag and is_stopped(pid):
                    return bag
                os.kill(pid, signal.SIGCONT)
            time.sleep(0.001)
        self.fail(f"no bag of several chunks was written within {limit_s} s")

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
            pid = ranch.node_pid("sim_node")
            cut = self.stop_in_a_bag(pid, 60)
            os.kill(pid, signal.SIGKILL)
            ranch.exit_code(60)
        self.assertGreaterEqual(len(self.bags()), 5)
        code, words = verify(*self.bags()[-20:])  # there may be hundreds
        self.assertEqual(0, code, words)
        self.assertEqual([cut], list(self.folder.rglob("*.partial")))
        reindex(cut)
        code, words = verify(cut)
        self.assertEqual(0, code, words)
        # Only the last steps of the episode may be missing.
        self.assertRegex(words, r": identical: 1 episode, \d+ steps"
                         r"(, episodes without their end: 1)?\n")

    def test_a_recording_that_was_cut_off_is_reported_and_can_be_reindexed(self):
        with Ranch("evaluate", "policy:=random", "episodes:=1", "record:=all", "viz:=false",
                   f"record_dir:={self.folder}") as ranch:
            self.assertEqual(0, ranch.exit_code(60), ranch.words())
        whole = self.bags()[0]
        # Two moments of a kill while the bag is closed: before the index is written, and after the
        # index but before the header that points to it.
        with rosbag.Bag(str(whole)) as bag:
            chunks_end = bag._index_data_pos
        for end in (chunks_end, whole.stat().st_size):
            cut = self.cut(whole, end)
            code, words = verify(cut)
            self.assertEqual(2, code, words)
            self.assertIn("its recorder was killed; run 'rosbag reindex' first", words)
            reindex(cut)
            code, words = verify(cut)
            self.assertEqual(0, code, words)
        # Nothing can be repaired before the index of the first chunk is complete.
        cut = self.cut(whole, second_chunk(whole.read_bytes()) - 1)
        reindex(cut)
        code, words = verify(cut)
        self.assertEqual(2, code, words)
        self.assertIn("cut.bag: damaged: ", words)

    def test_a_wrong_choice_ends_the_launch_with_its_line(self):
        with Ranch("evaluate", "policy:=random", "record:=some", "viz:=false") as ranch:
            self.assertEqual(2, ranch.exit_code(60), ranch.words())
            self.assertIn("~keep: got 'some', expected none, all, every:N, best, worst or failures",
                          ranch.words())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "keep_episodes", KeepEpisodesTest, sys.argv)
