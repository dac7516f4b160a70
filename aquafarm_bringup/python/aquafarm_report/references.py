# SPDX-License-Identifier: BSD-3-Clause
"""Compares runs with the references RANDOM, planner and clairvoyant on the same episodes."""
import csv
import dataclasses
import json
import math

import numpy as np
from aquafarm_benchmark.measures import WINDOW

from aquafarm_report import blocks, intervals, videos

REFERENCES = (("random", "RANDOM (all actions)"), ("planner", "planner"), ("clairvoyant", "clairvoyant"))
EPISODES = 100  # a reference plays at most this many episodes, the first of the runs' evaluation
LIMIT_S = 120  # max duration of the evaluation of each reference [s]
OPTIMUM = "clairvoyant"


@dataclasses.dataclass
class Player:
    """The evaluation of a run or a reference."""
    label: str
    rows: list = dataclasses.field(default_factory=list)  # rows of evaluation.csv, by episode
    distinct: int = 0  # number of distinct starts of the episodes
    fault: str = ""  # reason why there are no rows
    is_run: bool = False
    training: np.ndarray = ()  # returns of the training episodes of a run


def read_player(label, prefix, is_run=False, training=()):
    """Reads a Player from the files <prefix>.csv and <prefix>.json of aquafarm_evaluate."""
    with open(prefix.with_suffix(".csv"), newline="") as file:
        rows = sorted(csv.DictReader(file), key=lambda row: int(row["episode"]))
    summary = json.loads(prefix.with_suffix(".json").read_text(encoding="utf-8"))
    return Player(label, rows, summary.get("distinct_episodes") or 0, is_run=is_run,
                  training=training)


def play_references(scenario, folder, episodes):
    """Plays the first evaluation episodes with each reference; returns a Player for each. If an
    evaluation fails, `fault` of its Player is the error message."""
    players = []
    for name, label in REFERENCES:
        prefix = folder / f"reference_{name}"
        try:
            videos.call("aquafarm_agents", "aquafarm_evaluate", name, scenario, "--episodes",
                        min(episodes, EPISODES), "--seed", videos.SEED, "--write", prefix,
                        limit_s=LIMIT_S)
            players.append(read_player(label, prefix))
        except videos.ReportError as error:
            players.append(Player(label, fault=str(error)))
    return players


def mean_interval(values, distinct):
    """Returns (mean, low, high): the mean and its 95 % interval of 1.96 standard errors. The bounds
    are NaN if there are fewer than two distinct starts.

    distinct: number of distinct starts, which is the sample size of the standard error
    """
    values = np.asarray(values, dtype=float)
    if distinct < 2:
        return float(values.mean()), math.nan, math.nan
    margin = 1.96 * values.std(ddof=1) / math.sqrt(distinct)
    return float(values.mean()), float(values.mean() - margin), float(values.mean() + margin)


def text(interval, form=None):
    """Returns an interval as "160.2 [157.0, 163.4]"; without bounds only the mean.

    form: format of each number; None: one decimal, or none if the interval is wider than 10
    """
    mean, low, high = interval
    if form is None:
        decimals = 0 if high - low > 10.0 else 1
        form, mean = f"{{:,.{decimals}f}}", round(mean, decimals) + 0.0  # + 0.0: no "-0"
        low, high = round(low, decimals) + 0.0, round(high, decimals) + 0.0
    found = form.format(mean)
    if not math.isnan(low):
        found += f" [{form.format(low)}, {form.format(high)}]"
    return found.replace("-", "−")


def column(player, name):
    return [float(row[name]) for row in player.rows]


def return_text(player):
    return text(mean_interval(column(player, "return"), player.distinct))


def training_end(player):
    """Returns (mean, low, high): the mean return of the last WINDOW episodes of the training and
    its 95 % interval. NaN if there are none."""
    last = [value for value in player.training[-WINDOW:] if not math.isnan(value)]
    return mean_interval(last, len(last)) if last else (math.nan,) * 3


def _worse_greedy(player):
    """Returns a sentence if the mean return in greedy play is below that of the last training
    episodes and their 95 % intervals do not overlap; empty if not. Training contains random moves,
    so greedy play is usually better: the opposite is a surprise once it is not due to chance."""
    trained, greedy = training_end(player), mean_interval(column(player, "return"), player.distinct)
    if not greedy[2] < trained[1]:
        return ""
    before, now = text((trained[0], math.nan, math.nan)), text(greedy).partition(" ")[0]
    return (f"{player.label} is worse in greedy play ({now}) than at the end of its training "
            f"({before}).")


def _success(player):
    """Returns the success rate, and the sample size of its interval: the number of distinct
    starts."""
    return (float(np.mean(column(player, "success"))),
            max(1, min(player.distinct or 1, len(player.rows))))


def success_interval(player):
    """Returns (rate, low, high): the success rate with Wilson's 95 % interval."""
    rate, count = _success(player)
    return rate, *intervals.wilson_interval(round(rate * count), count)


def success_text(player):
    """Returns the success rate with Wilson's 95 % interval as text."""
    return intervals.share_text(*_success(player))


_NO_SHARE = "return below 0: no share"


def share_text(player, optimum):
    """Returns the ratio of the player's return to the clairvoyant's return on the same episodes, as
    text; "–" if a return is unknown or the clairvoyant's is not above 0; _NO_SHARE if the player's
    is below 0."""
    if optimum is None or not optimum.rows or not player.rows:
        return "–"
    best = {row["episode"]: float(row["return"]) for row in optimum.rows}
    pairs = [(float(row["return"]), best[row["episode"]]) for row in player.rows
             if row["episode"] in best]
    total = sum(one for _, one in pairs)
    if not pairs or total <= 0.0:
        return "–"
    share = sum(one for one, _ in pairs) / total
    return _NO_SHARE if share < 0.0 else f"{blocks.percent(share, 1)} of clairvoyant"


def difference(one, other):
    """Returns (mean, low, high) of the differences between the returns of two players in their
    common episodes, with a 95 % interval; None if there are no common episodes."""
    returns = {row["episode"]: float(row["return"]) for row in other.rows}
    pairs = [float(row["return"]) - returns[row["episode"]] for row in one.rows
             if row["episode"] in returns]
    return mean_interval(pairs, min(one.distinct, other.distinct, len(pairs))) if pairs else None


def _points(interval):
    """Returns a difference above 0 as "24 points [21, 27]", without a line break in it."""
    form = "{:.1f}" if interval[0] < 10.0 else "{:.0f}"
    mean, _, bounds = text(interval, form).partition(" ")
    return f"{mean} points {bounds}".rstrip().replace(" ", "\N{NO-BREAK SPACE}")


def verdict(players):
    """Returns sentences on the run with the highest return: its share of clairvoyant's return, and
    its differences from the run with the second highest return and from the planner. Then names the
    runs whose greedy play is worse than their training. Empty if nothing is known."""
    runs = sorted((one for one in players if one.is_run and one.rows),
                  key=lambda one: -np.mean(column(one, "return")))
    if not runs:
        return ""
    best = runs[0]
    share = share_text(best, optimum_of(players))
    has_share = share not in ("–", _NO_SHARE)
    facts = [f"reaches {share.partition(' of ')[0]} of the clairvoyant's return" if has_share else
             "its returns sum up to less than 0"] if share != "–" else []
    planner = next((one for one in players if one.label == "planner" and one.rows
                    and not one.is_run), None)
    for other in [*runs[1:2], *([planner] if planner else [])]:
        gap = difference(best, other)
        name = "the planner" if other is planner else other.label
        if gap is None:
            continue
        if gap[1] <= 0.0 <= gap[2]:
            facts.append(f"not distinct from {name}")
            continue
        side = "above" if gap[0] >= 0.0 else "below"
        mean, *bounds = gap if gap[0] >= 0.0 else (-gap[0], -gap[2], -gap[1])
        facts.append(f"{_points((mean, *bounds))} {side} {name}")
    if not facts:
        return ""
    worse = [said for said in map(_worse_greedy, runs) if said]
    if len(runs) == 1:
        return " ".join([f"{best.label}{'' if has_share else ':'} {', '.join(facts)}.", *worse])
    return " ".join([f"{best.label} has the highest return of the {len(runs)} runs: "
                     f"{'it ' if has_share else ''}{', '.join(facts)}.", *worse,
                     "One training each does not rank their algorithms."])


def optimum_of(players):
    return next((one for one in players if one.label == OPTIMUM and one.rows), None)


def rank(player):
    """Returns the sort key of tiles and curves: the highest mean return first, players without one
    last."""
    return -np.mean(column(player, "return")) if player.rows else math.inf


def _same_starts(counts):
    """Returns the end of a sentence: how many episodes all players play, and how many of these
    start differently. Empty if the players differ. counts: {(episodes, distinct starts)}"""
    if len(counts) != 1:
        return ""
    (episodes, distinct), = counts
    same = "all" if distinct == episodes else f"{distinct:,}"
    return f": {episodes:,} for each, {same} with a start of their own"


def show_tiles(players):
    """Returns a sentence (verdict), a note, and a tile for each player, the highest return first:
    return, share of clairvoyant's return, success, and the number of episodes if it differs."""
    optimum = optimum_of(players)
    counts = {(len(one.rows), one.distinct) for one in players if one.rows}
    shown = []
    for one in sorted(players, key=rank):
        if not one.rows:
            shown.append((one.label, "–", [one.fault], False))
            continue
        mean, _, interval = return_text(one).partition(" ")
        lines = [interval and f"95 %: {interval}", f"success {success_text(one)}",
                 share_text(one, optimum),
                 "" if len(counts) == 1 else f"{len(one.rows)} episodes, {one.distinct} distinct"]
        shown.append((one.label, mean, [line for line in lines if line], one.is_run))
    note = ("<p>Return per episode, success and their 95 % intervals in evaluation episodes of "
            f"seed {videos.SEED}{_same_starts(counts)}. The planner uses the issued forecast, or the "
            "present headings if there is none. The clairvoyant uses the storm's whole track; for "
            "one ship its return is the optimum.</p>")
    said = verdict(players)
    return (f"<p><b>{blocks.escape(said)}</b></p>" if said else "") + blocks.players(shown) + note
