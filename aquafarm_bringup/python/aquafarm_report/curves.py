# SPDX-License-Identifier: BSD-3-Clause
"""Charts of training curves, drawn by dygraphs. Dragging zooms. The values under the pointer are
shown."""
import json
import math
import pathlib

import numpy as np
from aquafarm_benchmark.measures import WINDOW, known_moving_mean

from aquafarm_report import blocks, references
from aquafarm_report.videos import ReportError

LIBRARY = pathlib.Path("/usr/share/javascript/dygraphs")  # Debian's libjs-dygraphs
POINTS = 1000  # max number of points of a curve
# Colours of Okabe and Ito (2008), Color universal design.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
# Name in metrics.csv, title and factor of each measure.
CURVES = (("return", "Return per episode", 1.0), ("success", "Success rate [%]", 100.0),
          ("loss", "Mean square error [reward²]", 1.0))
PERCENT = (-4.0, 108.0)  # range of an axis of percentages, with space for marks
PART = 4  # the enlarged chart shows the last 1 / PART of the rows


def smooth(values):
    """Returns (episodes, means). means: moving means over WINDOW episodes; they ignore NaN.
    episodes: the last episode of each mean, counted from 1. A training with fewer than WINDOW
    episodes has one mean, over all its episodes."""
    window = min(WINDOW, len(values))
    return np.arange(window, len(values) + 1), known_moving_mean(values, window)


def rows_of(columns, name, factor):
    """Returns rows [episode, mean of run 0, mean of run 1, …] for dygraphs. None replaces
    a mean that a run does not have. Returns an empty list if no run has a mean."""
    curves = [smooth(factor * one[name]) if name in one else (np.array([]), np.array([]))
              for one in columns]
    last = max((int(episodes[-1]) for episodes, _ in curves if len(episodes)), default=0)
    if last == 0 or not any(np.isfinite(means).any() for _, means in curves):
        return []
    first = min(int(episodes[0]) for episodes, _ in curves if len(episodes))
    rows = []
    for episode in np.unique(np.linspace(first, last, POINTS).astype(int)):
        row = [int(episode)]
        for episodes, means in curves:
            at = episode - int(episodes[0]) if len(episodes) else -1
            value = means[at] if 0 <= at < len(means) else math.nan
            row.append(float(f"{value:.6g}") if math.isfinite(value) else None)
        rows.append(row)
    return rows


def gap_note(player):
    """Returns a sentence if the last mean return of the training is outside the 95 % interval of
    greedy play. Returns an empty text if it is not, or if the mean or the interval is unknown."""
    mean, low, high = references.mean_interval(references.column(player, "return"), player.distinct)
    last, _, _ = references.training_end(player)
    if math.isnan(last) or math.isnan(high) or low <= last <= high:
        return ""
    trained, greedy = f"{last:,.1f}".replace("-", "−"), references.text((mean, low, high))
    if last < low:
        return (f"{player.label}: the mean return is {greedy} in greedy play and {trained} at the "
                "end of the training, which contains random moves.")
    failed = sum(not float(row["success"]) for row in player.rows)
    what = (f"{failed} of {len(player.rows)} episodes end with devices at sea" if failed else
            "its return is lower")
    return (f"{player.label}: the mean return is {trained} at the end of the training and {greedy} "
            f"in greedy play, which has no random moves: {what}; train longer.")


def _library(name):
    try:
        return (LIBRARY / name).read_text(encoding="utf-8")
    except OSError:
        raise ReportError(f"{LIBRARY / name}: cannot be read, expected the Debian package "
                          "libjs-dygraphs; run ./aquafarm setup") from None


def bend(rows, lines, marks):
    """Returns the scale parameter `unit` of toScale in curves.js. With a unit, the scale is linear
    above 0 and logarithmic below, because the first episodes and RANDOM have very low returns.
    Returns None, for a linear scale, if no mean is above 0 or no value is below 0."""
    means = [mean for row in rows for mean in row[1:] if mean is not None]
    shown = [*means, *(line["value"] for line in lines),
             *(value for mark in marks for value in mark if value is not None)]
    return max(means) / 3.0 if min(shown) < 0.0 < max(means) else None


def _marks(runs, interval):
    """Returns [mean, low, high] of each run, rounded for dygraphs; None replaces unknown values.
    interval: function that returns them of a Player"""
    return [[round(value, 4) if math.isfinite(value) else None for value in interval(one)]
            if one.rows else [None] * 3 for one in runs]


def show(labels, columns, notes=(), players=()):
    """Returns the section of training curves: a chart for each measure, with a curve for each run.
    Returns an empty text if there are no curves.

    labels, columns: labels and metrics of the runs
    notes: sentences below the introduction
    players: the runs in the same order, with references before, between or after them. Marks show
        the mean returns and success rates of the runs in greedy play with 95 % intervals; lines
        show the mean returns of the references
    """
    lines = [{"label": one.label,
              "value": round(float(np.mean(references.column(one, "return"))), 1),
              "text": references.return_text(one).partition(" ")[0]}
             for one in players if one.rows and not one.is_run]
    runs = [one for one in players if one.is_run]
    marks = {"return": _marks(runs, lambda one: references.mean_interval(
        references.column(one, "return"), one.distinct)),
             "success": _marks(runs, lambda one: [100.0 * value for value in
                                                  references.success_interval(one)])}
    lengths = [len(one["return"]) for one in columns if "return" in one]
    window = min(WINDOW, max(lengths, default=WINDOW))  # of the longest training
    charts, enlarged = [], []
    for name, title, factor in CURVES:
        rows = rows_of(columns, name, factor)
        if not rows:
            continue
        chart = {"id": f"curve_{name}", "title": title, "rows": rows, "marks": marks.get(name, [])}
        if name == "success":
            chart["range"] = PERCENT
        if name == "return":
            chart.update(lines=lines, bend=bend(rows, lines, chart["marks"]))
            if runs:
                chart["title"] += (f" (curves: means of {window} training episodes; right: greedy "
                                   "play with 95 % intervals)")
        charts.append(chart)
        if chart.get("bend"):
            enlarged = [{**chart, "id": "curve_return_end", "rows": rows[-len(rows) // PART:],
                         "bend": None, "title": f"Return per episode, the last {1 / PART:.0%} "
                         "of the training".replace("%", " %")}]
    charts[2:2] = enlarged  # after the first two charts
    if not charts:
        return ""
    settings = {"labels": ["episode", *labels], "charts": charts, "window": window,
                "colours": [COLOURS[i % len(COLOURS)] for i in range(len(labels))]}
    data = json.dumps(settings, allow_nan=False).replace("</", "<\\/")
    script = (pathlib.Path(__file__).resolve().parent / "templates" / "curves.js").read_text(
        encoding="utf-8")
    # The page is a single file, so links to source maps are removed.
    library = _library("dygraph.min.js").replace("//# sourceMappingURL=dygraph.min.js.map", "")
    style = _library("dygraph.min.css").partition("/*#")[0]
    scripts = [library, f'"use strict";const CURVES={data};\n{script}']
    return blocks.section("Training curves", blocks.curves(window, charts, style, scripts,
                                                           [note for note in notes if note]))
