#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Comparison of V_π with the sea: similarity, unknown cells, and error messages for wrong files."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np
import roslib.packages
import rospy
import rostest
from nav_msgs.msg import OccupancyGrid
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))

from aquafarm_report import values_topics  # noqa: E402
from matplotlib import pyplot  # noqa: E402

from aquafarm_report.values import (ValuesError, best_cell, compare, device_relation,  # noqa: E402
                                    draw, draw_map, draw_places, draw_relation, headline, make,
                                    read, verdict)


def slope(height=12, width=14):
    """A map that rises to the north-east, with a hill."""
    y, x = np.mgrid[0:height, 0:width].astype(float)
    return x + y + 5.0 * np.exp(-((x - 4) ** 2 + (y - 8) ** 2) / 6.0)


def written(folder, values, layers):
    def rows(field):
        return [[None if np.isnan(v) else float(v) for v in row] for row in field]
    path = os.path.join(folder, "values.json")
    text = {"scenario": "tiny", "scenario_hash": 1, "policy": "clairvoyant", "cell_size_m": 200.0,
            "farm_seed": 5, "episode": 0, "episodes": 1, "what": "return", "values": rows(values),
            "seas": [{"name": name, "units": "degC", "values": rows(field)}
                     for name, field in layers.items()]}
    pathlib.Path(path).write_text(json.dumps(text), encoding="utf-8")
    return path


class ValuesTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_a_map_is_like_itself_however_scaled(self):
        result = compare(slope(), 3.0 * slope() + 7.0)
        self.assertAlmostEqual(1.0, result["spearman_rho"], places=9)
        self.assertAlmostEqual(1.0, result["ssim"], places=9)
        self.assertEqual(12 * 14, result["cells"])

    def test_a_map_turned_over_is_opposite(self):
        result = compare(slope(), -slope())
        self.assertAlmostEqual(-1.0, result["spearman_rho"], places=9)
        self.assertAlmostEqual(1.0, result["ssim_turned"], places=9)
        self.assertLess(result["ssim"], 0.3)

    def test_ranks_are_compared_and_not_sizes(self):
        result = compare(slope(), np.exp(slope() / 4.0))
        self.assertAlmostEqual(1.0, result["spearman_rho"], places=9)
        self.assertLess(result["ssim"], 0.99)

    def test_noise_is_like_nothing(self):
        noise = np.random.default_rng(1).normal(size=(40, 40))
        result = compare(slope(40, 40), noise)
        self.assertLess(abs(result["spearman_rho"]), 0.1)
        self.assertLess(abs(result["ssim"]), 0.1)

    def test_unknown_cells_do_not_count(self):
        values, field = slope(), slope()
        values[2:5, 3:6] = np.nan
        field[8, 8] = np.nan
        result = compare(values, field)
        self.assertEqual(12 * 14 - 10, result["cells"])
        self.assertAlmostEqual(1.0, result["spearman_rho"], places=9)

    def test_a_map_without_difference_says_nothing(self):
        self.assertIsNone(compare(slope(), np.ones((12, 14)))["spearman_rho"])
        self.assertIsNone(compare(slope(), np.full((12, 14), np.nan))["ssim"])

    def test_a_picture_and_a_report_are_written(self):
        values = slope()
        values[0, 0] = np.nan
        path = written(self.folder.name, values, {"warmth": slope(), "salt": -slope()})
        output = os.path.join(self.folder.name, "out")
        lines = make(path, output)
        self.assertIn("temperature: rank correlation (Spearman) +1.00", lines[0])
        self.assertIn("salt: rank correlation (Spearman) −1.00", lines[1])
        report = json.loads(pathlib.Path(output + ".json").read_text(encoding="utf-8"))
        self.assertEqual(167, report["seas"][0]["cells"])
        self.assertIn("not whether one causes the other", report["note"])
        self.assertEqual(b"\x89PNG", pathlib.Path(output + ".png").read_bytes()[:4])
        self.assertEqual(3, len(os.listdir(self.folder.name)), "no temporary file is left")

    def test_a_ranch_without_a_sea_has_a_picture_of_its_values(self):
        output = os.path.join(self.folder.name, "calm")
        self.assertEqual([], make(written(self.folder.name, slope(), {}), output))
        self.assertEqual(b"\x89PNG", pathlib.Path(output + ".png").read_bytes()[:4])

    def test_the_picture_states_the_range_and_marks_the_best_start(self):
        values = slope()
        values[1:3, 2:4] = -50.0
        values[9, 10] = 99.0
        text = {"cell_size_m": 500.0, "ports": [[0, 0]], "devices": [[10, 8]]}
        low = values.min()
        self.assertLess(low, 0.0)
        said = verdict(values, text)
        self.assertEqual(f"All returns are between {low:.0f} and 99 points.\nBest start: the star "
                         "on map (a), next to a device; lowest returns: dark on map (a)", said)
        self.assertEqual((10, 9), best_cell(values))
        even = np.full((5, 6), 95.0)
        even[4, 5] = 100.0
        self.assertIn("between 95 and 100 points (a difference of 5 %).\nBest start: the star on "
                      "map (a); ", verdict(even, text), "no device or port is near")
        text["devices"] = [[10, 9]]
        self.assertIn("map (a), at a device;", verdict(values, text))
        for nothing in (np.ones((3, 4)), np.full((3, 4), np.nan)):
            self.assertEqual("", verdict(nothing, text))
            self.assertIsNone(best_cell(nothing))
        _, axis = pyplot.subplots()
        self.addCleanup(pyplot.close, "all")
        draw_places(axis, {}, 0.5, (10, 9))
        star, = axis.collections
        self.assertEqual(("best start", [[5.25, 4.75]]),
                         (star.get_label(), star.get_offsets().tolist()))

    def test_the_figure_uses_words_and_units_that_people_know(self):
        values = slope()
        layer = ("warmth", "degC", slope())
        _, axis = pyplot.subplots()
        self.addCleanup(pyplot.close, "all")
        draw_relation(axis, values, layer, compare(values, layer[2]), "d")
        title = axis.get_title("left")
        self.assertEqual("(d) Return and temperature: +1.00\nwithout the lowest twentieth: +1.00",
                         title)
        self.assertEqual("temperature [°C]", axis.get_xlabel())
        for jargon in ("SSIM", "Spearman", "rho", "turned over", "degC"):
            self.assertNotIn(jargon, title)

    def test_the_headline_names_what_the_return_falls_and_rises_with(self):
        values = slope()
        text = {"cell_size_m": 1000.0, "devices": [[0, 0]]}
        layers = [("warmth", "degC", values), ("depth", "m", -values), ("flat", "m", 0.0 * values)]
        found = headline([*((layer, compare(values, layer[2])) for layer in layers),
                          device_relation(values, text)])
        self.assertIn("rises with temperature (rank correlation +1.00)", found)
        self.assertIn("falls with depth (−1.00)", found)
        self.assertNotIn("flat", found, "a constant layer has no rank correlation")
        self.assertIn("distance to a device (", found)
        weak = {"spearman_rho": 0.1}
        self.assertEqual("The return falls with depth (rank correlation −1.00), but has no steady "
                         "trend with temperature (+0.10)", headline(
                             [(layers[0], weak), (layers[1], compare(values, layers[1][2]))]))
        self.assertEqual("The return has no steady trend with temperature (rank correlation +0.10)",
                         headline([(layers[0], weak)]))

    def test_a_long_headline_stays_inside_the_picture(self):
        values = slope()
        text = {"cell_size_m": 1000.0, "devices": [[0, 0]], "episodes": 1, "episode": 0,
                "policy": "planner", "scenario": "paper"}
        layers = [("warmth", "degC", values), ("depth", "m", -values)]
        self.addCleanup(pyplot.close, "all")
        with unittest.mock.patch.object(pyplot, "close"), tempfile.TemporaryDirectory() as folder:
            draw(text, values, layers, [compare(values, layer[2]) for layer in layers],
                 pathlib.Path(folder) / "values.png")
        figure = pyplot.gcf()
        title = next(one for one in figure.texts if "rank correlation" in one.get_text())
        box = title.get_window_extent(figure.canvas.get_renderer())
        self.assertLess(box.x1, figure.bbox.width)
        self.assertGreater(title.get_text().count("\n"), 0)
        legend, = figure.legends
        self.assertIn("best start", [text.get_text() for text in legend.get_texts()])
        key = legend.get_window_extent()
        self.assertTrue(0.0 <= key.x0 and key.x1 <= figure.bbox.width, key)
        self.assertLess(key.y1, min(axis.xaxis.label.get_window_extent().y0
                                    for axis in figure.axes if axis.get_xlabel()))

    def test_the_lowest_returns_do_not_flatten_the_colours_of_the_others(self):
        values = slope()
        values[0, 0] = -10_000.0
        _, axis = pyplot.subplots()
        self.addCleanup(pyplot.close, "all")
        draw_map(axis, values, 1.0, "viridis", "return", 0.05)
        low, high = axis.images[0].get_clim()
        self.assertGreater(low, -10_000.0)
        self.assertEqual(np.nanmax(values), high)

    def test_ports_and_devices_are_marked_at_the_middle_of_their_cells(self):
        _, axis = pyplot.subplots()
        self.addCleanup(pyplot.close, "all")
        draw_places(axis, {"ports": [[0, 2], [3, 1]], "devices": [[4, 4]]}, 0.5)
        marked = {mark.get_label(): mark.get_offsets().tolist() for mark in axis.collections}
        self.assertEqual({"port": [[0.25, 1.25], [1.75, 0.75]], "device": [[2.25, 2.25]]}, marked)

    def test_a_file_without_ports_is_drawn_without_them(self):
        _, axis = pyplot.subplots()
        self.addCleanup(pyplot.close, "all")
        draw_places(axis, {}, 0.5)
        self.assertEqual(0, len(axis.collections))

    def test_another_file_is_refused(self):
        path = pathlib.Path(self.folder.name) / "x.json"
        path.write_text("{}", encoding="utf-8")
        with self.assertRaisesRegex(ValuesError, "x.json: not a file of aquafarm_evaluate"):
            read(path)
        path = written(self.folder.name, slope(), {"warmth": slope(5, 5)})
        with self.assertRaisesRegex(ValuesError, "maps of different sizes"):
            read(path)

    def test_messages_hold_the_map(self):
        values = np.array([[1.0, np.nan, 3.0], [5.0, 2.0, 4.0]])
        grid = values_topics.to_grid(values, 200.0, rospy.Time())
        self.assertEqual([0, -1, 50, 100, 25, 75], list(grid.data))
        self.assertEqual((3, 2, 200.0), (grid.info.width, grid.info.height, grid.info.resolution))
        cloud = values_topics.to_points(values, 200.0, rospy.Time())
        points = list(point_cloud2.read_points(cloud, ("x", "y", "value", "action")))
        self.assertEqual([(0.0, 0.0, 1.0, 255), (400.0, 0.0, 3.0, 255), (0.0, 200.0, 5.0, 255),
                          (200.0, 200.0, 2.0, 255), (400.0, 200.0, 4.0, 255)], points)
        empty = values_topics.to_grid(np.full((2, 2), np.nan), 1.0, rospy.Time())
        self.assertEqual([-1] * 4, list(empty.data))

    def test_the_command_plays_a_planner_on_a_ranch_with_a_sea(self):
        sea = ", ".join(str(20 + i // 6) for i in range(36))
        ranch = os.path.join(self.folder.name, "ranch.yaml")
        pathlib.Path(ranch).write_text(
            "name: pond\ngrid: {width: 6, height: 6}\n"
            "layout:\n  rocks: {count: [0, 0]}\n  ports: {cells: [[0, 0]]}\n"
            "  devices: {placement: explicit, sites: [{cell: [5, 5], kind: monitoring}]}\n"
            f"seas: {{layers: [{{name: warmth, values: [{sea}]}}]}}\n", encoding="utf-8")
        output = os.path.join(self.folder.name, "pond")
        program = roslib.packages.find_node("aquafarm_bringup", "compare_values")[0]
        done = subprocess.run([program, "clairvoyant", ranch, "-o", output], check=False,
                              capture_output=True, text=True, timeout=100)
        self.assertEqual(0, done.returncode, done.stderr)
        # The device is in the north-east: a start farther north reaches it sooner.
        report = json.loads(pathlib.Path(output + ".json").read_text(encoding="utf-8"))
        self.assertEqual(36, report["seas"][0]["cells"])
        self.assertGreater(report["seas"][0]["spearman_rho"], 0.5)
        refused = subprocess.run([program, "clairvoyant", ranch + ".none", "-o", output],
                                 check=False, capture_output=True, text=True, timeout=100)
        self.assertEqual(2, refused.returncode)
        self.publishes([program, "planner", ranch, "-o", output, "--publish",
                        "--namespace", "/pond"])

    def publishes(self, command):
        """Checks that the maps are published on latched topics, and the error without a master."""
        alone = subprocess.run(command, check=False, capture_output=True, text=True, timeout=100,
                               env={**os.environ, "ROS_MASTER_URI": "http://127.0.0.1:9"})
        self.assertEqual(2, alone.returncode)
        self.assertIn("cannot reach a ROS master at http://127.0.0.1:9", alone.stderr)
        rospy.init_node("values_test", anonymous=True, disable_signals=True)
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as playing:
            try:
                grid = rospy.wait_for_message("/pond/values", OccupancyGrid, timeout=100)
                cloud = rospy.wait_for_message("/pond/values/points", PointCloud2, timeout=60)
            finally:
                playing.send_signal(signal.SIGINT)
                self.assertEqual(0, playing.wait(30))
        self.assertEqual(36, len(grid.data))
        values = {(x, y): value for x, y, value in
                  point_cloud2.read_points(cloud, ("x", "y", "value"))}
        best = max(values, key=values.get)
        self.assertEqual(100, grid.data[int(best[1] / grid.info.resolution) * 6 +
                                        int(best[0] / grid.info.resolution)])


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "values", ValuesTest, sys.argv)
