#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the data in the figures of §4 with numbers computed from each episode."""
import itertools
import pathlib
import re
import sys

import numpy as np
import rosunit
from matplotlib.text import Text

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from aquafarm_benchmark import evaluation_figure, figures, headlines, style  # noqa: E402
from aquafarm_benchmark.curves import End  # noqa: E402
from aquafarm_benchmark.protocol import CONTESTANTS, PROFILES  # noqa: E402
from figure_case import OPTIMUM, WINDOW, FigureCase, by_name, make_run  # noqa: E402


class FiguresTest(FigureCase):

    def test_fig_12a_shows_rewards_by_time_steps(self):
        figures.plot_rewards_by_steps(self.axes, self.contestants, self.runs, OPTIMUM)
        x, y = self.lines()["SARSA"]
        curve = self.runs["sarsa"][0]["curve"]
        self.assertEqual(71, len(x))
        for place, last in enumerate(range(WINDOW - 1, 120)):
            self.assertAlmostEqual(sum(curve["steps"][:last + 1]), x[place])
            self.assertAlmostEqual(sum(curve["return"][last - WINDOW + 1:last + 1]) / WINDOW,
                                   y[place])
        reference = [line for line in self.axes.lines if line.get_label() == "_reference"]
        np.testing.assert_array_equal([90.0, 90.0], reference[0].get_ydata())

    def test_fig_12b_shows_the_mean_of_all_episodes_so_far(self):
        figures.plot_average_rewards(self.axes, self.contestants, self.runs, OPTIMUM)
        x, y = self.lines()["SARSA"]
        first, second = (run["curve"]["return"] for run in self.runs["sarsa"])
        np.testing.assert_array_equal(np.arange(1, 121), x)
        for episode in (1, 2, 60, 120):
            expected = (sum(first[:episode]) + sum(second[:episode])) / (2.0 * episode)
            self.assertAlmostEqual(expected, y[episode - 1])

    def test_names_stand_at_the_ends_of_the_lines_and_apart_from_each_other(self):
        self.runs["lstm_dqn"] = self.runs["sarsa"]  # both lines end at the same place
        style.name_ends(self.axes, figures.plot_repeated(self.axes, self.contestants, self.runs,
                                                            OPTIMUM))
        names = {text.get_text(): text.get_position()[1] for text in self.axes.texts}
        self.assertEqual({"SARSA", "LSTM-DQN", "clairvoyant 90"}, set(names))
        places = sorted(names.values())
        for lower, upper in zip(places, places[1:]):
            self.assertGreaterEqual(upper - lower, 0.05)
        self.assertLessEqual(places[-1], 1.03)
        self.assertEqual(names["clairvoyant 90"], places[-1], "the highest line has the highest name")

    def test_lines_to_names_cross_no_name_and_all_names_are_in_reach_of_the_axes(self):
        ends = [End(100.0, value, "black", f"learner {i}")
                for i, value in enumerate((-3000.0, 120.0, 125.0, 131.0, 132.0, 133.0))]
        self.axes.set_xlim(0.0, 100.0)
        self.axes.set_ylim(-3500.0, 140.0)
        style.name_ends(self.axes, ends)
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
        spread = style.spread([0.5, 0.95, 0.96, 0.97, 0.98], 0.06)
        self.assertEqual(0.5, spread[0])
        self.assertLessEqual(spread[-1], 1.0)
        for lower, upper in zip(spread, spread[1:]):
            self.assertGreaterEqual(upper - lower, 0.0599)

    def test_returns_are_linear_above_zero_and_logarithmic_below(self):
        for run in self.runs["sarsa"]:
            run["curve"]["return"] -= 1000.0
        for draw, count in ((figures.draw_repeated, 1), (figures.draw_average_rewards, 1),
                            (figures.draw_rewards, 1)):
            figure = self.drawn(draw, self.contestants, self.runs, OPTIMUM)
            strips = int(draw is figures.draw_rewards)  # its lower chart has no returns
            self.assertEqual(count + strips, len(figure.axes))
            for axes in figure.axes[:count]:
                low, high = axes.get_ylim()
                self.assertLess(low, -990.0)
                self.assertGreater(high, 90.0)
                height = axes.transAxes.inverted().transform(
                    axes.transData.transform([(1.0, y) for y in (-990.0, -480.0, 0.0, 30.0, 60.0)]))
                steps = np.diff(height[:, 1])
                self.assertAlmostEqual(steps[2], steps[3], msg="30 points above 0")
                self.assertGreater(steps[2], 2.0 * 30.0 / 510.0 * steps[0])
                self.assertTrue(all(low <= tick <= high for tick in axes.get_yticks()))
            names = self.names_of(axes)
            self.assertTrue(any("SARSA" in name for name in names))
            self.assertTrue(any("LSTM" in name for name in names))
            self.assertIn("clairvoyant 90", names)

    def test_returns_below_zero_only_have_a_linear_scale(self):
        for runs in self.runs.values():
            for run in runs:
                run["curve"]["return"] -= 1000.0
        axes, = self.drawn(figures.draw_repeated, self.contestants, self.runs, {}).axes
        self.assertEqual("linear", axes.get_yscale())
        self.assertLess(axes.get_ylim()[1], 0.0)
        ends = {one.label: np.median([run["curve"]["return"][-WINDOW:].mean()
                                      for run in self.runs[one.name]]) for one in self.contestants}
        self.assertEqual({f"{name} −{-value:.0f}" for name, value in ends.items()},
                         {name.split(" (")[0].replace(headlines.NBSP, " ")
                          for name in self.names_of(axes)}, "the range of the runs is in brackets")
        self.assertEqual(f"LSTM-DQN ends with the highest return: −{-ends['LSTM-DQN']:.0f}. Each "
                         "of its runs is above all runs of the others.",
                         " ".join(axes.figure._suptitle.get_text().split()))

    def test_names_in_a_grid_do_not_widen_a_column_with_a_free_place_next_to_it(self):
        figure, charts = style.chart_grid(4)
        self.assertEqual(6, len(figure.axes))
        for axes in charts:
            axes.plot([0.0, 9.0], [0.0, 5.0])
            style.name_ends(axes, [End(9.0, 5.0, "black", "SARSA")])
        figure.draw_without_rendering()
        widths = [axes.get_position().width for axes in charts]
        self.assertAlmostEqual(min(widths), max(widths))
        self.assertEqual([False, False, True, False],
                         [axes.texts[0].get_in_layout() for axes in charts])

    def test_a_reference_that_nearly_equals_a_higher_one_is_left_out(self):
        references = {"planner": 276.0, "clairvoyant": 277.6, "x": 5.0}
        ends = figures._plot_references(self.axes, references, 9)
        self.assertEqual([(9, 277.6, "clairvoyant 278"), (9, 5.0, "x 5")],
                         [(end.x, end.y, end.name) for end in ends])
        self.assertEqual([277.6, 5.0], [line.get_ydata()[0] for line in self.axes.lines])
        ends = figures._plot_references(self.axes, references, 9, alike=0.0)
        self.assertEqual([277.6, 276.0, 5.0], [end.y for end in ends])

    def test_names_are_legible_on_white(self):
        def contrast(colour):
            linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
            return 1.05 / (0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05)

        for one in CONTESTANTS:
            self.assertGreaterEqual(contrast(style.legible(one.colour)), 4.5, one.label)
        self.assertEqual((0.0, 0.0, 0.0), style.legible("black"))

    def test_fig_13_shows_the_return_per_step(self):
        figures.plot_mean_score(self.axes, self.contestants, self.runs, {})
        x, y = self.lines()["SARSA"]
        np.testing.assert_array_equal(np.arange(WINDOW, 121), x)
        for place in (0, 33, 70):
            scores = []
            for run in self.runs["sarsa"]:
                part = slice(place, place + WINDOW)
                scores.append(sum(run["curve"]["return"][part]) /
                              sum(run["curve"]["steps"][part]))
            self.assertAlmostEqual(sum(scores) / 2.0, y[place])

    def test_fig_13_has_a_panel_of_each_learner_and_one_of_all(self):
        self.runs["random"] = self.runs["dqn"] = [make_run(1, 120), make_run(2, 120)]
        contestants = [*self.contestants, by_name("dqn"), by_name("random")]
        figure = self.drawn(figures.draw_mean_score, contestants, self.runs, {"clairvoyant": 5.1})
        *shown, first_hidden, second_hidden, end = figure.axes
        self.assertFalse(first_hidden.axison or second_hidden.axison)
        self.assertEqual(1, len({axes.get_ylim() for axes in shown}), "one scale")
        self.assertEqual([{"SARSA", "RANDOM"}, {"LSTM-DQN", "RANDOM"}, {"DQN", "RANDOM"}],
                         [set(self.lines(axes)) for axes in shown])
        self.assertEqual({"LSTM-DQN", "SARSA", "DQN"}, set(self.lines(end)))
        self.assertEqual([2, 2, 2, 0], [len(axes.collections) for axes in [*shown, end]], "shades")
        self.assertEqual((90.0, 120.0), end.get_xlim(), "the last 25 %")
        low = min(y[x >= 90].min() for x, y in self.lines(end).values())
        high = max(5.1, *(y[x >= 90].max() for x, y in self.lines(end).values()))
        margin = 0.06 * (high - low)
        np.testing.assert_allclose((low - margin, high + margin), end.get_ylim())
        names = {name.replace(headlines.NBSP, " ") for name in self.names_of(end)}
        self.assertEqual({"SARSA", "LSTM-DQN", "DQN", "clairvoyant"},
                         {name.split()[0] for name in names})
        self.assertTrue(all(re.match(r"\S+ \d\.\d\d$", name) for name in names), names)
        random = self.lines(shown[0])["RANDOM"][1][-1]
        self.assertEqual([{"clairvoyant 5.10", f"RANDOM{headlines.NBSP}{random:.2f}"}, set(),
                          set()], [self.names_of(axes) for axes in shown], "names in the first chart")
        titles = [axes.get_title("left") for axes in shown]
        self.assertEqual("medians of all, last 25 % enlarged", end.get_title("left"))
        for name, title in zip(("SARSA", "LSTM-DQN", "DQN"), titles):
            self.assertRegex(title, rf"^{name}: \d\.\d\d \(\d\.\d\d to \d\.\d\d\)$")
        self.assertEqual("points per step", shown[0].get_ylabel())
        printed = next(one for one in PROFILES["paper"].contestants if one.name == "sarsa_printed")
        self.runs["sarsa_printed"] = self.runs["sarsa"]
        alone = self.drawn(figures.draw_mean_score, [printed], self.runs, {})
        self.assertTrue(alone.axes[0].get_title("left").startswith("SARSA, printed:\n"), "long")
        self.assertEqual("medians of all", alone.axes[1].get_title("left"), "one learns")
        for run in self.runs["sarsa"]:
            run["curve"]["success"] = np.zeros(120)
        some = self.drawn(figures.draw_mean_score, contestants, self.runs, {}).axes[-1]
        self.assertEqual("medians of those that learn, last 25 % enlarged", some.get_title("left"))
        self.assertEqual({"LSTM-DQN", "DQN"}, set(self.lines(some)))

    def test_fig_12a_marks_where_a_learner_reaches_90_percent_and_ends_with_the_last_learner(self):
        rising = np.array([-100.0] * 50 + [100.0] * 100)
        self.runs["sarsa"] = [{"curve": {"return": rising, "steps": np.full(150, 10)}}]
        self.runs["lstm_dqn"] = [{"curve": {"return": np.zeros(150), "steps": np.full(150, 8)}}]
        random = next(one for one in CONTESTANTS if one.name == "random")
        for steps, has_random in ((20, True), (2000, False)):
            self.runs["random"] = [{"curve": {"return": np.full(150, -900.0),
                                              "steps": np.full(150, steps)}}]
            _, axes = style.plt.subplots()
            ends = figures.plot_rewards_by_steps(axes, [*self.contestants, random], self.runs,
                                                 {"clairvoyant": 100.0})
            self.assertEqual({"SARSA 980"}, {text.get_text() for text in axes.texts})
            lines = self.lines(axes)
            self.assertEqual(has_random, "RANDOM" in lines)
            self.assertEqual({"LSTM-DQN: 90 % not reached", "90 % of 100", "clairvoyant 100"} |
                             ({"RANDOM"} if has_random else set()),
                             {end.name for end in ends})
            if has_random:
                self.assertLessEqual(lines["RANDOM"][0].max(), 1500, "SARSA ends there")

    def test_the_thick_line_of_fig_12a_is_the_run_nearest_to_the_median(self):
        self.assertEqual([1, 2, 0, 1], [figures._nearest_to_median(values) for values in (
            [9.0, 4.0, 1.0], [np.inf, 1.0, 5.0, 4.0], [np.inf, np.inf], [2.0, np.inf, np.inf])])
        rising = np.array([-100.0] * 50 + [100.0] * 100)  # reaches 90 % at episode 98
        runs = [{"curve": {"return": rising, "steps": np.full(150, steps)}}
                for steps in (40, 10, 20)]
        figures.plot_rewards_by_steps(self.axes, [by_name("sarsa")], {"sarsa": runs},
                                      {"clairvoyant": 100.0})
        self.assertEqual(20 * 150, self.lines()["SARSA"][0][-1])
        self.assertEqual(["SARSA 2k"], [text.get_text() for text in self.axes.texts])
        self.assertAlmostEqual(0.8 * 500, self.axes.get_xlim()[0], msg="left of the first value")
        dots = [line.get_xdata() for line in self.axes.lines if line.get_marker() == "o"]
        self.assertEqual([[1960]], [list(x) for x in dots], "the median")
        self.assertAlmostEqual(40 * 150, self.axes.get_xlim()[1], msg="the slowest run")
        figure = self.drawn(figures.draw_rewards, [by_name("sarsa")], {"sarsa": runs},
                            {"clairvoyant": 100.0})
        chart, strip = figure.axes
        self.assertEqual(chart.get_xlim(), strip.get_xlim())
        self.assertEqual("Time steps until 90 % is reached: runs (dots), median (tick), range "
                         "(bar)", strip.get_title("left"))
        self.assertEqual(["SARSA"], [name.get_text() for name in strip.get_yticklabels()])
        self.assertEqual(("", "time steps so far (logarithmic)"),
                         (chart.get_xlabel(), strip.get_xlabel()))
        self.assertIn("thick: the run whose time to 90 % is nearest to the median. Means",
                      " ".join(figure._supxlabel.get_text().split()))
        figure = self.drawn(figures.draw_rewards, [by_name("sarsa")], {"sarsa": runs},
                            {"clairvoyant": 900.0})
        self.assertIn("nearest to the median (of SARSA: the first run without 90 %).",
                      " ".join(figure._supxlabel.get_text().split()))

    def test_below_fig_12a_each_learner_has_the_range_of_its_times(self):
        def run(steps, top=100.0):
            return {"curve": {"return": np.array([-100.0] * 50 + [top] * 100),
                              "steps": np.full(150, steps)}}

        learners = [by_name(name) for name in ("q_learning", "sarsa", "dqn", "lstm_dqn")]
        runs = {"q_learning": [run(10, 0.0)] * 3, "sarsa": [run(40), run(10), run(20)],
                "dqn": [run(1), run(2), run(3)], "lstm_dqn": [run(5), run(9, 0.0), run(9, 0.0)]}
        figures.plot_times(self.axes, learners, runs, 90.0)
        marks = {}
        for line in self.axes.lines:
            marks.setdefault(line.get_label(), []).append(
                (int(line.get_ydata()[0]), *map(int, line.get_xdata())))
        self.assertEqual({"_range": [(0, 98, 294), (1, 980, 3920), (2, 490, 490)],
                          "_runs": [(0, 98, 196, 294), (1, 3920, 980, 1960), (2, 490)],
                          "_median": [(0, 196), (1, 1960)]}, marks)
        self.assertEqual(["DQN", "SARSA", "LSTM-DQN", "Q-learning"],
                         [name.get_text() for name in self.axes.get_yticklabels()])
        self.assertEqual({"in 1 of 3 runs": 2, "not reached": 3},
                         {text.get_text(): text.xy[1] for text in self.axes.texts})
        self.assertTrue(self.axes.yaxis_inverted(), "the fastest is at the top")

    def test_names_above_fig_12a_do_not_overlap(self):
        dqn = next(one for one in CONTESTANTS if one.name == "dqn")
        for name, steps in (("sarsa", 10), ("lstm_dqn", 12), ("dqn", 11)):  # close to each other
            rising = np.array([-100.0] * 50 + [100.0] * 100)
            self.runs[name] = [{"curve": {"return": rising, "steps": np.full(150, steps)}}]
        figure, axes = style.plt.subplots()
        figures.plot_rewards_by_steps(axes, [*self.contestants, dqn], self.runs,
                                      {"clairvoyant": 100.0})
        figure.draw_without_rendering()
        names = [Text.get_window_extent(text) for text in axes.texts]  # without the leaders
        self.assertEqual(3, len(names))
        self.assertFalse(any(one.overlaps(other) for one, other in itertools.combinations(names, 2)))
        self.assertGreater(min(one.y0 for one in names), axes.get_window_extent().y1,
                           "above the chart")
        self.assertGreaterEqual(min(one.x0 for one in names), axes.get_window_extent().x0,
                                "right of the axis of returns")

    def test_fig_14_enlarges_the_end_for_all_learners_that_learn(self):
        for name, returns in (("sarsa", (70.0, 85.0)), ("lstm_dqn", (80.0, 80.0))):
            for run, value in zip(self.runs[name], returns):
                run["curve"]["return"][:30] = -500.0
                run["curve"]["return"][30:] = value
        _, end = self.drawn(figures.draw_repeated, self.contestants, self.runs,
                            {**OPTIMUM, "planner": 89.0}).axes
        self.assertEqual({"LSTM-DQN", "SARSA"}, set(self.lines(end)))
        self.assertEqual({"LSTM-DQN", "SARSA", "clairvoyant 90", "planner 89", "range of\nthe runs"},
                         self.names_of(end), "a line for each reference")
        self.assertEqual(90.0, end.get_xlim()[0], "the last 25 %")
        self.assertLess(end.get_ylim()[0], 70.0)
        self.assertLess(90.0, end.get_ylim()[1])
        self.assertEqual("Enlarged: the last 25 % of the training, medians of the runs",
                         end.get_title("left"))
        bar, = (bars for bars in end.containers)
        segment, = bar.lines[2][0].get_segments()
        np.testing.assert_allclose([70.0, 85.0], segment[:, 1])
        self.assertTrue(120.0 < segment[0, 0] < end.get_xlim()[1], "right of the lines")
        sarsa, = (text for text in end.texts if text.get_text() == "SARSA")
        np.testing.assert_allclose((segment[0, 0], 77.5), sarsa.xy, err_msg="from bar to name")
        _, end = self.drawn(figures.draw_repeated, self.contestants, self.runs,
                            {**OPTIMUM, "planner": 20.0}).axes
        self.assertNotIn("planner 20", self.names_of(end), "it is below the chart")

    def test_fig_14_enlarges_nothing_if_less_than_two_learners_have_high_returns(self):
        for name in ("sarsa", "lstm_dqn"):
            for run in self.runs[name]:
                run["curve"]["return"][:] = 80.0
        self.assertEqual(2, len(self.drawn(figures.draw_repeated, self.contestants, self.runs,
                                           OPTIMUM).axes))
        self.runs["sarsa"][1]["curve"]["return"][-60:] = -1.0
        self.assertEqual(1, len(self.drawn(figures.draw_repeated, self.contestants, self.runs,
                                           OPTIMUM).axes), "a run ends below 0")
        for run in self.runs["sarsa"]:
            run["curve"]["return"][:] = 80.0
            run["curve"]["success"][:] = 0.0
        self.assertEqual(1, len(self.drawn(figures.draw_repeated, self.contestants, self.runs,
                                           OPTIMUM).axes), "one learns the task")

    def test_a_row_with_printed_settings_has_the_colour_of_its_learner_dashed(self):
        printed = next(one for one in PROFILES["paper"].contestants if one.name == "sarsa_printed")
        self.runs["sarsa_printed"] = self.runs["sarsa"]
        figures.plot_repeated(self.axes, [by_name("sarsa"), printed], self.runs, {})
        ours, theirs = self.axes.lines
        self.assertEqual(ours.get_color(), theirs.get_color())
        self.assertEqual(("-", "--"), (ours.get_linestyle(), theirs.get_linestyle()))
        random = by_name("random")
        self.assertEqual([random, printed, by_name("sarsa")],
                         headlines.without_printed([random, printed, by_name("sarsa")]))
        self.assertEqual([("RANDOM", "solid"), ("SARSA", "solid")],
                         [(one.label, one.linestyle)
                          for one in headlines.without_printed([random, printed])])

    def test_fig_14_shades_from_the_lowest_run_to_the_highest(self):
        figures.plot_repeated(self.axes, self.contestants, self.runs, {})
        _, y = self.lines()["SARSA"]
        means = [sum(run["curve"]["return"][:WINDOW]) / WINDOW for run in self.runs["sarsa"]]
        self.assertAlmostEqual(sum(means) / 2.0, y[0])
        edge = self.axes.collections[0].get_paths()[0].vertices
        at_start = edge[edge[:, 0] == WINDOW][:, 1]
        self.assertAlmostEqual(min(means), at_start.min())
        self.assertAlmostEqual(max(means), at_start.max())

    def test_bars_show_the_interquartile_mean_and_its_interval(self):
        rows = [{"name": "sarsa", "return_iqm": 230.0, "return_interval": [200.0, 250.0]},
                {"name": "lstm_dqn", "return_iqm": -5.0, "return_interval": [np.nan, np.nan]}]
        evaluation_figure.plot_evaluation(self.axes, self.contestants, rows)
        self.assertEqual([230.0, -5.0], [bar.get_height() for bar in self.axes.patches])
        _, _, bars = self.axes.containers[0].lines
        segment = bars[0].get_segments()[0]
        self.assertEqual([200.0, 250.0], [segment[0][1], segment[1][1]])


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "figures", FiguresTest, sys.argv)
