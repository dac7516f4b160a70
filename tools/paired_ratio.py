# SPDX-License-Identifier: BSD-3-Clause
"""Means, and ratios of two quantities that are measured alternately, with 95 % intervals."""
import math
import statistics

from scipy import stats


def mean(values):
    """Returns (mean, low, high) with the 95 % interval of Student's t distribution; NaN bounds for a
    single value."""
    middle, count = statistics.fmean(values), len(values)
    if count < 2:
        return middle, math.nan, math.nan
    half = stats.t.ppf(0.975, count - 1) * statistics.stdev(values) / math.sqrt(count)
    return middle, middle - half, middle + half


def paired_ratio(numerators, denominators):
    """Returns (geometric mean, low, high) of the ratios of pairs, with the interval of the
    logarithms."""
    logs = [math.log(a / b) for a, b in zip(numerators, denominators, strict=True)]
    return tuple(map(math.exp, mean(logs)))


def describe(result):
    """Returns '1.860 (1.800 to 1.920)' for (value, low, high)."""
    return "{:.3f} ({:.3f} to {:.3f})".format(*result)
