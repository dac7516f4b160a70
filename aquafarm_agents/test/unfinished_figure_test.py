#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the maps of failed episodes with the steps of their routes."""
import json
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np
import rosunit
from matplotlib.collections import LineCollection, PatchCollection, PathCollection

from aquafarm_benchmark import style, unfinished_figure


class UnfinishedFigureTest(unittest.TestCase):

    def setUp(self):
        _, self.axes = style.plt.subplots()
        self.addCleanup(style.plt.close, "all")

    def lines(self):
        """Returns {label: (x, y)} of the lines with a label."""
        return {line.get_label(): (np.asarray(line.get_xdata()), np.asarray(line.get_ydata()))
                for line in self.axes.lines if not line.get_label().startswith("_")}

    def test_devices_that_were_not_fetched_are_marked(self):
        chart = {"width": 4, "height": 3, "islands": [], "rocks": [], "ports": [[0, 0]],
                 "devices": [{"cell": [1, 0]}, {"cell": [3, 2]}]}
        storm = {"x": 3.0, "y": 2.0, "radii": [1.0]}
        steps = [{"cell": [0, 0], "action": "east", "aboard": 0, "delivered": 0},
                 {"cell": [1, 0], "action": "pickup", "aboard": 0, "delivered": 0},
                 {"cell": [1, 0], "action": "west", "aboard": 1, "delivered": 0},
                 {"cell": [0, 0], "aboard": 1, "delivered": 0}]
        steps = [{**step, "disasters": [storm]} for step in steps[:3]] + [
            {**steps[3], "disasters": []}]
        route = {"chart": chart, "steps": steps, "reason": "time_limit", "return": -12.4}
        self.assertEqual([[3, 2]], unfinished_figure.devices_left(route))
        unfinished_figure.plot_unfinished(self.axes, "ranch 7", route, 1.45)
        marks = {marks.get_label(): marks.get_offsets().tolist()
                 for marks in self.axes.collections}
        self.assertEqual([[1, 0]], marks["device that was fetched"])
        self.assertEqual([[3, 2]], marks["device that was not fetched"])
        self.assertEqual([[0, 0]], marks["ship at the end"])
        lines = self.lines()
        self.assertIn("ring of a disaster in the last step", lines)
        self.assertNotIn("ring over a device left, 60 steps before", lines, "the episode has 3 steps")
        last, = (one for one in self.axes.collections if isinstance(one, LineCollection))
        self.assertIn("last leg, a device aboard", lines)
        np.testing.assert_array_equal([[[1, 0], [1, 0]], [[1, 0], [0, 0]]], last.get_segments())
        np.testing.assert_array_equal([2.2, 2.2], last.get_linewidths(), "a pickup is not a visit")
        self.assertFalse(any("visits" in label for label in lines))
        np.testing.assert_array_equal(
            [[1, 3], [0, 2]], lines["last stop to nearest device left (no route)"])
        # From the pickup at (1, 0), (3, 2) is 2 moves away; one step is left.
        self.assertEqual("ranch 7: 0 of 2 in port, return −12\n≥ 2 moves needed, 1 step left",
                         self.axes.get_title("left"))
        self.assertEqual((2, 1, True), unfinished_figure.shortage(route))
        long = {**route, "steps": [*steps[:2], *[steps[2]] * 3, steps[3]]}
        self.assertEqual((2, 3, True), unfinished_figure.shortage(long))
        dry = {**long, "steps": [{**step, "disasters": []} for step in long["steps"]]}
        exact = {**route, "steps": [*steps[:2], *[steps[2]] * 2, steps[3]]}
        self.assertEqual((2, 2, True), unfinished_figure.shortage(exact))
        groups = unfinished_figure.group_by_cause({"e": exact})
        self.assertEqual(["time"], list(groups), "no step is left for the pickup")
        groups = unfinished_figure.group_by_cause({"a": dry, "b": long, "c": route, "d": long})
        self.assertEqual({"time": ["c"], "ring": ["b", "d"], "other": ["a"]},
                         {cause: [name for name, _ in group] for cause, group in groups.items()})
        self.assertEqual("time runs out in 1, the ship waits before a ring in 2, another cause "
                         "in 1", unfinished_figure.describe_failures(groups))
        _, self.axes = style.plt.subplots()
        far = {"x": 30.0, "y": 2.0, "radii": [1.0]}
        waiting = [{**steps[0], "disasters": [{**storm, "x": 2.5}, far]}] * 70
        ended = [{**step, "disasters": [storm, far]} for step in steps[:3]]
        unfinished_figure.plot_unfinished(self.axes, "ranch 7", {**route, "steps": [
            *waiting, *ended, steps[3]]}, 1.45)
        labels = [line.get_label() for line in self.axes.lines]
        self.assertEqual(1, labels.count("ring over a device left, 60 steps before"), "not of the far one")
        self.assertAlmostEqual(2.5, self.lines()["ring over a device left, 60 steps before"][0].mean(), 1)

    def test_the_legend_of_failures_shows_the_sign_of_a_device_that_was_left(self):
        chart = {"width": 9, "height": 9, "islands": [], "rocks": [], "ports": [[0, 0]],
                 "devices": [{"cell": [8, 8]}]}
        steps = [{"cell": [0, 0], "action": "east", "aboard": 0, "delivered": 0, "disasters": []},
                 {"cell": [1, 0], "aboard": 0, "delivered": 0, "disasters": []}]
        kept = []
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "route.json"
            file.write_text(json.dumps({"chart": chart, "steps": steps, "reason": "time_limit",
                                        "return": 0.0}))
            with unittest.mock.patch.object(unfinished_figure, "save",
                                            lambda one, _: kept.append(one)):
                unfinished_figure.draw_unfinished("nowhere", {"ranch 7": file}, 20, 5)
                unfinished_figure.draw_unfinished(
                    "nowhere", {f"ranch {i}": file for i in range(5)}, 20, 5)
                better = pathlib.Path(folder) / "better.json"
                better.write_text(file.read_text().replace('"return": 0.0', '"return": 1.0'))
                unfinished_figure.draw_unfinished(
                    "nowhere", {"ranch 8": better, "ranch 7": file}, 2000, 1)
        figure, five, worst = kept
        five.draw_without_rendering()
        places = [axes.get_position() for axes in five.axes]
        heights = [place.height * five.get_figheight() for place in places]
        np.testing.assert_allclose(unfinished_figure._HEIGHT, heights, rtol=0.1)
        self.assertEqual([3, 2], [sum(abs(one.y1 - places[i].y1) < 1e-6 for one in places)
                                  for i in (0, 4)], "maps in a row")
        self.assertEqual(1, len(figure.axes))
        self.assertEqual("1 failure in 20 ranches: time runs out in 1", figure._suptitle.get_text())
        self.assertEqual("2 failures in 2,000 ranches: time runs out in 2 (1 of the 2 shown)",
                         worst._suptitle.get_text(), "all failures are counted")
        self.assertEqual(["ranch 7"],
                         [axes.get_title("left").partition(":")[0] for axes in worst.axes])
        self.assertIn("The map shows the failure with the lowest return.",
                      worst.legends[0].get_title().get_text())
        self.assertNotIn("The map shows", figure.legends[0].get_title().get_text())
        legend, = figure.legends
        words = [text.get_text() for text in legend.get_texts()]
        self.assertIn("device that was not fetched", words)
        signs = [one for one in legend.findobj(PathCollection)]
        self.assertEqual(len(words) - 2 + 1, len(signs), "two lines; one sign has two marks")

    def test_the_map_of_a_failure_shows_the_part_around_the_last_leg(self):
        chart = {"width": 50, "height": 40, "islands": [], "rocks": [[40, 30]], "ports": [[20, 20]],
                 "devices": [{"cell": [22, 20]}]}
        cells = [[20, 20], [21, 20]] * 5 + [[20, 20]]
        steps = [{"cell": cell, "action": "east", "aboard": 0, "delivered": 0, "disasters": []}
                 for cell in cells]
        unfinished_figure.plot_unfinished(self.axes, "ranch 7", {
            "chart": chart, "steps": steps, "reason": "time_limit", "return": 0.0}, 1.45)
        self.assertEqual((17 - 0.7, 25 + 0.7), self.axes.get_xlim())
        self.assertEqual((17 - 0.7, 23 + 0.7), self.axes.get_ylim())
        handles, labels = self.axes.get_legend_handles_labels()
        self.assertIn("cell with 5 or more visits", labels)
        shades = [one for one in self.axes.collections if isinstance(one, PatchCollection)]
        self.assertEqual([2], [len(one.get_paths()) for one in shades])
        port = handles[labels.index("port")]
        self.assertLess(shades[0].get_zorder(), port.get_zorder(), "ports and devices are on top")
        last, = (one for one in self.axes.collections if isinstance(one, LineCollection))
        np.testing.assert_array_equal([0.6], np.unique(last.get_linewidths()), "repeated cells")
        self.assertNotIn("rock", labels)
        self.assertIn("2 moves needed, 10 steps left", self.axes.get_title("left"))

    def test_a_failure_with_the_last_device_aboard_lacks_the_way_to_a_port(self):
        chart = {"width": 9, "height": 9, "islands": [], "rocks": [], "ports": [[0, 0], [7, 2]],
                 "devices": [{"cell": [4, 1]}]}
        step = {"cell": [4, 1], "action": "pickup", "aboard": 0, "delivered": 0,
                "disasters": [{"x": 4.0, "y": 1.0, "radii": [9.0]}]}
        steps = [{**step, "cell": [3, 1], "action": "east"}, step,
                 {**step, "action": "east", "aboard": 1}, {**step, "cell": [5, 1], "aboard": 1}]
        route = {"chart": chart, "steps": steps, "reason": "time_limit", "return": 0.0}
        self.assertEqual((3, 1, False), unfinished_figure.shortage(route))
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(
                unfinished_figure, "save", lambda one, _: self.assertEqual(1, len(one.axes))):
            file = pathlib.Path(folder) / "route.json"
            file.write_text(json.dumps(route))
            unfinished_figure.draw_unfinished("nowhere", {"ranch 7": file}, 20, 5)
        unfinished_figure.plot_unfinished(self.axes, "ranch 7", route, 1.45)
        np.testing.assert_array_equal([[4, 7], [1, 2]],
                                      self.lines()["last stop to nearest port (no route)"])

        home = {"chart": chart, "steps": steps[:1] * 2}  # the device was not fetched
        for routes, goal in (([home], "device left"), ([route], "port"),
                             ([home, route], "device left (or port, if no device is left)")):
            self.assertEqual(
                f"Time runs out: the moves to the nearest {goal} and a pickup or drop-off need more "
                "steps than are left",
                unfinished_figure._heading("time", [("ranch", one) for one in routes]))

    def test_a_visit_of_a_cell_is_an_arrival(self):
        waiting = [[4, 4]] * 12  # a pickup and waiting take steps in one cell
        counts = unfinished_figure._shade_visits(self.axes, [*waiting, [5, 4], [4, 4], [3, 4]])
        self.assertEqual({(4, 4): 2, (5, 4): 1, (3, 4): 1}, dict(counts))
        self.assertEqual(["cell with 2 to 4 visits"], self.axes.get_legend_handles_labels()[1])

    def test_the_map_of_a_failure_has_its_shape_and_stays_in_the_ranch(self):
        for cells, size, expected in (
                ([[2, 2], [4, 30]], (80, 60), (0, 47, 0, 33)),  # tall: wider, from the west border
                ([[40, 10], [42, 30]], (80, 60), (22, 59, 7, 33)),  # tall, in the middle
                ([[77, 30], [79, 30]], (80, 60), (71, 79, 27, 33)),  # at the east border
                ([[10, 57], [60, 59]], (80, 60), (7, 63, 21, 59)),  # flat: higher, from the north
                ([[2, 2], [4, 5]], (8, 6), (0, 7, 0, 5))):  # a ranch that is smaller than the map
            window = unfinished_figure._window(cells, size, 1.45)
            self.assertEqual(expected, window, cells)
            west, east, south, north = window
            for x, y in cells:
                self.assertTrue(west <= x <= east and south <= y <= north, cells)


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "unfinished_figure", UnfinishedFigureTest, sys.argv)
