# SPDX-License-Identifier: BSD-3-Clause
"""What §4.2 measures. Plain numpy; knows no files and no learners."""
import math

import numpy as np

WINDOW = 50  # episodes in a moving mean
BAND = 0.05  # share of the plateau within which a converged learner stays
PLATEAU_SHARE = 0.25  # the last part of a training, whose mean is the plateau
NOISE = 3.0  # standard errors that the wider band allows a settled mean
PLATEAU_SUCCESS = 0.95  # a plateau with fewer successes is none
WEIGHTS = {"return": 0.1, "success": 0.3, "convergence": 0.2, "stability": 0.4}  # Eq. 16
BEST_RANK, FAILED_RANK = 4, 1  # of convergence in Table 1


def moving_mean(values, window=WINDOW):
    """Means of `window` values each; [n - window + 1], the first ends at value window - 1."""
    sums = np.cumsum(np.concatenate(([0.0], np.asarray(values, dtype=float))))
    return (sums[window:] - sums[:-window]) / window


def last_quarter(values):
    """The plateau's episodes, one at least."""
    values = np.asarray(values, dtype=float)
    return values[-max(1, int(len(values) * PLATEAU_SHARE)):]


def convergence(returns, successes, standard_errors=0.0):
    """First episode, counted from 1, from which the 50-episode mean return stays within 5 % of its
    final plateau.

    The number is that of the last episode in the first such mean. None when it never comes to
    stay: the plateau is no success, or the mean still leaves the band in the plateau's own
    episodes.

    standard_errors: a band of so many standard errors of a 50-episode mean on the plateau, where
    that is wider. Without it a policy that has long settled but whose episodes differ by more than
    a tenth is said to converge late or never, by chance alone.
    """
    if len(returns) < 2 * WINDOW or last_quarter(successes).mean() < PLATEAU_SUCCESS:
        return None
    plateau = last_quarter(returns)
    level = plateau.mean()
    band = max(BAND * abs(level), standard_errors * plateau.std() / math.sqrt(WINDOW))
    outside = np.flatnonzero(np.abs(moving_mean(returns) - level) > band)
    first = 0 if len(outside) == 0 else int(outside[-1]) + 1
    episode = first + WINDOW
    return episode if episode <= len(returns) * (1.0 - PLATEAU_SHARE) else None


def interquartile_mean(values):
    """Mean of the middle half; a quarter that cuts a value counts it in part."""
    values = np.sort(np.asarray(values, dtype=float))
    cut = len(values) / 4.0
    weights = np.ones(len(values))
    whole = int(cut)
    weights[:whole] = 0.0
    weights[len(values) - whole:] = 0.0
    part = cut - whole
    if part > 0.0:
        weights[whole] -= part
        weights[len(values) - whole - 1] -= part
    return float((values * weights).sum() / weights.sum())


def bootstrap_interval(values, statistic=interquartile_mean, level=0.95, draws=2000, seed=1):
    """Percentile bootstrap (Efron 1979) of a statistic over runs: (low, high)."""
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return (math.nan, math.nan)
    chance = np.random.Generator(np.random.PCG64(seed))
    picks = chance.integers(len(values), size=(draws, len(values)))
    drawn = [statistic(values[pick]) for pick in picks]
    low, high = np.quantile(drawn, [(1.0 - level) / 2.0, (1.0 + level) / 2.0])
    return (float(low), float(high))


def wilson_interval(hits, count, z=1.959964):
    """95 % interval of a proportion (Wilson 1927): (low, high)."""
    share, slack = hits / count, z * z / count
    middle = (share + slack / 2.0) / (1.0 + slack)
    half = z * math.sqrt(share * (1.0 - share) / count + slack / count / 4.0) / (1.0 + slack)
    return (max(0.0, middle - half), min(1.0, middle + half))


def return_per_step(returns, steps, window=WINDOW):
    """Mean return per step of `window` episodes each: [n - window + 1], as moving_mean."""
    return moving_mean(returns, window) / moving_mean(steps, window)


def median_convergence(episodes):
    """Median over runs, in which one that never converges (None) counts as endless; None when
    that is the median."""
    middle = float(np.median([math.inf if one is None else one for one in episodes]))
    return middle if math.isfinite(middle) else None


def convergence_ranks(episodes):
    """Rank of each learner by its median convergence, as Table 1 counts: the first is 4, then 3,
    then 2; whoever does not converge is 1.

    episodes: {name: median episode or None}. Equal episodes share a rank.
    """
    ordered = sorted({episode for episode in episodes.values() if episode is not None})
    ranks = {}
    for name, episode in episodes.items():
        if episode is None:
            ranks[name] = FAILED_RANK
        else:
            ranks[name] = max(FAILED_RANK + 1, BEST_RANK - ordered.index(episode))
    return ranks


def ea_paper(return_per_step, success, rank, stability):
    """Eq. 16 as printed: a weighted sum of return per step, success, rank and stability."""
    return (WEIGHTS["return"] * return_per_step + WEIGHTS["success"] * success +
            WEIGHTS["convergence"] * rank + WEIGHTS["stability"] * stability)


def ea_normalised(share_of_optimum, success, converged_at, stability, episodes):
    """Eq. 16 with every term in [0, 1], so that no unit outweighs the others.

    The return counts as its share of the clairvoyant optimum, convergence as the share of the
    training that was left when it came.
    """
    left = 0.0 if converged_at is None else 1.0 - converged_at / episodes
    return (WEIGHTS["return"] * min(1.0, max(0.0, share_of_optimum)) +
            WEIGHTS["success"] * success + WEIGHTS["convergence"] * left +
            WEIGHTS["stability"] * stability)
