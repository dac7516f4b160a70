#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the data in the figures of §4 with numbers computed from each episode."""
import sys
import unittest
import unittest.mock

import numpy as np
import rosunit
from matplotlib.text import Text

from aquafarm_benchmark import figures
from aquafarm_benchmark.protocol import CONTESTANTS

WINDOW = 50


def by_name(name):
    return next(one for one in CONTESTANTS if one.name == name)


def make_run(seed, episodes):
    """Returns a run in the format of results.read_run with random returns, steps and losses."""
    rng = np.random.Generator(np.random.PCG64(seed))
    return {"curve": {"return": rng.normal(10.0 * seed, 5.0, episodes),
                      "steps": rng.integers(1, 100, episodes).astype(float),
                      "success": np.ones(episodes),
                      "loss": np.abs(rng.normal(2.0, 1.0, episodes))}}


class FiguresTest(unittest.TestCase):

    def setUp(self):
        self.contestants = [by_name("sarsa"), by_name("lstm_dqn")]
        # The lengths of a learner's runs may differ by one or two episodes.
        self.runs = {"sarsa": [make_run(1, 120), make_run(2, 121)],
                     "lstm_dqn": [make_run(3, 120), make_run(4, 120)]}
        _, self.axes = figures.plt.subplots()
        self.addCleanup(figures.plt.close, "all")

    def lines(self, axes=None):
        """Returns {label: (x, y)} of the curves with a label."""
        return {line.get_label(): (np.asarray(line.get_xdata()), np.asarray(line.get_ydata()))
                for line in (axes or self.axes).lines if not line.get_label().startswith("_")}

    def test_fig_12a_shows_rewards_by_time_steps(self):
        figures.plot_rewards_by_steps(self.axes, self.contestants, self.runs, 90.0)
        x, y = self.lines()["SARSA"]
        curve = self.runs["sarsa"][0]["curve"]
        self.assertEqual(71, len(x))
        for place, last in enumerate(range(WINDOW - 1, 120)):
            self.assertAlmostEqual(sum(curve["steps"][:last + 1]), x[place])
            self.assertAlmostEqual(sum(curve["return"][last - WINDOW + 1:last + 1]) / WINDOW,
                                   y[place])
        np.testing.assert_array_equal([90.0, 90.0], self.lines()["clairvoyant"][1])

    def test_fig_12b_shows_the_mean_of_all_episodes_so_far(self):
        figures.plot_average_rewards(self.axes, self.contestants, self.runs)
        x, y = self.lines()["SARSA"]
        first, second = (run["curve"]["return"] for run in self.runs["sarsa"])
        np.testing.assert_array_equal(np.arange(1, 121), x)
        for episode in (1, 2, 60, 120):
            expected = (sum(first[:episode]) + sum(second[:episode])) / (2.0 * episode)
            self.assertAlmostEqual(expected, y[episode - 1])

    def test_fig_12c_shows_the_mean_square_error(self):
        for run in self.runs["sarsa"]:
            run["curve"]["loss"][:10] = np.nan  # before the first update
        self.runs["lstm_dqn"][0]["curve"]["loss"][:] = np.nan
        figures.plot_square_error(self.axes, self.contestants, self.runs)
        x, y = self.lines()["SARSA"]
        np.testing.assert_array_equal(np.arange(WINDOW, 121), x)
        for place in (0, 33, 70):
            means = [np.nanmean(run["curve"]["loss"][place:place + WINDOW])
                     for run in self.runs["sarsa"]]
            self.assertAlmostEqual(np.sqrt(means[0] * means[1]), y[place])
        loss = self.runs["lstm_dqn"][1]["curve"]["loss"]  # of the run that has updates
        np.testing.assert_allclose(
            [np.mean(loss[place:place + WINDOW]) for place in range(121 - WINDOW)],
            self.lines()["LSTM-DQN"][1])

    def test_fig_12c_shows_each_run_and_the_middle_half(self):
        self.runs["sarsa"] = [make_run(seed, 120) for seed in range(1, 6)]
        for factor, run in zip((1.0, 2.0, 3.0, 4.0, 500.0), self.runs["sarsa"]):
            run["curve"]["loss"] = np.full(120, factor)
        figures.plot_square_error(self.axes, [by_name("sarsa")], self.runs)
        _, y = self.lines()["SARSA"]
        np.testing.assert_allclose(3.0, y, err_msg="the median, whatever one run does")
        thin = sorted(float(line.get_ydata()[0]) for line in self.axes.lines
                      if line.get_label() == "_run")
        np.testing.assert_allclose([1.0, 2.0, 3.0, 4.0, 500.0], thin)
        edge = self.axes.collections[0].get_paths()[0].vertices[:, 1]
        np.testing.assert_allclose([2.0, 4.0], [edge.min(), edge.max()])

    def test_names_stand_at_the_ends_of_the_lines_and_apart_from_each_other(self):
        self.runs["lstm_dqn"] = self.runs["sarsa"]  # both lines end at the same place
        figures.plot_repeated(self.axes, self.contestants, self.runs, 90.0)
        names = {text.get_text(): text.get_position()[1] for text in self.axes.texts}
        self.assertEqual({"SARSA, 2 runs", "LSTM-DQN, 2 runs", "clairvoyant"}, set(names))
        places = sorted(names.values())
        for lower, upper in zip(places, places[1:]):
            self.assertGreaterEqual(upper - lower, 0.06)
        self.assertLessEqual(places[-1], 1.0001)
        self.assertEqual(names["clairvoyant"], places[-1], "the highest line has the highest name")

    def test_lines_to_names_cross_no_name_and_all_names_are_in_reach_of_the_axes(self):
        ends = [(100.0, value, "black", f"learner {i}")
                for i, value in enumerate((-3000.0, 120.0, 125.0, 131.0, 132.0, 133.0))]
        self.axes.set_xlim(0.0, 100.0)
        self.axes.set_ylim(-3500.0, 140.0)
        figures._name_ends(self.axes, ends)
        figure = self.axes.figure
        figure.canvas.draw()
        renderer = figure.canvas.get_renderer()
        boxes = {text: Text.get_window_extent(text, renderer)  # without the line
                 for text in self.axes.texts}
        around = self.axes.get_window_extent(renderer)
        for text, box in boxes.items():
            self.assertGreaterEqual(text.get_fontsize(), 10)
            self.assertGreater(box.y0, around.y0 - box.height)
            self.assertLess(box.y1, around.y1 + box.height)
            line = text.arrow_patch.get_path().transformed(text.arrow_patch.get_transform())
            for points in line.to_polygons(closed_only=False):
                for (x0, y0), (x1, y1) in zip(points, points[1:]):
                    for share in np.linspace(0.0, 1.0, 60):
                        at = (x0 + share * (x1 - x0), y0 + share * (y1 - y0))
                        for other, name in boxes.items():
                            inner = name.padded(-1.0)
                            self.assertFalse(inner.contains(*at),
                                             f"{text.get_text()} through {other.get_text()}")
        for one in boxes.values():
            self.assertEqual(1, sum(one.overlaps(other) for other in boxes.values()))

    def test_places_are_spread_within_the_axes(self):
        spread = figures.spread([0.5, 0.95, 0.96, 0.97, 0.98], 0.06)
        self.assertEqual(0.5, spread[0])
        self.assertLessEqual(spread[-1], 1.0)
        for lower, upper in zip(spread, spread[1:]):
            self.assertGreaterEqual(upper - lower, 0.0599)

    def test_the_axis_of_returns_states_its_scale_and_has_ticks_on_both_sides(self):
        figures.plot_repeated(self.axes, self.contestants, self.runs, 90.0)
        self.assertIn("linear to ±100, then logarithmic", self.axes.get_ylabel())
        low, high = self.axes.get_ylim()
        shown = [tick for tick in self.axes.get_yticks() if low <= tick <= high]
        self.assertGreaterEqual(len(shown), 3)

    def test_fig_13_shows_the_return_per_step(self):
        figures.plot_mean_score(self.axes, self.contestants, self.runs)
        x, y = self.lines()["SARSA"]
        np.testing.assert_array_equal(np.arange(WINDOW, 121), x)
        for place in (0, 33, 70):
            scores = []
            for run in self.runs["sarsa"]:
                part = slice(place, place + WINDOW)
                scores.append(sum(run["curve"]["return"][part]) /
                              sum(run["curve"]["steps"][part]))
            self.assertAlmostEqual(sum(scores) / 2.0, y[place])

    def test_fig_13_has_a_panel_of_lstm_dqn_one_of_sarsa_and_one_of_all(self):
        panels = []

        def keep(figure, _):
            panels.extend(set(self.lines(axes)) for axes in figure.axes)

        with unittest.mock.patch.object(figures, "_save", keep):
            figures.draw_mean_score("nowhere", self.contestants, self.runs)
        self.assertEqual([{"LSTM-DQN"}, {"SARSA"}, {"SARSA", "LSTM-DQN"}], panels)

    def test_fig_14_shades_a_standard_deviation_of_the_runs(self):
        figures.plot_repeated(self.axes, self.contestants, self.runs, None)
        _, y = self.lines()["SARSA, 2 runs"]
        means = [sum(run["curve"]["return"][:WINDOW]) / WINDOW for run in self.runs["sarsa"]]
        self.assertAlmostEqual(sum(means) / 2.0, y[0])
        edge = self.axes.collections[0].get_paths()[0].vertices
        at_start = edge[edge[:, 0] == WINDOW][:, 1]
        spread = abs(means[0] - means[1]) / 2.0
        self.assertAlmostEqual(y[0] - spread, at_start.min())
        self.assertAlmostEqual(y[0] + spread, at_start.max())

    def test_bars_show_the_interquartile_mean_and_its_interval(self):
        rows = [{"name": "sarsa", "return_iqm": 230.0, "return_interval": [200.0, 250.0]},
                {"name": "lstm_dqn", "return_iqm": -5.0, "return_interval": [np.nan, np.nan]}]
        figures.plot_evaluation(self.axes, self.contestants, rows)
        self.assertEqual([230.0, -5.0], [bar.get_height() for bar in self.axes.patches])
        _, _, bars = self.axes.containers[0].lines
        segment = bars[0].get_segments()[0]
        self.assertEqual([200.0, 250.0], [segment[0][1], segment[1][1]])


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "figures", FiguresTest, sys.argv)
