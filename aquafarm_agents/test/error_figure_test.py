#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the data in Fig. 12c with numbers computed from each episode."""
import pathlib
import sys
import warnings

import numpy as np
import rosunit

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from aquafarm_benchmark import error_figure, style  # noqa: E402
from figure_case import WINDOW, FigureCase, by_name, make_run  # noqa: E402


class ErrorFigureTest(FigureCase):

    def test_fig_12c_shows_the_mean_square_error(self):
        for run in self.runs["sarsa"]:
            run["curve"]["loss"][:10] = np.nan  # before the first update
        self.runs["lstm_dqn"][0]["curve"]["loss"][:] = np.nan
        error_figure.plot_square_error(self.axes, self.contestants, self.runs)
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

    def test_fig_12c_shows_the_median_and_shades_from_the_lowest_run_to_the_highest(self):
        self.runs["sarsa"] = [make_run(seed, 120) for seed in range(1, 6)]
        for factor, run in zip((1.0, 2.0, 3.0, 4.0, 500.0), self.runs["sarsa"]):
            run["curve"]["loss"] = np.full(120, factor)
        error_figure.plot_square_error(self.axes, [by_name("sarsa")], self.runs)
        _, y = self.lines()["SARSA"]
        np.testing.assert_allclose(3.0, y, err_msg="the median, whatever one run does")
        edge = self.axes.collections[0].get_paths()[0].vertices[:, 1]
        np.testing.assert_allclose([1.0, 500.0], [edge.min(), edge.max()])

    def test_the_headline_of_fig_12c_names_the_errors_that_rise(self):
        for name, last in (("sarsa", 30.0), ("lstm_dqn", 5.0)):
            for run in self.runs[name]:
                run["curve"]["loss"] = np.array([10.0] * 60 + [last] * 60)
        figure = self.drawn(error_figure.draw_square_error, self.contestants, self.runs)
        self.assertEqual("Only the error of SARSA (×3.0) ends higher than it begins",
                         " ".join(figure._suptitle.get_text().split()))
        self.assertEqual(["SARSA: 10 → 30", "LSTM-DQN: 10 → 5"],
                         [axes.get_title("left") for axes in figure.axes])
        early = "50 % succeed by episode 50"
        self.assertEqual([{"10", "30", early}, {"10", "5", early}],
                         [self.names_of(axes) for axes in figure.axes])

    def test_fig_12c_has_a_chart_of_each_learner_and_no_comparison_of_errors(self):
        contestants = [by_name(name) for name in ("q_learning", "sarsa", "dqn", "lstm_dqn", "ppo")]
        self.runs = {one.name: [make_run(1, 120)] for one in contestants}
        figure = self.drawn(error_figure.draw_square_error, contestants, self.runs)
        shown, (hidden,) = figure.axes[:5], figure.axes[5:]
        self.assertFalse(hidden.axison)
        self.assertEqual([{one.label} for one in contestants],
                         [set(self.lines(axes)) for axes in shown])
        self.assertEqual(["", "", "episode", "episode", "episode"],
                         [axes.get_xlabel() for axes in shown], "the lowest of each column")
        self.assertEqual({0, 3}, {i for i, axes in enumerate(shown) if axes.get_ylabel()})
        words = " ".join(figure._supxlabel.get_text().split())
        self.assertIn("errors of different learners cannot be compared", words)
        self.assertNotIn("Dot:", words, "the key is in the empty place")
        self.assertEqual(["first, last and, if it is far from both, highest value"],
                         [" ".join(text.get_text().split())
                          for text in hidden.get_legend().get_texts()])
        for learner in contestants[:3]:  # the first succeeds late, with its lowest error before
            curve = self.runs[learner.name][0]["curve"]
            curve.update(loss=np.array([1.0] * 60 + [9.0] * 60),
                         success=np.array([0.0] * 60 + [1.0] * 60))
        figure = self.drawn(error_figure.draw_square_error, contestants, self.runs)
        self.assertEqual(3, len(figure.axes[-1].get_legend().get_texts()))
        figure = self.drawn(error_figure.draw_square_error, contestants[:3], self.runs)
        words = " ".join(figure._supxlabel.get_text().split())
        for part in ("×: last value", "Dot: first, last", "Triangle: lowest error",
                     "Grey area: 50 %"):
            self.assertIn(part, words)

    def test_fig_12c_marks_the_lowest_error_if_the_policy_fails_then(self):
        def marks(successes):
            first, second = ({"curve": {"loss": np.array([40.0] * 60 + [last] * 60),
                                        "success": successes}} for last in (30.0, 8.0))
            first["curve"]["success"] = np.ones(120)
            _, axes = style.plt.subplots()
            error_figure._mark_low(axes, [first, second], "red")
            return [tuple(line.get_xydata()[0]) for line in axes.lines], self.names_of(axes)

        found, words = marks(np.array([0.0] * 115 + [1.0] * 5))
        self.assertEqual([(110, 8.0)], found, "the last 50 episodes have an error of 8")
        self.assertEqual({"8 (0 % succeed)"}, words)
        self.assertEqual(([], set()), marks(np.ones(120)), "the policy succeeds")

    def test_numbers_of_fig_12c_are_above_the_shade_and_each_chart_states_the_success(self):
        for run in self.runs["sarsa"]:
            run["curve"]["success"] = np.array([0.0] * 60 + [1.0] * 60)
            run["curve"]["success"] = run["curve"]["success"][:len(run["curve"]["loss"])]
            run["curve"]["loss"] = run["curve"]["loss"][:120]
        for run in self.runs["lstm_dqn"]:
            run["curve"]["success"] = np.zeros(120)
        figure = self.drawn(error_figure.draw_square_error, self.contestants, self.runs)
        axes = figure.axes[0]
        edge = axes.collections[0].get_paths()[0].vertices
        numbers = [text for text in axes.texts if text.get_text() != "50 % succeed"]
        for text in numbers:
            self.assertGreaterEqual(text.xy[1], edge[edge[:, 0] == text.xy[0], 1].max())
        self.assertEqual([85.0], [text.xy[0] for text in axes.texts if text not in numbers])
        self.assertIn("50 % succeed: not reached", self.names_of(figure.axes[1]))
        self.assertFalse(any(dot.get_clip_on() for dot in axes.lines if dot.get_marker() == "o"))

    def test_the_headline_of_fig_12c_has_the_peak_of_an_error_that_ends_lower(self):
        courses = {"A": (10.0, 100.0, 5.0), "B": (10.0, 12.0, 6.0), "C": (10.0, 10.1, 10.1)}
        self.assertEqual("The errors of A and B end lower than they begin; that of A first rises "
                         "to 100", error_figure.describe_courses(courses))
        courses["D"] = (10.0, 40.0, 20.0)
        self.assertEqual("Only the error of D (×2.0) ends higher than it begins; that of A ends "
                         "lower after a peak of 100", error_figure.describe_courses(courses))
        self.assertEqual("Error of the value estimates in training",
                         error_figure.describe_courses({"C": courses["C"]}))

    def test_fig_12c_of_a_benchmark_without_learners_has_an_empty_chart(self):
        for run in self.runs["sarsa"]:
            run["curve"]["loss"][:] = np.nan
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            figure = self.drawn(error_figure.draw_square_error, [by_name("sarsa")], self.runs)
        axes, = figure.axes
        self.assertEqual(("", 0), (axes.get_title("left"), len(axes.lines)))
        self.assertEqual("Error of the value estimates in training", figure._suptitle.get_text())


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "error_figure", ErrorFigureTest, sys.argv)
