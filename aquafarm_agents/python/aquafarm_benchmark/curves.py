# SPDX-License-Identifier: BSD-3-Clause
"""The curves of runs in the form in which figures show them."""
import math
import typing

import numpy as np

from aquafarm_benchmark import measures


class End(typing.NamedTuple):
    """The end of a line in a chart. low and high: lowest and highest value of the runs there; NaN
    if the line shows one value only."""
    x: float
    y: float
    colour: str
    name: str
    low: float = math.nan
    high: float = math.nan


def columns_of_runs(of_one, column):
    """Returns a column of all runs, [runs, episodes]. Longer runs are cut to the length of the
    shortest run, because lengths may differ slightly."""
    length = min(len(run["curve"][column]) for run in of_one)
    return np.array([run["curve"][column][:length] for run in of_one])


def moving_means(values):
    """Returns (episodes, means). means: moving means over 50 episodes, or one mean over all
    episodes if there are fewer; episodes: the last episode of each mean, counted from 1."""
    window = min(measures.WINDOW, len(values))
    return np.arange(window, len(values) + 1), measures.moving_mean(values, window)


def most_common_count(contestants, runs):
    """Returns the most common number of runs of a contestant."""
    counts = [len(runs[one.name]) for one in contestants]
    return max(set(counts), key=counts.count)


def describe_shading(contestants, runs):
    """Returns a note that explains the lines and shades of charts over all runs."""
    count = most_common_count(contestants, runs)
    return ("One run of each learner." if count == 1 else
            f"Median of {count} runs, shaded from the lowest to the highest run.")


def describe_random(contestants):
    """Returns a sentence on the actions of RANDOM, or "" if it does not take part."""
    return ("RANDOM draws only legal actions, without moves onto a rock, an island or off the map."
            if any("actions=reachable" in one.options for one in contestants) else "")
