# SPDX-License-Identifier: BSD-3-Clause
"""Losses of evaluated episodes, computed from the money columns of evaluation.csv.

The definitions are those of aquafarm/agents/evaluation/losses.h: loss = damaged + lost; VaR is the
smallest x with P(loss > x) <= 5 %; CVaR is the mean loss of the worst 5 % (Rockafellar and Uryasev
2002). Episodes of several runs are pooled. The bootstrap draws all episodes with an equal start
together (a cluster bootstrap, Davison and Hinkley 1997), and the standard error treats them as one
cluster.
"""
import csv
import decimal

import numpy as np

TAIL = 0.05
_PARTS = ("insured", "saved", "damaged", "lost")
_RESAMPLES = 2000


def _cents(text):
    return int(decimal.Decimal(text).scaleb(2))


def read(evaluation_csv):
    """Returns the money columns as arrays of whole cents, and the column "start": episodes with
    equal starts have the same number in it. Returns None if there are no money columns."""
    with open(evaluation_csv, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows or "insured" not in rows[0]:
        return None
    names = list(rows[0])
    names = names[names.index("insured"):]
    columns = {name: np.array([_cents(row[name]) for row in rows], dtype=np.int64)
               for name in names}
    columns["start"] = np.array([int(row["start"]) for row in rows])
    return columns


def pool(runs):
    """Concatenates the columns of several runs."""
    return {name: np.concatenate([run[name] for run in runs]) for name in runs[0]}


def losses_of(columns):
    """Returns the loss of each episode in the scenario's currency."""
    return (columns["damaged"] + columns["lost"]) / 100.0


def exceedance(losses):
    """Returns the different losses x in ascending order, and P(loss > x) for each of them."""
    values, counts = np.unique(losses, return_counts=True)
    return values, 1.0 - np.cumsum(counts) / len(losses)


def tail(losses, weights=None):
    """Returns VaR and CVaR at 5 %. Each loss counts as often as its weight states (default:
    once)."""
    order = np.argsort(-losses, kind="stable")
    losses = losses[order]
    weights = np.ones(len(losses), dtype=np.int64) if weights is None else weights[order]
    total = weights.sum()
    ends = np.cumsum(weights)
    place = int(np.argmax(ends * round(1.0 / TAIL) > total))
    var = losses[place]
    worse = weights[:place] * (losses[:place] - var)
    return float(var), float(var + worse.sum() / (TAIL * total))


def standard_error(losses, starts):
    """Returns the cluster-robust standard error of the mean; NaN for a single start."""
    _, index = np.unique(starts, return_inverse=True)
    groups = index.max() + 1
    if groups < 2:
        return float("nan")
    sums = np.bincount(index, weights=losses - losses.mean())
    return float(np.sqrt((sums ** 2).sum() * groups / (groups - 1.0)) / len(losses))


def _intervals(losses, starts):
    """Returns the 95 % intervals of VaR and CVaR; NaN for a single start."""
    _, index = np.unique(starts, return_inverse=True)
    groups = index.max() + 1
    if groups < 2:
        return [[float("nan")] * 2] * 2
    rng = np.random.Generator(np.random.PCG64(1))
    order = np.argsort(-losses, kind="stable")
    losses, index = losses[order], index[order]
    tails = [tail(losses, np.bincount(rng.integers(groups, size=groups),
                                      minlength=groups)[index]) for _ in range(_RESAMPLES)]
    return np.percentile(tails, [2.5, 97.5], axis=0).T.tolist()


def summarise(columns, currency):
    """Returns the statistics of pooled columns. Amounts are in the currency; insured, saved,
    damaged, lost, loss and operating_cost are means per episode."""
    losses = losses_of(columns)
    var, cvar = tail(losses)
    var_interval, cvar_interval = _intervals(losses, columns["start"])
    row = {"currency": currency, "episodes": len(losses),
           "distinct_episodes": len(np.unique(columns["start"])),
           "loss": float(losses.mean()), "standard_error": standard_error(losses,
                                                                          columns["start"]),
           "operating_cost": float(columns["operating_cost"].mean() / 100.0),
           "var": var, "var_interval": var_interval, "cvar": cvar,
           "cvar_interval": cvar_interval, "by_kind": {}}
    for part in _PARTS:
        row[part] = float(columns[part].mean() / 100.0)
    for name in columns:
        kind = name[:-len("_insured")]
        if name.endswith("_insured") and columns[name].any():
            row["by_kind"][kind] = {part: float(columns[f"{kind}_{part}"].mean() / 100.0)
                                    for part in _PARTS}
    x, probability = exceedance(losses)
    row["exceedance"] = [x.tolist(), probability.tolist()]
    return row
