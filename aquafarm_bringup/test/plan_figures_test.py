#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Geometry and words of the drawings on the page of a plan."""
import pathlib
import sys
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import plan_sample  # noqa: E402
from aquafarm_plan import chart, document, figures, words  # noqa: E402


class PlanFiguresTest(unittest.TestCase):

    def dates(self, start, hours=40):
        plan = plan_sample.sample(members=100)
        clock = document.Clock({**plan["clock"], "start": start})
        return figures._dates(clock, 3600.0 * hours, lambda seconds: 100.0 + seconds / 140.0), clock

    def test_a_date_stands_where_its_day_begins(self):
        dates, clock = self.dates("2021-07-23T18:00:00Z")
        self.assertEqual(480, clock.offset_min)
        self.assertEqual(["Sat 24 Jul", "Sun 25 Jul"], [one["text"] for one in dates])
        self.assertEqual([False, True], [one["is_midnight"] for one in dates])
        self.assertEqual(100.0, dates[0]["x"], "the plan begins at 02:00 of this day")
        self.assertAlmostEqual(100.0 + 22 * 3600 / 140.0, dates[1]["x"])

    def test_two_dates_never_overlap(self):
        dates, _ = self.dates("2021-07-23T15:00:00Z")  # an hour before midnight
        self.assertEqual(["Sat 24 Jul", "Sun 25 Jul"], [one["text"] for one in dates])
        for one, other in zip(dates, dates[1:]):
            self.assertGreaterEqual(other["x"] - one["x"], figures.DATE_WIDTH)

    def test_ships_have_numbers_and_ports_letters(self):
        plan = plan_sample.sample(members=100)
        drawing = chart.chart(plan)
        badges = [label.badge for label in drawing["labels"] if label.badge]
        self.assertTrue(badges)
        for badge in badges:
            self.assertRegex(badge, r"^[0-9]+[a-z]+$")
        for port in drawing["ports"]:
            self.assertRegex(port["letter"], r"^[A-Z]+$")
        plan["ships"][0]["name"], plan["ships"][1]["name"] = "ship 1", "Haixing"
        self.assertEqual("ship 1", words.numbered_name(plan, 0))
        self.assertEqual("2: Haixing", words.numbered_name(plan, 1))


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "plan_figures", "plan_figures_test", sys.argv)
