# SPDX-License-Identifier: BSD-3-Clause
"""The measures of the paper's §4.2 (docs/model.md), and intervals of them. Computed with numpy and
scipy, without files or learners. Sections (§), equations and tables are those of the paper."""
import math

import numpy as np

WINDOW = 50  # episodes in a moving mean
BAND = 0.05  # half-width of the band of a converged learner, as a fraction of the plateau's level
PLATEAU_SHARE = 0.25  # the plateau is this last fraction of a training
NOISE = 3.0  # half-width of the second band, in standard errors; see convergence
PLATEAU_SUCCESS = 0.95  # min success rate of a plateau
WEIGHTS = {"return": 0.1, "success": 0.3, "convergence": 0.2, "stability": 0.4}  # Eq. 16
BEST_RANK, FAILED_RANK = 4, 1  # ranks of convergence in Table 1


def moving_mean(values, window=WINDOW):
    """Returns the mean of each `window` successive values, [n - window + 1]. The first one is the
    mean of the values 0 to window - 1."""
    sums = np.cumsum(np.concatenate(([0.0], np.asarray(values, dtype=float))))
    return (sums[window:] - sums[:-window]) / window


def known_moving_mean(values, window=WINDOW):
    """Like moving_mean, but ignores values that are not finite. The mean of a window without finite
    values is NaN."""
    values = np.asarray(values, dtype=float)
    known = np.isfinite(values)
    counts = np.convolve(known.astype(float), np.ones(window), mode="valid")
    sums = np.convolve(np.where(known, values, 0.0), np.ones(window), mode="valid")
    return np.where(counts > 0.0, sums / np.maximum(counts, 1.0), np.nan)


def last_quarter(values):
    """Returns the values of the plateau: the last quarter, and at least one value."""
    values = np.asarray(values, dtype=float)
    return values[-max(1, int(len(values) * PLATEAU_SHARE)):]


def convergence(returns, successes, standard_errors=0.0):
    """Returns the episode, counted from 1, from which the 50-episode mean return stays within 5 %
    of the mean return on the plateau.

    The result is the last of the 50 episodes of the first such mean. Returns None if the run does
    not converge: it has fewer than 100 episodes, its success rate on the plateau is below 0.95, or
    the last 50-episode mean outside the band ends on the plateau or at the episode before it.

    standard_errors: half-width of a second band, in standard errors of the mean of 50 episodes of
    the plateau. The wider band applies. The 5 % band alone is too narrow for noisy returns: if
    their standard deviation is above about a tenth of their mean, the means leave the band by
    chance, even if the policy no longer changes.
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
    """Returns the mean of the middle half of the values. Values at the edges of the half count in
    part.

    scipy's trim_mean differs: it removes only whole values, for example 1 of 5 instead of 1.25.
    """
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
    """Returns (low, high): the interval of a statistic over runs by percentile bootstrap (Efron
    1979). Both are NaN for fewer than two values."""
    if len(values) < 2:
        return (math.nan, math.nan)
    from scipy import stats  # takes a third of a second to load

    found = stats.bootstrap((np.asarray(values, dtype=float),), statistic, vectorized=False,
                            n_resamples=draws, confidence_level=level, method="percentile",
                            random_state=np.random.default_rng(seed)).confidence_interval
    return (float(found.low), float(found.high))


def wilson_interval(hits, count, level=0.95):
    """Returns (low, high): the interval of the proportion hits / count (Wilson 1927)."""
    from scipy import stats

    found = stats.binomtest(int(hits), count).proportion_ci(level, method="wilson")
    return (float(found.low), float(found.high))


def return_per_step(returns, steps, window=WINDOW):
    """Returns the mean return per step in each window of episodes, [n - window + 1]."""
    return moving_mean(returns, window) / moving_mean(steps, window)


def median_convergence(episodes):
    """Returns the median of the results of convergence for several runs. A run that does not
    converge (None) counts as infinity. Returns None if the median is infinite."""
    middle = float(np.median([math.inf if one is None else one for one in episodes]))
    return middle if math.isfinite(middle) else None


def convergence_ranks(episodes):
    """Returns the rank of each learner by its median convergence, as in Table 1: 4 for the
    earliest, 3 for the next, 2 for all later ones, 1 for learners that do not converge.

    episodes: {name: median episode or None}. Learners with equal episodes get the same rank.
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
    """Returns Eq. 16 as printed: a weighted sum of return per step, success, rank and stability."""
    return (WEIGHTS["return"] * return_per_step + WEIGHTS["success"] * success +
            WEIGHTS["convergence"] * rank + WEIGHTS["stability"] * stability)


def ea_normalised(share_of_optimum, success, converged_at, stability, episodes):
    """Returns Eq. 16 with every term normalised to [0, 1], so that no unit dominates.

    share_of_optimum: the return divided by the clairvoyant optimum; this function limits it to
    [0, 1]. Convergence is the fraction of the training after the episode `converged_at`; 0 if the
    learner does not converge.
    """
    left = 0.0 if converged_at is None else 1.0 - converged_at / episodes
    return (WEIGHTS["return"] * min(1.0, max(0.0, share_of_optimum)) +
            WEIGHTS["success"] * success + WEIGHTS["convergence"] * left +
            WEIGHTS["stability"] * stability)
