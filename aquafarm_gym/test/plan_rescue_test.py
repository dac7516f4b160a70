#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of aquafarm_gym.plan_rescue.

Runs in the virtual environment given by --venv (venv_tools.py), or in the Python that starts it.
"""
import pathlib
import unittest

from venv_tools import enter_venv, run_tests

WHY_NOT = enter_venv()

if not WHY_NOT:
    from aquafarm_gym import plan_rescue

TRACKS = pathlib.Path(__file__).resolve().parents[2] / "aquafarm_sim" / "core" / "test" / "data"
BULLETIN = {"bulletin": TRACKS / "bulletin.json", "storm_name": "202106",
            "at": "2021-07-25T00:00:00Z", "members": 50, "ships": 1}


@unittest.skipIf(WHY_NOT, WHY_NOT)
class PlanRescueTest(unittest.TestCase):
    def test_a_plan_is_the_content_of_plan_json(self):
        plan = plan_rescue("zhoushan_infa_2021", **BULLETIN)
        self.assertEqual((plan["format"], plan["version"]), ("aquafarm_plan", 1))
        self.assertEqual(plan["outcome"]["kind"], "nothing_can_be_saved")
        again = plan_rescue("zhoushan_infa_2021", **BULLETIN)
        for one in (plan, again):
            del one["provenance"]  # the time of the computation
        self.assertEqual(plan, again)

    def test_wrong_options_are_refused_in_one_line(self):
        for changes, words in (
                ({"at": "2021-07-25T00:00:00"}, "at: got '2021-07-25T00:00:00', expected a time"),
                ({"members": 5}, r"members: got 5, expected a whole number in \[10, 20000\]"),
                ({"ships": 1.5}, r"ships: got 1.5, expected a whole number in \[0, 64\]"),
                ({"speed_kn": "10"}, r"speed_kn: got '10', expected a number in \[0.1, 60.0\]"),
                ({"storm_name": ""}, ".*bulletin.json: got 2 storms, expected "),
                ({"bulletin": "none.json"}, "none.json: ")):
            with self.assertRaisesRegex(ValueError, f"^{words}"):
                plan_rescue("zhoushan_infa_2021", **{**BULLETIN, **changes})


if __name__ == "__main__":
    run_tests("plan_rescue", PlanRescueTest, WHY_NOT)
