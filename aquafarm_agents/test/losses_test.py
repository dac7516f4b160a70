#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the statistics and figures of losses with their definitions."""
import csv
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import rosunit

from aquafarm_benchmark import loss_figures, losses, results
from aquafarm_benchmark.protocol import CONTESTANTS, REFERENCES


def columns_of(lost, starts=None):
    """Returns columns in which the only kind loses these amounts [currency] of 10,000."""
    lost = np.round(100.0 * np.asarray(lost)).astype(np.int64)
    insured = np.full(len(lost), 1_000_000)
    columns = {"insured": insured, "saved": insured - lost, "damaged": 0 * lost, "lost": lost,
               "operating_cost": np.full(len(lost), 12_345)}
    columns.update({f"monitoring_{part}": columns[part]
                    for part in ("insured", "saved", "damaged", "lost")})
    columns["start"] = np.arange(len(lost)) if starts is None else np.asarray(starts)
    return columns


class LossesTest(unittest.TestCase):

    def setUp(self):
        self.rng = np.random.Generator(np.random.PCG64(3))
        _, self.axes = loss_figures.plt.subplots()
        self.addCleanup(loss_figures.plt.close, "all")

    def test_the_tail_follows_its_definition(self):
        for _ in range(100):
            sample = self.rng.integers(0, self.rng.integers(2, 500),
                                          self.rng.integers(1, 90)).astype(float)
            var, cvar = losses.tail(sample)
            self.assertEqual(min(x for x in sample if (sample > x).mean() <= 0.05 + 1e-12), var)
            least = min(c + np.maximum(sample - c, 0.0).mean() / 0.05 for c in sample)
            self.assertAlmostEqual(least, cvar, places=9)

    def test_weights_count_as_repetitions(self):
        sample = self.rng.normal(100.0, 20.0, 60)
        weights = self.rng.integers(0, 4, 60)
        expected = losses.tail(np.repeat(sample, weights))
        np.testing.assert_allclose(expected, losses.tail(sample, weights))

    def test_without_repetitions_the_standard_error_is_the_ordinary_one(self):
        sample = self.rng.normal(100.0, 20.0, 60)
        ordinary = sample.std(ddof=1) / math.sqrt(60)
        self.assertAlmostEqual(ordinary, losses.standard_error(sample, np.arange(60)))
        often = losses.standard_error(np.tile(sample, 9), np.tile(np.arange(60), 9))
        self.assertAlmostEqual(ordinary, often)
        self.assertTrue(math.isnan(losses.standard_error(sample, np.zeros(60))))

    def test_cents_are_read_exactly(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "evaluation.csv")
            path.write_text("farm,start,insured,saved,damaged,lost,operating_cost\n"
                            "0,0,90071992547409.93,90071992547409.92,0.01,0.00,5.07\n")
            columns = losses.read(path)
            self.assertEqual(9007199254740993, columns["insured"][0])
            self.assertEqual(columns["insured"][0],
                             columns["saved"][0] + columns["damaged"][0] + columns["lost"][0])
            path.write_text("farm,seed\n0,1\n")
            self.assertIsNone(losses.read(path))

    def rows(self):
        """Returns the references as contestants, their losses, and rows with them."""
        samples = [np.round(self.rng.exponential(500.0, 80), 2) for _ in REFERENCES]
        samples[1][:7] = 0.0
        rows = [{"name": one.name, "label": one.label,
                 "money": losses.summarise(columns_of(sample), "CNY")}
                for one, sample in zip(REFERENCES, samples)]
        return samples, rows

    def test_curves_show_the_probability_of_a_larger_loss(self):
        samples, rows = self.rows()
        loss_figures.plot_exceedance(self.axes, REFERENCES, rows)
        lines = {line.get_label(): line for line in self.axes.lines}
        for one, sample in zip(REFERENCES, samples):
            x, y = (np.asarray(values) for values in lines[one.label].get_data())
            self.assertEqual("steps-post", lines[one.label].get_drawstyle())
            self.assertEqual(0.0, x[0])
            for loss, probability in zip(x[1:], y[1:]):
                self.assertAlmostEqual((sample > loss).mean(), probability)
            self.assertAlmostEqual((sample > 0.0).mean(), y[0])
            self.assertEqual(sample.max(), x[-1])

    def test_bars_show_the_loss_by_kind(self):
        samples, rows = self.rows()
        loss_figures.plot_loss_by_kind(self.axes, REFERENCES, rows)
        heights = [bar.get_height() for bar in self.axes.patches]
        expected = [value for sample in samples for value in (0.0, sample.mean())]
        np.testing.assert_allclose(expected, heights)
        self.assertGreater(self.axes.get_ylim()[1], max(heights))
        self.assertEqual(["monitoring"],
                         [label.get_text() for label in self.axes.get_xticklabels()])

    def test_files_hold_the_losses_and_the_curves(self):
        samples, rows = self.rows()
        with tempfile.TemporaryDirectory() as folder:
            results.write_losses(pathlib.Path(folder), rows)
            with open(pathlib.Path(folder, "losses.csv"), newline="") as file:
                written = list(csv.DictReader(file))
            with open(pathlib.Path(folder, "exceedance.csv"), newline="") as file:
                points = list(csv.DictReader(file))
        self.assertEqual(["all", "monitoring"] * 2, [row["kind"] for row in written])
        self.assertAlmostEqual(samples[0].mean(), float(written[0]["loss"]))
        self.assertAlmostEqual(samples[0].mean(), float(written[1]["loss"]))
        self.assertEqual("", written[1]["cvar"], "the tail is that of all kinds")
        self.assertEqual(sum(len(np.unique(sample)) for sample in samples), len(points))
        self.assertIn("| do nothing | 10,000 |", results.money_table(rows))
        self.assertIn("80 of 80", results.money_table(rows))
        self.assertEqual("", results.money_table([dict(rows[0], money=None)]))

    def test_references_take_part_only_with_money(self):
        self.assertEqual(set(REFERENCES), {one for one in CONTESTANTS if one in REFERENCES})
        self.assertTrue(all(one.named_only and not one.learns for one in REFERENCES))


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_agents", "losses", LossesTest, sys.argv)
