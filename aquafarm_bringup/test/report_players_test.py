#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sentences, tiles and charts of a report, computed from the episodes of runs and references."""
import json
import re
import sys
import unittest

import numpy as np
import rostest

from aquafarm_report import blocks, curves, intervals, references


class ReportPlayersTest(unittest.TestCase):

    def test_the_interval_of_the_return_is_of_distinct_starts(self):
        player = references.Player("dqn", [{"return": one} for one in (90, 110) * 2], distinct=4)
        self.assertEqual("100 [89, 111]", references.return_text(player))
        player.distinct = 2  # the other two are repetitions
        self.assertEqual("100 [84, 116]", references.return_text(player))
        player.distinct = 1
        self.assertEqual("100.0", references.return_text(player))
        self.assertEqual("−3,723 [−3,795, −3,651]", references.text((-3722.9, -3795.2, -3650.7)))
        self.assertEqual("1,276.0 [1,274.5, 1,277.6]", references.text((1276.0, 1274.5, 1277.6)))
        self.assertEqual("0 [−11, 10]", references.text((-0.3, -11.0, 10.0)))

    def test_a_rate_below_one_is_never_100_percent(self):
        self.assertEqual(["100 %", "99.7 %", "99.99 %", "98 %", "0.4 %", "0 %"],
                         [blocks.percent(one) for one in (1.0, .997, .9999, .98, .004, 0.0)])
        self.assertEqual("100 % [99.6 %, 100 %]", intervals.share_text(1.0, 1000))

    def test_the_number_of_episodes_is_stated_once_if_it_is_the_same(self):
        def shown(*counts):
            row = {"episode": "0", "return": "1", "success": "1"}
            return references.show_tiles([references.Player("a", [row] * episodes, distinct)
                                          for episodes, distinct in counts])

        self.assertIn("1000: 4 for each, all with a start of their own.", shown((4, 4), (4, 4)))
        self.assertIn("1000: 4 for each, 2 with a start of their own.", shown((4, 2), (4, 2)))
        self.assertNotIn("distinct", shown((4, 4), (4, 4)))
        self.assertIn("3 episodes, 2 distinct", shown((4, 4), (3, 2)))

    def test_a_run_that_plays_worse_or_better_than_it_trained_has_a_sentence(self):
        def note(*returns):
            rows = [{"return": value, "success": "0" if value < 0.0 else "1"} for value in returns]
            return curves.gap_note(references.Player("a", rows, len(rows),
                                                     training=np.full(120, 150.0)))

        self.assertEqual(
            "a: the mean return is 150.0 at the end of the training and −160 [−454, 134] in "
            "greedy play, which has no random moves: 2 of 4 episodes end with devices at sea; "
            "train longer.",
            note(-420.0, 100.0, -420.0, 100.0))
        self.assertIn("which has no random moves: its return is lower", note(99.0, 101.0))
        self.assertEqual("a: the mean return is 240.0 [238.0, 242.0] in greedy play and 150.0 at the "
                         "end of the training, which contains random moves.", note(239.0, 241.0))
        for returns in ((140.0, 160.0), (-160.0,)):  # equal, no interval
            self.assertEqual("", note(*returns))

    def test_the_chart_of_returns_has_the_references_and_greedy_play(self):
        columns = {"return": np.linspace(-300.0, 150.0, 120), "success": np.full(120, 0.5)}
        players = [references.Player(label, [{"return": one, "success": i} for i, one in
                                             enumerate(returns)], 2, is_run=own)
                   for label, returns, own in (("RANDOM", (-1500, -1501), False), ("planner", (), False),
                                               ("a", (90, 110), True), ("best", (278.16,), False))]

        def charts(columns):
            text = curves.show(["a"], [columns], players=players)
            return json.loads(re.search(r"const CURVES=(.*?);\n", text).group(1))["charts"]

        found, success, end = charts(columns)
        self.assertEqual("Success rate [%]", success["title"])
        self.assertEqual([[50.0, 9.4531, 90.5469]], success["marks"], "Wilson's interval")
        self.assertEqual({50.0}, {mean for _, mean in success["rows"]})
        self.assertLess(success["range"][0], 0.0)
        self.assertGreater(success["range"][1], 100.0)
        self.assertIn("the last 25 % of the training", end["title"])
        self.assertEqual(found["rows"][-len(found["rows"]) // 4:], end["rows"])
        self.assertEqual((None, found["lines"]), (end["bend"], end["lines"]))
        self.assertEqual([("RANDOM", -1500.5, "−1,500.5"), ("best", 278.2, "278.2")],
                         [tuple(line.values()) for line in found["lines"]])
        self.assertEqual([[100.0, 80.4, 119.6]], found["marks"])
        self.assertAlmostEqual(np.mean(columns["return"][-50:]) / 3.0, found["bend"], delta=0.01)
        self.assertEqual("Return per episode (curves: means of 50 training episodes; right: greedy "
                         "play with 95 % intervals)", found["title"])
        self.assertIn("means of 30 training", charts({"return": columns["return"][:30]})[0]["title"])
        self.assertIsNone(charts({"return": columns["return"] - 1000.0})[0]["bend"], "below 0")

    def test_one_sentence_says_how_good_a_run_is(self):
        def player(label, *returns, is_run=False, training=()):
            rows = [{"episode": str(i), "return": str(one)} for i, one in enumerate(returns)]
            return references.Player(label, rows, len(rows), is_run=is_run, training=training)

        others = [player("planner", 98, 98, 98, 98), player("clairvoyant", 100, 100, 100, 100)]
        two = [player("a", 88, 92, 88, 92, is_run=True), player("b", 80, 80, 80, 80, is_run=True)]

        def verdict(players):
            return references.verdict(players).replace("\N{NO-BREAK SPACE}", " ")

        share = "reaches 90.0 % of the clairvoyant's return"
        self.assertEqual(f"a {share}, 8.0 points [5.7, 10.3] below the planner.",
                         verdict([two[0], *others]))
        self.assertIn(f"a has the highest return of the 2 runs: it {share}, 10 points [8, 12] above "
                      "b, 8.0 points [5.7, 10.3] below the planner. One training each does not rank ",
                      verdict([*two, *others]))
        self.assertEqual("a: its returns sum up to less than 0, 103 points below the planner.",
                         verdict([player("a", -5, is_run=True), *others]))
        self.assertEqual("a: 8.0 points [5.7, 10.3] below the planner.", verdict([two[0], others[0]]))
        two[1] = player("b", 92, 84, 92, 84, is_run=True)
        self.assertIn("not distinct from b", references.verdict(two))
        self.assertEqual("", references.verdict(others))

        def after(*last):
            training = np.array([500.0, *(-900.0,) * 10, *last])  # the mean of the last 50 counts
            return verdict([player("a", 88, 92, 88, 92, is_run=True, training=training), *others])

        said = "the planner. a is worse in greedy play (90.0) than at the end of its training (95.0)."
        self.assertIn(said, after(*[94.0, 96.0] * 25))
        for last in ([92.0, 91.0] * 25, [80.0, 110.0] * 25):  # overlaps, although the mean is above
            self.assertNotIn("greedy", after(*last))
        self.assertIn("greedy play (90.0) than at the end of its training (95.0). One training",
                      verdict([player("a", 88, 92, 88, 92, is_run=True,
                                      training=np.full(50, 95.0)), two[0], *others]))


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "report_players", ReportPlayersTest, sys.argv)
