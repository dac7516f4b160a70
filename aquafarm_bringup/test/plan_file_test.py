#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Plan files that are refused."""
import copy
import pathlib
import sys
import tempfile
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import plan_sample  # noqa: E402
from aquafarm_plan import document  # noqa: E402


class PlanFileTest(unittest.TestCase):
    """An invalid plan file is refused with the place, the value and a hint."""

    @classmethod
    def setUpClass(cls):
        cls.plan = plan_sample.sample(members=100)

    def refusal(self, change):
        broken = copy.deepcopy(self.plan)
        change(broken)
        with self.assertRaises(document.PlanError) as caught:
            document.check(broken, "x.json")
        return str(caught.exception)

    def test_every_sample_fits(self):
        for plan in (self.plan, plan_sample.nothing_to_save(), plan_sample.storm_stays_away(),
                     plan_sample.storm_unknown(), plan_sample.storm_unknown_of_before(),
                     plan_sample.storm_unknown_aboard()):
            document.check(plan, "x.json")

    def test_a_missing_key_is_named(self):
        words = self.refusal(lambda plan: plan["ranch"].pop("width"))
        self.assertIn("x.json: ranch: 'width' is a required property", words)
        self.assertIn("make it again with aquafarm_plan --json", words)

    def test_a_value_of_another_type_is_named(self):
        words = self.refusal(lambda plan: plan["devices"][2]["odds"].update(home="high"))
        self.assertIn("x.json: devices.2.odds.home: 'high' is not of type 'number'", words)

    def test_a_probability_above_one_is_refused(self):
        words = self.refusal(lambda plan: plan["devices"][0]["odds"].update(home=1.2))
        self.assertIn("devices.0.odds.home: 1.2", words)

    def test_another_version_is_refused(self):
        self.assertIn("x.json: version: 1 was expected",
                      self.refusal(lambda plan: plan.update(version=2)))

    def test_a_grid_of_another_size_is_refused(self):
        words = self.refusal(lambda plan: plan["hazard"]["frames"][1].update(percent=[[], [], [5]]))
        self.assertIn("hazard.frames.1: got a grid of 1 numbers, expected 0 or 625", words)

    def test_a_grid_with_letters_is_refused(self):
        words = self.refusal(lambda plan: plan["hazard"]["frames"][1].update(percent=["a", [], []]))
        self.assertIn("hazard.frames.1", words)

    def test_a_device_that_does_not_exist_is_refused(self):
        words = self.refusal(lambda plan: plan["plan"]["routes"][0]["orders"][1].update(device=9))
        self.assertIn("plan.routes.0.orders.1.device: got 9, expected one of the 6 devices", words)

    def test_a_delivery_of_a_device_that_does_not_exist_is_refused(self):
        words = self.refusal(lambda plan: plan["plan"]["routes"][0]["orders"][2].update(devices=[-1]))
        self.assertIn("plan.routes.0.orders.2.devices: got -1, expected one of the 6 devices", words)

    def test_frames_that_are_no_list_are_refused(self):
        words = self.refusal(lambda plan: plan["hazard"].update(frames=None))
        self.assertIn("x.json: hazard.frames: None is not of type 'array'", words)

    def test_a_ring_without_its_number_is_refused(self):
        words = self.refusal(lambda plan: plan["devices"][0]["arrival"].pop())
        self.assertIn("devices: expected 3 numbers, one per ring", words)

    def test_a_file_that_is_missing_or_no_json_is_refused(self):
        with self.assertRaisesRegex(document.PlanError, "none.json: No such file"):
            document.load("/nowhere/none.json")
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write("{")
            file.flush()
            with self.assertRaisesRegex(document.PlanError, "expected a plan file"):
                document.load(file.name)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "plan_file", "plan_file_test", sys.argv)
