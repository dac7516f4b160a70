#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The Python module aquafarm_core: what it writes, where it writes it, and what it refuses."""
import pathlib
import threading
import time
import unittest

import aquafarm_core as core
import numpy as np
import rostest

DATA = pathlib.Path(__file__).resolve().parent / "data"
PAPER = core.Scenario.load(f"{core.SCENARIO_FOLDER}/paper.yaml")


def actions_of(seed, batch, count):
    """`count` joint actions, drawn."""
    return np.random.default_rng(seed).integers(
        0, len(core.ACTIONS), (count, batch.farms, batch.agents)).astype(np.uint8)


class CoreTest(unittest.TestCase):
    def test_writes_into_the_callers_memory(self):
        batch = core.FarmBatch(PAPER, 4)
        replay = np.zeros((2, 4, 1, 8, 25, 25), np.uint8)
        batch.bind("planes", replay[1])
        batch.reset(1)
        self.assertFalse(replay[0].any())
        self.assertEqual(replay[1, :, 0, core.PLANES.index("self")].sum(), 4 * 255)
        self.assertIs(batch.buffers["planes"].base, replay)

    def test_arrays_that_do_not_fit_are_refused(self):
        batch = core.FarmBatch(PAPER, 4)
        right = np.zeros((4, 1), np.float32)
        read_only = right.copy()
        read_only.flags.writeable = False
        for wrong, got in ((np.zeros((4, 1)), "float64 [4, 1]"),
                           (np.zeros((4,), np.float32), "float32 [4]"),
                           (np.zeros((4, 2), np.float32)[:, :1], "float32 [4, 1]"),
                           (read_only, "float32 [4, 1]")):
            with self.assertRaises(ValueError) as refusal:
                batch.bind("rewards", wrong)
            self.assertEqual(str(refusal.exception), f"rewards: got {got}, expected writeable "
                             "row-major float32 [4, 1]")
        with self.assertRaisesRegex(ValueError, "^buffer: got 'reward', expected one of: rewards,"):
            batch.bind("reward", right)

    def test_wrong_actions_change_nothing(self):
        batch = core.FarmBatch(PAPER, 2, ["hashes"])
        with self.assertRaisesRegex(ValueError, "^step: got no reset before"):
            batch.step(np.zeros((2, 1), np.uint8))
        batch.reset(1)
        before = batch.buffers["hashes"].copy()
        for wrong, words in ((np.zeros((2, 1)), "actions: got float64 [2, 1], expected row-major "
                              "uint8 [2, 1]"),
                             (np.zeros(2, np.uint8), "actions: got uint8 [2], expected row-major "
                              "uint8 [2, 1]"),
                             (np.full((2, 1), 11, np.uint8), "actions: got 11, expected [0, 10]")):
            with self.assertRaises(ValueError) as refusal:
                batch.step(wrong)
            self.assertEqual(str(refusal.exception), words)
        np.testing.assert_array_equal(batch.buffers["hashes"], before)
        self.assertEqual(batch.save(), core_after_reset(2))

    def test_other_faults_have_their_line(self):
        with self.assertRaisesRegex(ValueError, "^farms: got 0, expected at least 1$"):
            core.FarmBatch(PAPER, 0)
        with self.assertRaisesRegex(ValueError, "^x:1: name: missing"):
            core.Scenario.parse("grid: {}", "x")
        with self.assertRaisesRegex(ValueError, "^state: "):
            core.FarmBatch(PAPER).load(b"damaged")

    def test_saved_farms_go_on_bit_for_bit(self):
        batch, other = (core.FarmBatch(PAPER, 3, ["hashes", "rewards"]) for _ in range(2))
        batch.reset(5)
        actions = actions_of(1, batch, 60)
        for joint in actions[:30]:
            batch.step(joint)
        other.load(batch.save())
        for joint in actions[30:]:
            batch.step(joint)
            other.step(joint)
            for name, array in batch.buffers.items():
                np.testing.assert_array_equal(array, other.buffers[name])

    def test_rewards_are_the_sum_of_their_terms_and_finished_episodes_add_up(self):
        reef = core.Scenario.load(str(DATA / "reef.yaml"))
        batch = core.FarmBatch(reef, 8, ["rewards", "terms", "reasons", "started"])
        batch.reset(2)
        returns, ended = np.zeros(8), 0
        for joint in actions_of(3, batch, 1500):
            batch.step(joint)
            buffers = batch.buffers
            returns[buffers["started"] != 0] = 0
            played = buffers["started"] == 0
            terms = buffers["terms"].sum(axis=2, dtype=np.float32)
            np.testing.assert_allclose(buffers["rewards"][played], terms[played], atol=1e-4)
            returns += np.where(played, terms.sum(axis=1), 0)
            finished = batch.finished()
            self.assertEqual([one["farm"] for one in finished],
                             list(np.flatnonzero(buffers["reasons"])))
            for one in finished:
                ended += 1
                self.assertAlmostEqual(one["episode_return"], returns[one["farm"]], delta=0.5)
        self.assertGreater(ended, 8)

    def test_calls_of_several_threads_at_once_are_refused(self):
        batch = core.FarmBatch(PAPER, 512, ["planes"])
        batch.reset(1)
        before = time.monotonic()
        words = []

        def step():
            for _ in range(200):
                try:
                    batch.step(np.zeros((512, 1), np.uint8))
                except RuntimeError as error:
                    words.append(str(error))

        threads = [threading.Thread(target=step) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual({"FarmBatch: another thread's call still runs"}, set(words))
        batch.step(np.zeros((512, 1), np.uint8))
        self.assertLess(time.monotonic() - before, 30)

    def test_a_thousand_farms_make_millions_of_steps_a_second(self):
        batch = core.FarmBatch(PAPER, 1024, ["rewards", "reasons", "started", "index"])
        batch.reset(1)
        actions = actions_of(1, batch, 64)
        rates = []
        for _ in range(5):
            start = time.perf_counter()
            for joint in actions:
                batch.step(joint)
            rates.append(actions.size / (time.perf_counter() - start))
        print(f"farm_steps_python {np.median(rates):.3g} steps/s")
        self.assertGreater(max(rates), 5e6 if core.OPTIMISED else 1e5)


def core_after_reset(farms):
    """The bytes of farms at their start."""
    batch = core.FarmBatch(PAPER, farms)
    batch.reset(1)
    return batch.save()


if __name__ == "__main__":
    rostest.rosrun("aquafarm_gym", "core_python", CoreTest)
