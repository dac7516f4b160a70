#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the examples in short form: each learns a small farm. tools/check_python runs this file.

    python3 examples_test.py [--venv FOLDER]

An example whose packages are not installed is skipped with their names.
"""
import importlib
import importlib.util
import pathlib
import sys
import unittest

from venv_tools import enter_venv, run_tests

WHY_NOT = enter_venv()
EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"
sys.path.insert(0, str(EXAMPLES))

if not WHY_NOT:
    import aquafarm_core as core

SHORT = {"rollout": 1024, "batch": 128}  # many updates in few steps

# A farm of 4 x 4 cells near a red tide. The red tide ends no episode before the step limit.
SMALL = """
name: small
grid: {width: 4, height: 4, cell_size_m: 1000}
time: {step_duration_s: 180, step_limit: 60}
layout:
  mode: fixed
  seed: 1
  islands: [{x: 0, y: 2, width: 1, height: 1}]
  rocks: {cells: [[2, 3]], reward: [-5, -1]}
  ports: {cells: [[1, 2]]}
  devices:
    placement: explicit
    sites: [DEVICES]
ships: {count: SHIPS, capacity: 1}
disasters:
  - {kind: red_tide, grade: 2, radii: [1], risks: [-5], speed: 0.2, duration: 1000}
"""


def small(ships=1):
    """Returns the small farm with one device per ship."""
    sites = ", ".join(f"{{cell: [3, {2 - k}], kind: monitoring, value: 80}}" for k in range(ships))
    return core.Scenario.parse(SMALL.replace("DEVICES", sites).replace("SHIPS", str(ships)), "small")


def needs(*packages):
    """Skips a test unless the packages are installed."""
    missing = [one for one in packages if importlib.util.find_spec(one) is None]
    return unittest.skipIf(missing, f"not installed: {', '.join(missing)}")


@unittest.skipIf(WHY_NOT, WHY_NOT)
class ExamplesTest(unittest.TestCase):
    @needs("torch", "stable_baselines3", "sb3_contrib")
    def test_maskable_ppo_learns(self):
        mean, success, _ = importlib.import_module("masked_ppo").main(
            small(), 40_000, farms=16, episodes=20, **SHORT)
        self.assertGreater(mean, 90)
        self.assertEqual(success, 1)

    @needs("torch")
    def test_the_single_file_learns(self):
        single = importlib.import_module("cleanrl_ppo")
        single.HORIZON, single.BATCH = 64, SHORT["batch"]
        mean, success = single.main(small(), 40_000, farms=16, episodes=20)
        self.assertGreater(mean, 90)
        self.assertEqual(success, 1)

    @needs("torch", "stable_baselines3", "sb3_contrib", "pettingzoo")
    def test_two_ships_learn_one_policy(self):
        mean, success = importlib.import_module("shared_policy").main(
            small(2), 80_000, farms=16, episodes=5, **SHORT)
        self.assertGreater(mean, 180)
        self.assertEqual(success, 1)

    @needs("torch", "stable_baselines3", "sb3_contrib", "optuna")
    def test_a_sweep_finds_the_best_of_its_trials(self):
        study = importlib.import_module("optuna_sweep").main(small(), 2, 6000, farms=8)
        values = [trial.value for trial in study.trials]
        self.assertEqual(len(values), 2)
        self.assertEqual(study.best_value, max(values))

    @needs("jax", "optax")
    def test_a_compiled_jax_function_learns(self):
        first, last = importlib.import_module("jax_policy_gradient").main(small(), 200, farms=64)
        self.assertLess(first, 0)
        self.assertGreater(last, 80)

    @needs("ray", "torch")
    def test_rllib_learns(self):
        mean, success = importlib.import_module("rllib_ppo").main(small(), 40_000, episodes=10)
        self.assertGreater(mean, 90)
        self.assertEqual(success, 1)


if __name__ == "__main__":
    run_tests("examples", ExamplesTest, WHY_NOT)
