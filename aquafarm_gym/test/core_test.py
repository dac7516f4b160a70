#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the Python module aquafarm_core: contents and memory of arrays, and rejected input."""
import copy
import importlib.util
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time
import types
import unittest

import aquafarm_core as core
import numpy as np
from aquafarm_core import _abi, _native
from venv_tools import run_tests

DATA = pathlib.Path(__file__).resolve().parent / "data"
PAPER = core.Scenario.load(f"{core.SCENARIO_FOLDER}/paper.yaml")


def actions_of(seed, batch, count):
    """Returns `count` random joint actions."""
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
        for call, words in (
                (lambda: core.FarmBatch(PAPER, 0), "farms: got 0, expected a whole number in "
                 r"\[1, 1048576\]; pass the number of farms to step together$"),
                (lambda: core.FarmBatch(PAPER, 2**31), "farms: got 2147483648, expected"),
                (lambda: core.FarmBatch(PAPER, 1.5), "farms: got 1.5, expected a whole number"),
                (lambda: core.FarmBatch(PAPER, threads=-3), "threads: got -3, expected a whole "
                 r"number in \[1, 1024\]; "),
                (lambda: core.FarmBatch(PAPER).reset(2**64), "seed: got 18446744073709551616, "),
                (lambda: core.FarmBatch(PAPER).reset(1, -1), "episode: got -1, expected"),
                (lambda: core.FarmBatch(PAPER, 2).text(2), r"farm: got 2, expected .* \[0, 1\]")):
            with self.assertRaisesRegex(ValueError, f"^FarmBatch: {words}"):
                call()
        with self.assertRaisesRegex(ValueError, "^x:1: name: missing"):
            core.Scenario.parse("grid: {}", "x")
        with self.assertRaisesRegex(ValueError, "^state: "):
            core.FarmBatch(PAPER).load(b"damaged")

    def test_saved_farms_continue_bit_identically(self):
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

    def test_copies_and_pickles_hold_every_buffer_and_continue_bit_for_bit(self):
        for path in sorted(pathlib.Path(core.SCENARIO_FOLDER).glob("*.yaml")):
            scenario = core.Scenario.load(str(path))
            again = pickle.loads(pickle.dumps(scenario))
            self.assertEqual((scenario, hash(scenario), scenario.yaml),
                             (again, hash(again), again.yaml))
            self.assertNotEqual(scenario, core.Scenario.load(str(DATA / "reef.yaml")))
            batch = core.FarmBatch(scenario, 2, ["rewards", "terms", "outcomes", "legal", "active",
                                                 "end_reasons", "is_first", "hashes", "features"])
            self.assertEqual(batch, copy.deepcopy(batch))
            batch.reset(5)
            batch.start(np.array([False, True]), [0, 9], [0, 3], 1)
            for joint in actions_of(1, batch, 20):
                batch.step(joint)
            other = pickle.loads(pickle.dumps(batch))
            self.assertEqual(batch, other)
            for _ in range(2):
                for name, array in batch.buffers.items():
                    np.testing.assert_array_equal(array, other.buffers[name], f"{path}: {name}")
                for one in (batch, other):
                    one.start_next(np.ones(2, bool))
            other.step(actions_of(2, batch, 1)[0])
            self.assertNotEqual(batch, other)

    def test_an_array_in_use_cannot_be_resized(self):
        batch = core.FarmBatch(PAPER, 4)
        own, replay = np.zeros((4, 1), np.float32), np.zeros((2, 4, 1, 8), np.float32)
        batch.bind("rewards", own)
        batch.bind("terms", replay[1])
        for array in (own, replay, batch.buffers["end_reasons"]):
            with self.assertRaisesRegex(ValueError, "cannot resize an array that references"):
                array.resize((1 << 20,), refcheck=False)
        batch.bind("rewards", np.zeros((4, 1), np.float32))
        own.resize((1 << 20,), refcheck=False)  # no longer in use
        batch.reset(1)

    def test_a_fork_after_a_step_with_threads_steps_on(self):
        batch = core.FarmBatch(PAPER, 8, ["hashes"], threads=2)
        batch.reset(1)
        batch.step(np.zeros((8, 1), np.uint8))
        expected = copy.deepcopy(batch)
        expected.step(np.ones((8, 1), np.uint8))
        child = os.fork()
        if child == 0:
            signal.alarm(20)  # ends a child that waits for threads that do not exist
            batch.step(np.ones((8, 1), np.uint8))
            os._exit(0 if (batch.buffers["hashes"] == expected.buffers["hashes"]).all() else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_a_numpy_that_the_module_misreads_is_refused_at_import(self):
        self.assertEqual(_abi.numpy_fault(_native, np), "")
        old = types.SimpleNamespace(PYBIND11=(2, 10), _made_array=_native._made_array,
                                    _write_last=_native._write_last)
        new_numpy = types.SimpleNamespace(__version__="2.4.6", zeros=np.zeros, uint8=np.uint8,
                                          count_nonzero=np.count_nonzero)
        self.assertRegex(_abi.numpy_fault(old, new_numpy), "^aquafarm_core: got numpy 2.4.6 with a "
                         r"module built with pybind11 2.10, expected numpy < 2; install the wheel")
        flat = types.SimpleNamespace(
            PYBIND11=(2, 12), _write_last=_native._write_last,
            _made_array=lambda dtype, shape: np.lib.stride_tricks.as_strided(
                np.zeros(shape, dtype), strides=(0, 0)))
        self.assertRegex(_abi.numpy_fault(flat, np), r"^aquafarm_core: got bool arrays with "
                         r"strides \(0, 0\) from numpy .*, expected \(3, 1\); install")

        def write_all(array, value):
            array.view(np.uint8)[:] = value

        aliased = types.SimpleNamespace(PYBIND11=(2, 12), _made_array=_native._made_array,
                                        _write_last=write_all)
        self.assertRegex(_abi.numpy_fault(aliased, np),
                         "^aquafarm_core: got bool entries that share memory from numpy ")

    def test_sources_without_a_native_module_say_how_to_build_it(self):
        folder = pathlib.Path(__file__).resolve().parents[1] / "python"
        done = subprocess.run([sys.executable, "-c", "import aquafarm_core"], capture_output=True,
                              text=True, check=False, cwd="/",
                              env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(folder),
                                   "PYTHONNOUSERSITE": "1"})
        if done.returncode == 0:
            self.skipTest("this Python has the module installed")
        self.assertRegex(done.stderr, r"ImportError: aquafarm_core: got no native module for this "
                         r"Python from \[.*\] \(.*\), expected one; pip install ./aquafarm_gym, or")

    @unittest.skipUnless(importlib.util.find_spec("aquafarm_core._pictures"), "built without OpenCV")
    def test_a_painter_draws_the_present_state(self):
        from aquafarm_core import pictures
        batch = core.FarmBatch(PAPER, 2)
        batch.reset(3)
        painter = pictures.Painter(400, 320)
        first = painter.draw(batch, 1).copy()
        self.assertEqual((first.shape, first.dtype), ((320, 400, 3), np.uint8))
        np.testing.assert_array_equal(pictures.Painter(400, 320).draw(batch, 1), first)
        for actions in actions_of(1, batch, 5):
            batch.step(actions)
        self.assertTrue((painter.draw(batch, 1) != first).any())

    def test_rewards_are_the_sum_of_their_terms_and_finished_episodes_add_up(self):
        reef = core.Scenario.load(str(DATA / "reef.yaml"))
        batch = core.FarmBatch(reef, 8, ["rewards", "terms", "end_reasons", "is_first"])
        batch.reset(2)
        returns, ended = np.zeros(8), 0
        for joint in actions_of(3, batch, 1500):
            batch.step(joint)
            buffers = batch.buffers
            returns[buffers["is_first"] != 0] = 0
            played = buffers["is_first"] == 0
            terms = buffers["terms"].sum(axis=2, dtype=np.float32)
            np.testing.assert_allclose(buffers["rewards"][played], terms[played], atol=1e-4)
            returns += np.where(played, terms.sum(axis=1), 0)
            finished = batch.finished()
            self.assertEqual([one["farm"] for one in finished],
                             list(np.flatnonzero(buffers["end_reasons"])))
            for one in finished:
                ended += 1
                self.assertAlmostEqual(one["episode_return"], returns[one["farm"]], delta=0.5)
        self.assertGreater(ended, 8)

    def test_former_names_of_buffers_work_with_a_warning(self):
        former = {"in_play": "active", "reasons": "end_reasons", "started": "is_first"}
        with self.assertWarnsRegex(DeprecationWarning, "^buffer 'in_play' is now 'active'; use"):
            batch = core.FarmBatch(PAPER, 2, [*former, "rewards"])
        self.assertEqual({*former.values(), "rewards"}, {*batch.buffers})
        batch.reset(1)
        for name, new in former.items():
            with self.assertWarnsRegex(DeprecationWarning, f"^buffer '{name}' is now '{new}'; use"):
                self.assertIs(batch.buffers[name], batch.buffers[new])
            with self.assertWarns(DeprecationWarning):
                self.assertIs(batch.buffers.get(name), batch.buffers[new])
            self.assertIn(name, batch.buffers)
        own = np.zeros(2, np.uint8)
        with self.assertWarns(DeprecationWarning):
            batch.bind("started", own)
        self.assertIs(batch.buffers["is_first"], own)
        with self.assertRaises(KeyError):
            core.FarmBatch(PAPER, 2, ["rewards"]).buffers["started"]
        self.assertNotIn("started", core.FarmBatch(PAPER, 2, ["rewards"]).buffers)

    def test_a_summary_has_the_entries_of_no_episode_and_each_has_a_column(self):
        batch = core.FarmBatch(core.Scenario.load(str(DATA / "reef.yaml")), 8)
        batch.reset(2)
        finished = []
        for joint in actions_of(3, batch, 200):
            batch.step(joint)
            finished += batch.finished()
        self.assertTrue(finished)
        types = {name: type(value) for name, value in core.NO_EPISODE.items()}
        for one in finished:
            self.assertEqual({name: type(value) for name, value in one.items()}, types)
        self.assertEqual({*core.EPISODE_COLUMNS, *core.ADDED_COLUMNS}, {*types})
        self.assertEqual(core.ADDED_COLUMNS, {"energy": "energy_kwh", "distance": "distance_km"})

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
        self.assertEqual({"FarmBatch: another thread's call is still running; use one batch per thread"}, set(words))
        batch.step(np.zeros((512, 1), np.uint8))
        self.assertLess(time.monotonic() - before, 60)

    def test_a_thousand_farms_make_millions_of_steps_a_second(self):
        batch = core.FarmBatch(PAPER, 1024, ["rewards", "end_reasons", "is_first", "index"])
        batch.reset(1)
        actions = actions_of(1, batch, 64)
        rates = []
        for _ in range(5):
            start = time.process_time()  # CPU time of this process: others may use the machine
            for joint in actions:
                batch.step(joint)
            rates.append(actions.size / (time.process_time() - start))
        print(f"farm_steps_python {np.median(rates):.3g} steps/s")
        self.assertGreater(max(rates), 5e6 if core.OPTIMISED else 1e5)


def core_after_reset(farms):
    """Returns the saved bytes of farms after a reset."""
    batch = core.FarmBatch(PAPER, farms)
    batch.reset(1)
    return batch.save()


if __name__ == "__main__":
    run_tests("core_python", CoreTest, "")
