#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Geometry and words of the drawings on the page of a plan."""
import math
import pathlib
import sys
import unittest

import numpy as np
import rostest
from matplotlib.path import Path

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import plan_sample  # noqa: E402
from aquafarm_plan import chart, coast, document, figures, labels, page, words  # noqa: E402


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

    def test_ticks_of_a_long_plan_are_days_apart(self):
        for hours, step_h in ((40, 6), (150, 12), (400, 48), (1000, 96)):
            _, clock = self.dates("2021-07-23T18:00:00Z")
            ticks = figures._time_ticks(clock, 3600.0 * hours, lambda seconds: seconds / 3600.0)
            gaps = {round(b["x"] - a["x"], 6) for a, b in zip(ticks, ticks[1:])}
            self.assertEqual({step_h}, gaps)
            self.assertLessEqual(len(ticks), 14)

    def test_routes_without_a_path_have_no_legs(self):
        plan = plan_sample.sample(members=100)
        for route in plan["plan"]["routes"]:
            route["path"] = []
        self.assertEqual([[], []], [route["legs"] for route in chart.chart(plan)["routes"]])

    def test_the_sampling_error_is_the_largest_of_the_chances_that_are_shown(self):
        plan = plan_sample.sample(members=100)
        planned = [device for device in plan["devices"] if device["order"]]
        for home, points in ((0.5, 10), (0.9, 6)):  # the other devices have 0.04: 4 points
            for device in planned:
                device["odds"]["home"] = 0.04
            planned[-1]["odds"]["home"] = home
            self.assertIn(f"sampling error at most {points} points", words.answers(plan)[3][2])
        plan["devices"], plan["what_if"] = planned, [{"all_home": 0.5}]
        self.assertIn("sampling error at most 10 points", words._sure(plan)[2])

    def test_a_row_of_orders_ends_with_the_time_in_port(self):
        plan = plan_sample.sample(members=100)
        clock = document.Clock(plan["clock"])
        rows = figures.timeline(plan)["rows"]
        end = rows[0]["bars"][-1]["x"] + rows[0]["bars"][-1]["w"]
        at = clock.time(plan["plan"]["routes"][0]["orders"][-1]["time"])
        for right, mark, expected in (
                (end + 2000.0, None, f"in port {at}; dark: to a device, light: to a port"),
                (end + 200.0, None, f"in port {at}"), (end + 60.0, None, at), (end, None, ""),
                (end + 200.0, end + 60.0, at), (end + 200.0, end - 9.0, f"in port {at}")):
            rows[0]["deadline"] = {"x": mark} if mark else None
            figures._name_ends(plan, rows, clock, right)
            self.assertEqual(expected, rows[0]["end"])
            self.assertFalse(any("dark" in row["end"] for row in rows[1:]), "said once")

    def test_a_row_of_orders_has_the_mark_of_the_deadline_that_the_page_states(self):
        plan = plan_sample.sample(members=100)
        for ship, hours in ((0, 8.0), (1, 30.0)):  # the first is before the end of the orders
            first = next(one["device"] for one in plan["plan"]["routes"][ship]["orders"]
                         if one["action"] == "fetch")
            deadline, = (one for one in plan["devices"][first]["deadlines"]
                         if one["probability"] == 0.8)
            deadline["leave"] = plan_sample.stamp(hours)
        plan["deadlines"]["no_departure_after"] = plan_sample.stamp(36)
        clock, line = document.Clock(plan["clock"]), figures.timeline(plan)
        self.assertGreaterEqual(line["end_s"], 39 * 3600)
        for row, hours in zip(line["rows"], (8.0, 30.0)):
            x = line["left"] + (line["right"] - line["left"]) * hours * 3600 / line["end_s"]
            self.assertAlmostEqual(x, row["deadline"]["x"])
            self.assertEqual(clock.time(plan_sample.stamp(hours)), row["deadline"]["time"])
            self.assertIn(f"{row['deadline']['time']} (F", words.answers(plan)[1][2])
        self.assertEqual([False, True], [row["deadline"]["is_named"] for row in line["rows"]],
                         "no text on the bars")
        self.assertIn("leave by (chance 80 %)", page.render(plan))
        deadline["open"] = True
        self.assertEqual([True, False], [bool(row["deadline"])
                                         for row in figures.timeline(plan)["rows"]])
        plan["deadlines"]["no_departure_after"] = None
        self.assertFalse(any(row["deadline"] for row in figures.timeline(plan)["rows"]))
        self.assertNotIn("leave by", page.render(plan))
        plan = plan_sample.storm_unknown_aboard()
        plan["deadlines"]["no_departure_after"] = plan_sample.stamp(36)
        plan["plan"]["routes"][0]["orders"][1].update(action="fetch", device=0)
        plan["devices"][0]["deadlines"] = [{"probability": 0.8, "leave": plan_sample.stamp(3)}]
        self.assertEqual({}, words.first_deadlines(plan), "the winds are unknown")

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

    def test_the_name_of_a_port_between_two_islands_touches_neither(self):
        plan = plan_sample.sample(members=100)
        plan["plan"]["routes"], plan["devices"], plan["ports"] = [], [], plan["ports"][:1]
        plan["ports"][0]["cell"] = [12, 12]
        land = [[x, y] for x in (9, 10, 14, 15) for y in range(11, 14)]  # the gap: two cells
        land += [[11, y] for y in range(11, 14)]
        plan["ranch"].update(land=land, rocks=[])
        drawing = chart.chart(plan)
        label, = (one for one in drawing["labels"] if one.name == "port")
        scale = drawing["frame"].scale
        for x, y in (drawing["frame"].px(*cell) for cell in land):
            self.assertFalse(label.x - scale / 2 < x < label.x + label.width + scale / 2 and
                             label.y - label.height - scale / 2 < y < label.y + scale / 2, (x, y))

    def test_a_leader_that_crosses_a_label_costs_more(self):
        label = labels.Label(["now"], (100.0, 100.0), 6.0, 12.0)
        box = (180.0, 94.0, 0.0)  # to the right of the anchor
        between, below = (130.0, 90.0, 160.0, 110.0), (130.0, 130.0, 160.0, 150.0)
        free = labels._cost(box, label, [below], [], 400.0, 400.0)
        self.assertGreater(labels._cost(box, label, [between], [], 400.0, 400.0), free + 50.0)

    def test_the_region_has_few_labels_and_the_rings_where_the_centre_is_nearest(self):
        plan = plan_sample.sample(members=100)
        region = figures.region(plan)
        ring_labels = [label for label in region["labels"] if label.name == "ring"]
        self.assertEqual(len(plan["rings"]), len(ring_labels), "rings of one time")
        nearest = document.Clock(plan["clock"]).day_time(plan_sample.stamp(30))
        self.assertEqual(f"Rings at {nearest}, the future point nearest to the ranch.", region["caption"])
        fixes = [label for label in region["labels"] if label.name in ("recorded", "forecast")]
        self.assertLessEqual(2, len(fixes))
        self.assertLessEqual(len(fixes), figures.REGION_LABELS)
        now, = (label for label in fixes if label.lines[0].startswith("now: "))
        marked, = (point for point in region["points"] if point["is_now"])
        self.assertEqual(marked["xy"], now.anchor)
        self.assertIn(marked["time"].split(" ", 1)[1], now.lines[0])
        self.assertEqual(document.Clock(plan["clock"]).day_time(plan["clock"]["start"]),
                         marked["time"])
        plan["storm"]["points"] = [point for point in plan["storm"]["points"]
                                   if point["time"] != plan["clock"]["start"]]
        later = figures.region(plan)
        self.assertFalse([label for label in later["labels"] if "now" in label.lines[0]],
                         "no other point is called so")

    def test_no_past_position_of_the_storm_has_a_label_if_a_later_one_exists(self):
        plan = plan_sample.sample(members=100)
        storm, start = plan["storm"], plan["clock"]["start"]
        clock = document.Clock(plan["clock"])
        past_times = [clock.day_time(point["time"]) for point in storm["points"]
                      if point["time"] < start]
        for without_now in (False, True):
            if without_now:
                storm["points"] = [point for point in storm["points"] if point["time"] != start]
            region = figures.region(plan)
            past = [point["xy"] for point in region["points"] if point["time"] in past_times]
            self.assertTrue(past, "the map shows past positions")
            fixes = [label for label in region["labels"] if label.name in ("recorded", "forecast")]
            self.assertLessEqual(2, len(fixes))
            self.assertFalse([label.lines for label in fixes if label.anchor in past])
        storm["points"] = [point for point in storm["points"] if point["time"] < start]
        region = figures.region(plan)
        last, = (label for label in region["labels"] if label.name == "recorded")
        self.assertEqual(region["points"][-1]["xy"], last.anchor)

    def test_the_coast_is_where_it_is_and_ends_at_the_box(self):
        box = (-800.0, -900.0, 600.0, 300.0)
        rings = coast.rings({"latitude": 30.15, "longitude": 122.65}, 1000.0, box)

        def is_land(x, y):
            return sum(Path(ring).contains_point((x, y)) for ring in rings) % 2 == 1

        self.assertTrue(is_land(-240, 15), "Hangzhou, 240 km west")
        self.assertTrue(is_land(-180, -710), "Taiwan, 710 km south")
        self.assertFalse(is_land(300, 0), "East China Sea")
        self.assertFalse(is_land(0, -300), "East China Sea")
        corners = np.concatenate(rings)
        self.assertTrue((corners >= np.array(box[:2]) - 1e-6).all())
        self.assertTrue((corners <= np.array(box[2:]) + 1e-6).all())
        self.assertEqual([], coast.rings({"latitude": 40.0, "longitude": -40.0}, 1000.0, box),
                         "open sea")

    def test_the_region_has_a_coast_if_it_is_large_enough(self):
        plan = plan_sample.sample(members=100)
        self.assertIn("M", figures.region(plan)["coast"])
        for point in plan["storm"]["points"]:
            point["at"] = [0.01 * axis for axis in point["at"]]
        plan["ensemble"]["errors"] = []
        self.assertEqual("", figures.region(plan)["coast"], "not exact enough for a small drawing")

    def test_the_region_ends_soon_after_the_last_event(self):
        plan = plan_sample.sample(members=100)
        plan["clock"]["end"] = plan_sample.stamp(60)
        clock = document.Clock(plan["clock"])
        times = [point["time"] for point in figures.region(plan)["points"]]
        self.assertIn(clock.day_time(plan_sample.stamp(24)), times)
        self.assertNotIn(clock.day_time(plan_sample.stamp(54)), times)

    def test_an_arrow_at_the_border_points_to_a_storm_off_the_map(self):
        plan = plan_sample.sample(members=100)
        ranch = plan["ranch"]
        middle = [(ranch["width"] - 1) / 2, (ranch["height"] - 1) / 2]
        start = plan["clock"]["start"]
        later = document.Clock(plan["clock"]).at(6 * 3600)

        def pointer(east_cells, north_cells):
            at = [middle[0] + east_cells, middle[1] + north_cells]
            plan["storm"]["points"] = [{"time": start, "at": at}, {"time": later, "at": [0, 0]}]
            return chart.storm_pointer(plan, chart.Frame(ranch))

        km = ranch["cell_size_m"] / 1000.0
        found = pointer(300.0 / km, 0.0)
        self.assertIn("centre 300 km E (090°) at ", found["words"])
        self.assertEqual(90.0, found["bearing"])
        frame = chart.Frame(ranch)
        self.assertAlmostEqual(frame.height / 2, found["xy"][1])
        self.assertAlmostEqual(frame.width - 30.0, found["xy"][0])
        south_west = pointer(-300.0 / km, -300.0 / km)
        self.assertIn("centre 424 km SW (225°) at ", south_west["words"])
        for value, side in zip(south_west["xy"], (frame.width, frame.height)):
            self.assertTrue(30.0 - 1e-6 <= value <= side - 30.0 + 1e-6)
        self.assertIsNone(pointer(1.0, 1.0), "the centre is on the map")
        plan["storm"]["points"] = []
        self.assertIsNone(chart.storm_pointer(plan, frame), "the centre is unknown")

    def test_the_arrow_to_a_storm_keeps_away_from_devices(self):
        plan = plan_sample.sample(members=100)
        ranch = plan["ranch"]
        plan["storm"]["points"] = [{"time": plan["clock"]["start"], "at": [12, -300]},
                                   {"time": document.Clock(plan["clock"]).at(3600), "at": [0, 0]}]
        frame = chart.Frame(ranch)
        free = chart.storm_pointer(plan, frame)["xy"]
        plan["devices"][0]["cell"] = [round(free[0] / frame.scale - 0.5), 1]
        moved = chart.chart(plan)["storm"]["xy"]
        self.assertEqual(free[1], moved[1], "along the southern border")
        self.assertGreaterEqual(math.dist(moved, frame.px(*plan["devices"][0]["cell"])), 45.0)
        self.assertLess(abs(moved[0] - free[0]), 81.0)

    def test_no_label_of_the_region_lies_on_a_ring(self):
        region = figures.region(plan_sample.sample(members=100))
        self.assertEqual(3, len(region["rings"]))
        for label in region["labels"]:
            for ring in region["rings"]:
                far = [math.dist((x, y), ring["xy"]) for x in (label.x, label.x + label.width)
                       for y in (label.y - label.height, label.y)]
                crosses = min(far) < ring["r"] < max(far)
                self.assertFalse(crosses, (label.lines, ring["ring"]))

    def test_a_gale_at_the_start_is_explained_by_the_spread_of_its_radius(self):
        plan = plan_sample.sample(members=100)
        plan["hazard"]["timeline"][0]["probability"] = [0.0, 0.0, 0.0]
        self.assertIsNone(words.early_wind(plan), "no ring is over the ranch at the start")
        start, cell_km = plan["clock"]["start"], plan["ranch"]["cell_size_m"] / 1000
        at, = (one for one in plan["storm"]["points"] if one["time"] == start)
        middle = (plan["ranch"]["width"] - 1) / 2
        at.update(at=[middle + 560.0 / cell_km, middle], radii_km=[49.0, 107.0, 279.0])
        plan["ensemble"]["errors"][0]["size_log"] = 0.36  # 279 km * exp(1.645 * 0.36) = 504 km
        plan["hazard"]["timeline"][0]["probability"] = [0.0, 0.0, 0.039]
        text = words.early_wind(plan)
        for part in ("gale (34 kt) is 4 % at the start", "560 km away",
                     "279 km (recorded), but more than about 500 km in one future of twenty"):
            self.assertIn(part, text)
        self.assertNotIn("leave", text, "the ships of this plan leave later")
        plan["plan"]["routes"][0]["orders"][0].update(time=start, probability=0.967)
        self.assertIn("leave port A, 97 %", words.early_wind(plan))
        plan["hazard"]["timeline"][0]["probability"] = [0.0, 0.02, 0.039]
        self.assertNotIn("leave port", words.early_wind(plan), "another ring may be the cause")
        at["radii_km"][2] = 600.0
        self.assertIsNone(words.early_wind(plan), "the ring is over the ranch")

    def test_a_departure_at_once_is_part_of_the_delivery(self):
        plan = plan_sample.sample(members=100)
        leave = {"action": "leave", "time": plan_sample.stamp(9), "port": 1, "device": None,
                 "probability": 0.942}
        deliver = {**leave, "action": "deliver", "device": 0, "probability": 0.943}
        route = {"orders": [leave, deliver, leave]}
        orders = words.merged_orders(plan, route)
        self.assertEqual(["leave port B", "deliver F1 at port B and leave"],
                         [words.order_text(plan, one) for one in orders])
        for change in ({"probability": 0.9}, {"time": plan_sample.stamp(10)}):
            route["orders"][2] = {**leave, **change}
            self.assertEqual(3, len(words.merged_orders(plan, route)), change)

    def test_the_storm_s_name_has_a_capital_after_a_hyphen(self):
        for name in ("In-fa", "In-Fa"):
            self.assertEqual("In-Fa", words.storm_name({"storm": {"name": name}}))

    def test_no_more_than_everything_can_be_lost(self):
        plan = plan_sample.sample(members=100)
        insured = plan["loss"]["insured"]
        for q95, expected in ((insured, "One time in twenty everything: CNY 5.68 M. "),
                              (0.5 * insured, "One time in twenty CNY 2.84 M or more. ")):
            plan["loss"]["with_plan"].update(q95=q95)
            _, _, remark = words.answers(plan)[2]
            self.assertIn(expected, remark)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "plan_figures", "plan_figures_test", sys.argv)
