# SPDX-License-Identifier: BSD-3-Clause
"""Runs with random numbers, and the drawn contents of figures, for tests of the figures of §4."""
import sys
import unittest
import unittest.mock

import numpy as np

from aquafarm_benchmark import style
from aquafarm_benchmark.protocol import CONTESTANTS

WINDOW = 50
OPTIMUM = {"clairvoyant": 90.0}


def by_name(name):
    return next(one for one in CONTESTANTS if one.name == name)


def make_run(seed, episodes):
    """Returns a run in the format of results.read_run with random returns, steps and losses."""
    rng = np.random.Generator(np.random.PCG64(seed))
    return {"curve": {"return": rng.normal(10.0 * seed, 5.0, episodes),
                      "steps": rng.integers(1, 100, episodes).astype(float),
                      "success": np.ones(episodes),
                      "loss": np.abs(rng.normal(2.0, 1.0, episodes))}}


class FigureCase(unittest.TestCase):
    """Two learners with two runs each, and empty axes."""

    def setUp(self):
        self.contestants = [by_name("sarsa"), by_name("lstm_dqn")]
        # The lengths of a learner's runs may differ by one or two episodes.
        self.runs = {"sarsa": [make_run(1, 120), make_run(2, 121)],
                     "lstm_dqn": [make_run(3, 120), make_run(4, 120)]}
        _, self.axes = style.plt.subplots()
        self.addCleanup(style.plt.close, "all")

    def lines(self, axes=None):
        """Returns {label: (x, y)} of the curves with a label."""
        return {line.get_label(): (np.asarray(line.get_xdata()), np.asarray(line.get_ydata()))
                for line in (axes or self.axes).lines if not line.get_label().startswith("_")}

    def drawn(self, draw, *arguments):
        """Returns the figure that a draw_… function saves."""
        kept = []
        with unittest.mock.patch.object(sys.modules[draw.__module__], "save",
                                        lambda figure, _: kept.append(figure)):
            draw("nowhere", *arguments)
        return kept[0]

    def names_of(self, axes):
        return {text.get_text() for text in axes.texts}
