#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the headlines of the figures of §4 with the data that they describe."""
import sys
import unittest

import numpy as np
import rosunit

from aquafarm_benchmark import figures, headlines, style
from aquafarm_benchmark.curves import End
from aquafarm_benchmark.protocol import CONTESTANTS, PROFILES

RISING = np.array([-100.0] * 50 + [100.0] * 100)  # the mean of 50 episodes is 90 at episode 98


def by_name(name):
    return next(one for one in CONTESTANTS if one.name == name)


def run_of(returns, steps=10, success=1.0):
    count = len(returns)
    return {"curve": {"return": np.asarray(returns, dtype=float), "steps": np.full(count, steps),
                      "success": np.full(count, success)}}


def words(text):
    return text.replace(headlines.NBSP, " ")


class HeadlinesTest(unittest.TestCase):

    def setUp(self):
        self.contestants = [by_name("sarsa"), by_name("lstm_dqn")]
        self.runs = {name: [run_of(np.zeros(150))] for name in ("sarsa", "lstm_dqn", "random")}
        self.addCleanup(style.plt.close, "all")

    def highest(self, ends):
        return headlines.highest(self.contestants, self.runs, ends, "return")

    def times(self):
        return words(headlines.learning_times(self.contestants, self.runs, {"clairvoyant": 100.0}))

    def test_a_headline_says_once_that_all_settings_are_as_printed(self):
        self.contestants = [one for one in PROFILES["paper"].contestants
                            if one.name in ("dqn_printed", "sarsa_printed")]
        self.runs = {"sarsa_printed": [run_of(RISING)],
                     "dqn_printed": [run_of(RISING, success=0.0)]}
        ends = [End(9, 4.0, "red", "SARSA, printed"), End(9, -2.0, "blue", "DQN, printed")]
        self.assertEqual("As printed, DQN (−2) does not learn the task within 150 episodes. SARSA "
                         "ends with a return of 4.", self.highest(ends))
        goal = "90 % of the return of the clairvoyant"
        self.assertEqual(f"As printed, SARSA and DQN learn fastest: 980 time steps to {goal}.",
                         self.times().replace("DQN and SARSA", "SARSA and DQN"))
        self.contestants = headlines.without_printed(self.contestants)
        self.assertEqual({"SARSA", "DQN"}, {one.label for one in self.contestants})
        self.runs["sarsa_printed"] = self.runs["dqn_printed"] = [run_of(np.zeros(150))]
        self.assertEqual(f"As printed, no learner reaches {goal} within 150 episodes.",
                         self.times())
        self.assertEqual("No learner", headlines.as_printed("No learner", [
            *self.contestants, by_name("sarsa")]), "not all are printed")

    def test_learners_without_successes_or_below_random_do_not_learn(self):
        self.contestants.append(by_name("random"))
        self.runs = {"sarsa": [run_of(RISING, success=0.0), run_of(RISING, success=0.09)],
                     "lstm_dqn": [run_of(RISING, success=0.0), run_of(RISING, success=0.2)],
                     "random": [run_of(np.zeros(150))]}
        self.assertEqual(["SARSA"], headlines.failed_learners(self.contestants, self.runs))
        self.runs["random"] = [run_of(np.full(150, 101.0))]
        ends = [End(9, 100.0, "red", "SARSA"), End(9, 100.0, "blue", "LSTM-DQN")]
        self.assertEqual("LSTM-DQN (100) and SARSA (100) do not learn the task within 150 "
                         "episodes.", self.highest(ends))
        self.assertIn("less than 10 % of its last 50 episodes",
                      headlines.describe_failed(self.highest(ends)))
        self.assertEqual("", headlines.describe_failed("SARSA ends with a return of 4."))

    def test_a_headline_names_all_learners_with_the_highest_printed_value(self):
        ends = [End(9, 4.46, "red", "SARSA"), End(9, 4.54, "blue", "LSTM-DQN")]
        self.assertEqual("LSTM-DQN ends with the highest return: 5.", self.highest(ends))
        near = [ends[0], End(9, 4.48, "blue", "LSTM-DQN")]
        self.assertEqual("LSTM-DQN and SARSA end with the highest return: 4.", self.highest(near))
        self.assertEqual("SARSA ends with a return of 4.", self.highest(ends[:1]))
        self.assertEqual("Return", self.highest([]))

    def test_a_headline_states_whether_the_ranges_of_the_runs_overlap(self):
        first = End(9, 8.0, "blue", "LSTM-DQN", 6.0, 9.0)
        apart, overlap = (" Each of its runs is above all runs of the others.",
                          " The range of its runs overlaps that of SARSA.")
        for other, expected in ((End(9, 4.0, "red", "SARSA", 3.0, 5.0), apart),
                                (End(9, 4.0, "red", "SARSA", 3.0, 7.0), overlap),
                                (End(9, 5.0, "red", "SARSA"), apart),  # one run
                                (End(9, 7.0, "red", "SARSA"), overlap)):
            self.assertEqual("LSTM-DQN ends with the highest return: 8." + expected,
                             self.highest([other, first]))
        named, = headlines.with_values(self.contestants, [first])
        self.assertEqual("LSTM-DQN 8 (6 to 9)", words(named.name))

    def test_the_headline_of_fig_12b_has_the_episode_of_the_first_mean_above_0(self):
        rising = np.array([-10.0] * 40 + [30.0] * 80)  # the sum is 0 after 13.3 good episodes
        self.runs = {"sarsa": [run_of(rising)], "lstm_dqn": [run_of(-np.ones(120))]}
        self.assertEqual("SARSA recovers first: the mean return of all episodes so far rises above "
                         "0 at episode 54. LSTM-DQN does not rise above 0 within 120 episodes.",
                         headlines.recovery_times(self.contestants, self.runs))
        self.assertEqual("SARSA recovers: the mean return of all episodes so far rises above 0 at "
                         "episode 54.", headlines.recovery_times(self.contestants[:1], self.runs))
        self.assertEqual("", headlines.recovery_times(self.contestants[1:], self.runs))
        self.runs["lstm_dqn"] = [run_of([-10.0] * 80 + [30.0] * 40)]
        self.assertTrue(headlines.recovery_times(self.contestants, self.runs).endswith(
            "at episode 54; LSTM-DQN at 107."))
        self.runs["lstm_dqn"] = self.runs["sarsa"]
        self.assertTrue(headlines.recovery_times(self.contestants, self.runs).startswith(
            "LSTM-DQN and SARSA recover: "))
        _, axes = style.plt.subplots()
        figures.plot_average_rewards(axes, self.contestants[:1], self.runs, {"clairvoyant": 90.0})
        self.assertEqual([(54, 0.0)], [tuple(line.get_xydata()[0]) for line in axes.lines
                                       if line.get_marker() == "o"])

    def test_the_headline_of_fig_12a_has_the_steps_until_90_percent_of_the_reference(self):
        learnt, slow, never = run_of(RISING), run_of(RISING, 30), run_of(np.zeros(150))
        self.runs = {"sarsa": [learnt], "lstm_dqn": [never]}
        fastest = "time steps to 90 % of the return of the clairvoyant."
        self.assertEqual(f"SARSA learns fastest: 980 {fastest} LSTM-DQN does not reach it within "
                         "150 episodes.", self.times())
        self.runs["lstm_dqn"] = [slow]
        self.assertEqual(f"SARSA learns fastest: 980 {fastest} LSTM-DQN needs 3 times as many.",
                         self.times())
        for steps, ratio in ((10.2, "1.02"), (14, "1.4"), (2000, "204"), (15000, "1,531")):
            self.runs["lstm_dqn"] = [run_of(RISING, steps)]
            self.assertIn(f"LSTM-DQN needs {ratio} times as many.", self.times())
        self.runs = {"sarsa": [learnt, learnt, slow], "lstm_dqn": [slow, slow, slow]}
        self.assertTrue(self.times().endswith(
            "3 times as many. The range of its runs overlaps that of LSTM-DQN."), self.times())
        self.runs["sarsa"] = self.runs["lstm_dqn"] = [learnt, slow]
        self.assertEqual(f"LSTM-DQN and SARSA learn fastest: 2,000 {fastest}", self.times())
        self.runs["lstm_dqn"] = [learnt, never, never, learnt]
        self.assertEqual(f"SARSA learns fastest: 2,000 {fastest} LSTM-DQN reaches it only in 2 of "
                         "4 runs.", self.times())
        _, axes = style.plt.subplots()
        ends = figures.plot_rewards_by_steps(axes, self.contestants[1:], self.runs,
                                             {"clairvoyant": 100.0})
        self.assertIn("LSTM-DQN: 90 % in 2 of 4 runs", {end.name for end in ends})
        self.runs["lstm_dqn"] = [learnt, never, slow]
        _, axes = style.plt.subplots()
        figures.plot_rewards_by_steps(axes, self.contestants[1:], self.runs, {"clairvoyant": 100.0})
        self.assertEqual(["LSTM-DQN 2.9k (in 2 of 3 runs)"],
                         [text.get_text() for text in axes.texts])
        self.assertEqual("", headlines.learning_times(self.contestants, self.runs, {}))

    def test_the_headline_of_fig_12a_also_describes_one_learner_and_none_that_reaches(self):
        learnt, never = run_of(RISING), run_of(np.zeros(150))
        self.runs = {"sarsa": [never], "lstm_dqn": [never]}
        goal = "90 % of the return of the clairvoyant"
        self.assertEqual(f"No learner reaches {goal} within 150 episodes.", self.times())
        self.runs["lstm_dqn"] = [learnt, never, never]
        self.assertEqual(f"LSTM-DQN reaches {goal} only in 1 of 3 runs. SARSA does not reach it "
                         "within 150 episodes.", self.times())
        self.contestants = self.contestants[:1]
        self.assertEqual(f"SARSA does not reach {goal} within 150 episodes.", self.times())
        self.runs["sarsa"] = [learnt]
        self.assertEqual(f"SARSA needs 980 time steps to {goal}.", self.times())


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "headlines", HeadlinesTest, sys.argv)
