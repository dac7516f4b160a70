#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the measures of §4.2 with numbers computed by hand."""
import math
import pathlib
import sys
import unittest
import unittest.mock

import numpy as np
import rosunit

from aquafarm_benchmark import cli, measures, results
from aquafarm_benchmark.protocol import CONTESTANTS, PAPER_TABLE, PROFILES

PAPER = pathlib.Path(__file__).resolve().parents[3] / "shared/paper/paper.txt"


class MeasuresTest(unittest.TestCase):

    def test_a_moving_mean_is_the_mean_of_each_window(self):
        values = np.random.Generator(np.random.PCG64(1)).normal(size=30)
        slow = [values[i:i + 7].mean() for i in range(24)]
        np.testing.assert_allclose(measures.moving_mean(values, 7), slow)

    def test_convergence_is_where_the_mean_comes_to_stay(self):
        success = np.ones(400)
        self.assertEqual(50, measures.convergence(np.full(400, 80.0), success))
        # From episode 101 on all returns are 100. A mean is within 5 % if 48 of 50 returns are 100.
        late = np.concatenate((np.zeros(100), np.full(300, 100.0)))
        self.assertEqual(148, measures.convergence(late, success))
        # Negative plateaus have a band, too.
        self.assertEqual(50, measures.convergence(np.full(400, -80.0), success))

    def test_what_fails_or_does_not_stay_has_not_converged(self):
        level = np.full(400, 100.0)
        self.assertIsNone(measures.convergence(level, np.zeros(400)))
        self.assertIsNone(measures.convergence(level[:99], np.ones(99)))
        relapse = level.copy()
        relapse[330:360] = 0.0
        self.assertIsNone(measures.convergence(relapse, np.ones(400)))
        self.assertIsNone(measures.convergence(np.linspace(0.0, 100.0, 400), np.ones(400)))

    def test_a_settled_mean_may_wander_as_chance_has_it(self):
        rng = np.random.Generator(np.random.PCG64(2))
        success = np.ones(2000)
        noisy = 250.0 + rng.normal(scale=50.0, size=2000)
        noisy[:100] -= 1000.0
        self.assertIsNone(measures.convergence(noisy, success))
        self.assertLess(measures.convergence(noisy, success, measures.NOISE), 160)
        # The band is 5 % if that is wider.
        calm = np.concatenate((np.zeros(100), np.full(300, 100.0)))
        self.assertEqual(148, measures.convergence(calm, np.ones(400), measures.NOISE))

    def test_a_run_that_never_converges_counts_in_the_median(self):
        self.assertEqual(300.0, measures.median_convergence([100, 300, None]))
        self.assertIsNone(measures.median_convergence([100, None, None]))
        self.assertIsNone(measures.median_convergence([None]))

    def test_an_interquartile_mean_leaves_out_a_quarter_at_either_end(self):
        self.assertAlmostEqual(3.5, measures.interquartile_mean([100, 1, 2, 3, 4, 5, 6, -50]))
        self.assertAlmostEqual(2.0, measures.interquartile_mean([1, 2, 3]))
        # Of five values, 1.25 are excluded at either end: (0.75·2 + 3 + 0.75·4) / 2.5.
        self.assertAlmostEqual((0.75 * 2 + 3 + 0.75 * 4) / 2.5,
                               measures.interquartile_mean([4, 90, 3, -9, 2]))
        self.assertEqual(7.0, measures.interquartile_mean([7.0]))

    def test_a_bootstrap_interval_covers_as_often_as_it_says(self):
        rng = np.random.Generator(np.random.PCG64(5))
        hits = 0
        for trial in range(200):
            low, high = measures.bootstrap_interval(rng.normal(size=30), np.mean, draws=300,
                                                    seed=trial)
            hits += low <= 0.0 <= high
        self.assertGreater(hits, 175)  # of 200; 95 % less what a bootstrap of 30 misses
        self.assertEqual(measures.bootstrap_interval([1.0, 2.0, 4.0]),
                         measures.bootstrap_interval([1.0, 2.0, 4.0]))
        self.assertTrue(all(math.isnan(bound) for bound in measures.bootstrap_interval([3.0])))

    def test_ranks_count_down_from_four_and_failures_are_one(self):
        self.assertEqual({"a": 3, "b": 4, "c": 1, "d": 2, "e": 2},
                         measures.convergence_ranks({"a": 90, "b": 80, "c": None, "d": 200,
                                                     "e": 900}))
        self.assertEqual({"a": 4, "b": 4}, measures.convergence_ranks({"a": 70, "b": 70}))

    def test_settings_are_of_so_many_episodes_however_long_a_training_is(self):
        dqn = next(one for one in CONTESTANTS if one.name == "dqn")
        for episodes, explored, last_rate in ((2000, "0.05", "1e-05"),
                                              (800, "0.125", "2.42718e-05"),
                                              (10, "1", "0.000401606")):
            given = dqn.for_episodes(episodes)
            self.assertTrue(given.exploration.endswith(":" + explored), given.exploration)
            self.assertIn(f"learning_rate=harmonic:0.0005:{last_rate}:1", given.options)

    def test_ea_is_equation_16(self):
        self.assertAlmostEqual(0.1 * -3.0 + 0.3 * 0.5 + 0.2 * 2 + 0.4 * 0.25,
                               measures.ea_paper(-3.0, 0.5, 2, 0.25))

    def test_table_1_is_as_printed_and_eq_16_gives_its_ea_of_three_rows(self):
        self.assertEqual({"lstm_dqn": (1.67, 1.0, 4, 1.0), "sarsa": (-1.0, 0.9, 2, 0.9),
                          "q_learning": (-1.21, 0.7, 3, 0.7), "random": (-10.0, 0.0, 1, 0.0)},
                         {name: row.terms() for name, row in PAPER_TABLE.items()})
        self.assertEqual({"lstm_dqn": "1.67", "sarsa": "0.93", "q_learning": "0.97",
                          "random": "−0.7"}, {name: row.ea for name, row in PAPER_TABLE.items()})
        computed = {name: f"{measures.ea_paper(*row.terms()):.2f}"
                    for name, row in PAPER_TABLE.items()}
        self.assertEqual({"lstm_dqn": "1.67", "sarsa": "0.93", "q_learning": "0.97",
                          "random": "-0.80"}, computed, "the paper prints -0.7 for RANDOM")

    def test_table_1_agrees_with_the_papers_text(self):
        if not PAPER.exists():
            self.skipTest(f"{PAPER} is absent")
        printed = [line.split("\t") for line in PAPER.read_text(encoding="utf-8").splitlines()
                   if line.count("\t") == 5]
        names = {"DQN with LSTM": "lstm_dqn", "SARSA": "sarsa", "Q-Learning": "q_learning",
                 "RANDOM": "random"}
        self.assertEqual({names[cells[0]]: tuple(cells[1:]) for cells in printed[1:]},
                         {name: (row.average_return, row.success, row.convergence, row.stability,
                                 row.ea) for name, row in PAPER_TABLE.items()})

    def test_a_proportion_has_its_wilson_interval(self):
        # z²/n is 0.38415: (0.8 + 0.19207 ± 1.96 · √(0.016 + 0.0096)) / 1.38415.
        low, high = measures.wilson_interval(8, 10)
        self.assertAlmostEqual(0.4902, low, places=4)
        self.assertAlmostEqual(0.9433, high, places=4)
        self.assertAlmostEqual(1.0, measures.wilson_interval(10, 10)[1])

    def test_the_paper_profile_compares_printed_tuned_and_ablated_rows(self):
        profile = PROFILES["paper"]
        self.assertEqual((10, 2000, 5000), (profile.runs, profile.episodes, profile.max_steps))
        rows = {one.name: one.for_episodes(profile.episodes) for one in profile.contestants}
        self.assertEqual(len(rows), len(profile.contestants), "each row has a name of its own")
        printed = {name: one for name, one in rows.items() if one.paper_row}
        self.assertEqual({"random", "q_learning_printed", "sarsa_printed", "lstm_dqn_printed"},
                         set(printed))
        for name in (*printed, "dqn_printed"):
            self.assertEqual("paper_plain", rows[name].scenario, name)
            self.assertFalse([option for option in rows[name].options if "mask" in option], name)
        for name in ("dqn_printed", "lstm_dqn_printed"):
            self.assertIn("preset=paper", rows[name].options)
        for name in ("dqn", "lstm_dqn"):
            self.assertEqual("", rows[name].scenario, "the benchmark's own scenario")
            self.assertEqual(rows[name].options, rows[f"{name}_no_routes"].options)
            self.assertEqual("paper_plain", rows[f"{name}_no_routes"].scenario)
            self.assertIn("mask_blocked=false", rows[f"{name}_no_masks"].options)
            self.assertIn("priority_exponent=0", rows[f"{name}_paper_replay"].options)
        for one in rows.values():
            keys = [option.split("=", 1)[0] for option in one.options]
            self.assertEqual(len(keys), len(set(keys)), f"{one.name} gives an option twice")

    def test_each_row_is_trained_by_its_algorithm_on_its_scenario(self):
        options = cli.parse(["--profile", "paper", "--runs", "2", "--programs", "/bin"])
        self.assertEqual(5000, options.max_steps)
        profile = PROFILES["paper"]
        with unittest.mock.patch.object(cli, "find_program", lambda name, folder: name):
            jobs = {job.name: job for job in cli.make_jobs(options, profile.contestants,
                                                           pathlib.Path("/nowhere"))}
        train, evaluate = jobs["lstm_dqn_printed 2"].commands
        self.assertEqual(["aquafarm_train", "paper_plain", "--max-steps", "5000", "--algorithm",
                          "lstm_dqn"], train[:6])
        self.assertEqual(["aquafarm_evaluate", "/nowhere/runs/lstm_dqn_printed/seed_2",
                          "paper_plain"], evaluate[:3])
        self.assertEqual("paper", jobs["lstm_dqn 1"].commands[0][1])
        # RANDOM's evaluations differ by run because each has its own seed.
        seeds = [evaluate[evaluate.index("--policy-seed") + 1]
                 for evaluate in (jobs[f"random {seed}"].commands[1] for seed in (1, 2))]
        self.assertEqual(["1", "2"], seeds)

    def test_all_rows_of_a_profile_but_those_by_name_alone(self):
        self.assertEqual(["random", "q_learning", "sarsa", "dqn", "lstm_dqn", "ppo", "planner"],
                         cli.parse([]).algorithms)
        self.assertEqual(["random_all"], cli.parse(["--algorithms", "random_all"]).algorithms)
        actions = {one.name: one.options for one in CONTESTANTS if "random" in one.name}
        self.assertEqual({"random": ("actions=reachable",), "random_all": ("actions=all",)},
                         actions)
        with self.assertRaisesRegex(cli.BadInput, "scenario: got 'partial' with profile paper, "
                                    "expected paper"):
            cli.parse(["partial", "--profile", "paper"])

    def test_the_normalised_ea_lies_between_nothing_and_one(self):
        self.assertEqual(0.0, measures.ea_normalised(-5.0, 0.0, None, 0.0, 100))
        self.assertAlmostEqual(1.0, measures.ea_normalised(1.0, 1.0, 0, 1.0, 100))
        self.assertAlmostEqual(0.1 * 0.5 + 0.3 * 0.9 + 0.2 * 0.75 + 0.4 * 0.8,
                               measures.ea_normalised(0.5, 0.9, 25, 0.8, 100))

    def test_the_table_shows_the_papers_rows_as_printed(self):
        row = {"name": "mine", "paper_row": "lstm_dqn", "label": "LSTM-DQN", "return_per_step": 4.5,
               "success_rate": 1.0, "convergence": 420.0, "stability": 0.9, "settled": 280.0,
               "stability_settled": 1.0, "ea_paper": 1.95,
               "ea_normalised": 0.97, "return_iqm": 265.0, "return_interval": [260.0, 270.0],
               "share_of_optimum": 0.955, "evaluation_episodes": 1000,
               "distinct_episodes": 998}
        lines = results.table([row]).splitlines()
        self.assertEqual("| LSTM-DQN | 4.50 | 1.000 | 420 | 0.9 | 280 (1.0) | 1.95 | 0.97 | 265.0 "
                         "(260.0 … 270.0) | 0.955 | 998 of 1000 |", lines[2])
        self.assertEqual("| *LSTM-DQN, paper* | 1.67 per step | 1 | ≤300 timesteps (4) | 1 | – | "
                         "1.67 | – | – | – | – |", lines[3])
        old = results.table([dict(row, distinct_episodes=None)]).splitlines()
        self.assertTrue(old[2].endswith("| – of 1000 |"), old[2])
        without = results.table([dict(row, paper_row="")]).splitlines()
        self.assertEqual(lines[:3], without)


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "measures", MeasuresTest, sys.argv)
