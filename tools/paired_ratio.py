# SPDX-License-Identifier: BSD-3-Clause
"""Computes means, and ratios of two alternately measured quantities, with 95 % intervals."""
import math
import statistics

from scipy import stats


def mean(values):
    """Returns (mean, low, high). low and high bound the 95 % interval by Student's t distribution;
    both are NaN for a single value."""
    middle, count = statistics.fmean(values), len(values)
    if count < 2:
        return middle, math.nan, math.nan
    half = stats.t.ppf(0.975, count - 1) * statistics.stdev(values) / math.sqrt(count)
    return middle, middle - half, middle + half


def paired_ratio(numerators, denominators):
    """Returns (geometric mean, low, high) of the ratios of pairs. low and high bound the 95 %
    interval, which is computed from the logarithms of the ratios."""
    logs = [math.log(a / b) for a, b in zip(numerators, denominators, strict=True)]
    return tuple(map(math.exp, mean(logs)))


def describe(result):
    """Returns (value, low, high) as text, such as '1.860 (1.800 to 1.920)'."""
    return "{:.3f} ({:.3f} to {:.3f})".format(*result)
