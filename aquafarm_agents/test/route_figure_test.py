#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the maps of routes with the steps of these routes."""
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import rosunit
from matplotlib.patches import Polygon, Rectangle

from aquafarm_benchmark import route_figure, style


class RouteFigureTest(unittest.TestCase):

    def setUp(self):
        _, self.axes = style.plt.subplots()
        self.addCleanup(style.plt.close, "all")

    def test_every_second_cell_has_an_arrow_in_the_direction_of_its_move(self):
        moves = [[0, 0, "north"], [1, 0, "east"], [2, 2, "south_west"], [3, 3, "pickup"],
                 [4, 0, "drop_off"], [6, 6, "north"], [8, 8, "north"], [10, 8, "north"]]
        route_figure.plot_moves(self.axes, moves, {"ports": [[6, 6]], "devices": [{"cell": [8, 8]}]})
        arrows, sign, pickups, drop_offs = self.axes.collections
        self.assertEqual(("best move", 0), (sign.get_label(), len(sign.get_offsets())), "the key")
        np.testing.assert_array_equal([[0, 0], [2, 2]], arrows.get_offsets())
        np.testing.assert_allclose([0.0, -arrows.V[0] / np.sqrt(2.0)], arrows.U, atol=1e-12)
        self.assertGreater(arrows.V[0], 0.0)
        self.assertAlmostEqual(arrows.U[1], arrows.V[1])
        np.testing.assert_array_equal([[3, 3]], pickups.get_offsets())
        np.testing.assert_array_equal([[4, 0]], drop_offs.get_offsets())

    def test_a_route_is_split_and_numbered_at_its_stops(self):
        steps = [{"cell": [0, 0], "action": "east", "aboard": 0},
                 {"cell": [1, 0], "action": "pickup", "aboard": 0},
                 {"cell": [1, 0], "action": "west", "aboard": 1},
                 {"cell": [0, 0], "action": "drop_off", "aboard": 1},
                 {"cell": [0, 0], "aboard": 0}]
        storms = ([{"x": 1.0, "y": 0.0, "radii": [0.5]}], [{"x": 0.0, "y": 0.0, "radii": [0.5]}])
        steps = [{**step, "disasters": storms[at > 1]} for at, step in enumerate(steps)]
        self.assertEqual([(False, [[0, 0], [1, 0]]), (True, [[1, 0], [1, 0], [0, 0]]),
                          (False, [[0, 0], [0, 0]])], route_figure.legs(steps))
        names = route_figure.place_names({"devices": [{"cell": [1, 0]}], "ports": [[5, 5], [0, 0]]})
        self.assertEqual([(1, "pickup", "F0", 2, "yes → no"), (2, "drop-off", "B", 4, "no → yes")],
                         route_figure.plot_route(self.axes, steps, names, {(5, 5), (0, 0)}))
        for line, cells in zip(self.axes.lines, ([(0, 0), (1, 0)], [(1, 0), (0, 0)])):
            np.testing.assert_array_equal(cells, line.get_xydata()[[0, -1]])
        self.assertEqual({"1": (1, 0), "2": (0, 0)},
                         {text.get_text(): text.xy for text in self.axes.texts})

    def test_a_ring_covers_cells_as_in_the_farm(self):
        def covering(cell, **rings):
            return route_figure.covering_rings({"x": 12.0, "y": 12.0, **rings}, [cell])

        self.assertEqual([1], covering([18, 12], radii=[2.0, 6.0]), "at the distance of the radius")
        self.assertEqual([], covering([19, 12], radii=[2.0, 6.0]))
        self.assertEqual([], covering([12, 12], radii=[0.0]), "there is no such ring")
        self.assertEqual([], covering([12, 12], radii=[]))
        for cell, quadrant in (([12, 15], 0), ([15, 12], 1), ([12, 9], 2), ([9, 12], 3)):
            radii = [5.0 if one == quadrant else 0.0 for one in range(4)]
            self.assertEqual([0], covering(cell, quadrants=[radii]), cell)
        self.assertEqual([], route_figure.covering_rings({"x": 0.0, "y": 0.0, "radii": [1.0]}, []))

    def test_rings_are_labelled_away_from_the_stops_also_if_there_are_none(self):
        self.axes.set_xlim(-1.0, 10.0)
        self.axes.set_ylim(-1.0, 10.0)
        step = {"cell": [2, 5], "aboard": 0, "disasters": [{"x": 5.0, "y": 5.0, "radii": [3.0]}]}
        sea = self.axes.add_patch(Rectangle((0.0, 0.0), 9.0, 9.0))
        route_figure._disasters(self.axes, [{**step, "action": "east"}], sea)
        route_figure._disasters(self.axes, [{**step, "action": "drop_off"}], sea)
        alone, away = (text.xy for text in self.axes.texts[:1] + self.axes.texts[-1:])
        self.assertAlmostEqual(3.0, float(np.hypot(alone[0] - 5.0, alone[1] - 5.0)))
        np.testing.assert_allclose([8.0, 5.0], away, atol=1e-9)

    def test_rings_are_drawn_at_the_steps_of_pickups(self):
        def steps(count, *pickups):
            return [{"action": "pickup" if at in pickups else "east"} for at in range(count)] + [{}]

        self.assertEqual([0, 9, 29, 45], route_figure.ring_steps(steps(52, 8, 28, 44)))
        self.assertEqual([0, 7], route_figure.ring_steps(steps(7, 6)), "the last step is a pickup")
        self.assertEqual([0, 17, 34, 52], route_figure.ring_steps(steps(52)))
        many = route_figure.ring_steps(steps(52, *range(0, 50, 5)))
        self.assertEqual((4, 0, 46), (len(many), many[0], many[-1]))
        self.assertEqual([0], route_figure.ring_steps(steps(0)))

    def test_rings_at_the_start_have_the_risks_of_the_scenario(self):
        self.axes.set_xlim(-1.0, 10.0)
        self.axes.set_ylim(-1.0, 10.0)
        sea = self.axes.add_patch(Rectangle((0.0, 0.0), 9.0, 9.0))
        steps = [{"cell": [0, 0], "action": "east",
                  "disasters": [{"x": 4.0, "y": 4.0, "radii": [1.0, 3.0]}]}]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scenario.yaml"
            self.assertEqual([], route_figure.risks_of(file), "no file")
            one = "  - kind: typhoon\n    risks: [-20, -5]\n"
            file.write_text(f"disasters:\n{one}")
            risks = route_figure.risks_of(file)
            route_figure._disasters(self.axes, steps, sea, risks)
            label, = self.axes.texts
            self.assertEqual(("step 0", 3.0), (label.get_text(), round(float(np.hypot(
                label.xy[0] - 4.0, label.xy[1] - 4.0)), 6)))
            self.assertEqual(["rings at step 0 (risk −5 to −20)"],
                             self.axes.get_legend_handles_labels()[1])
            self.assertEqual(2, sum(isinstance(one, Polygon) for one in self.axes.patches))
            file.write_text(f"disasters:\n{one}{one}")
            self.assertEqual([], route_figure.risks_of(file), "which disaster has which is unknown")
            for other in ("grade_factors: [1, 1, 1, 1]", "track: []"):
                file.write_text(f"disasters:\n{one}    {other}\n")
                self.assertEqual([], route_figure.risks_of(file), other)
            file.write_text("")
            self.assertEqual([], route_figure.risks_of(file), "an empty file")
        _, self.axes = style.plt.subplots()
        route_figure._disasters(self.axes, steps, sea, [-20.0])
        self.assertEqual(["rings at step 0"], self.axes.get_legend_handles_labels()[1],
                         "the scenario has other rings")
        _, self.axes = style.plt.subplots()
        later = [{**steps[0], "action": "pickup"}, *steps]
        route_figure._disasters(self.axes, later, sea, risks)
        signs, labels = self.axes.get_legend_handles_labels()
        self.assertEqual("outer ring at step 1", labels[1])
        self.assertNotEqual(tuple(signs[0].get_color()), tuple(signs[1].get_color()))


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "route_figure", RouteFigureTest, sys.argv)
