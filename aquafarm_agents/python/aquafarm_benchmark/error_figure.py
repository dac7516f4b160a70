# SPDX-License-Identifier: BSD-3-Clause
"""Draws Fig. 12c, the error of the value estimates, as PNG from the data of results.py."""
import textwrap

import numpy as np
from matplotlib import ticker
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from aquafarm_benchmark import measures
from aquafarm_benchmark.curves import columns_of_runs, describe_shading, moving_means
from aquafarm_benchmark.headlines import as_printed
from aquafarm_benchmark.style import (chart_grid, explain, joined, legible, line_style, save,
                                      shade)

_PEAK = 2.0  # a peak is at least this multiple of the first and of the last value
_SAME = 0.05  # relative change below which an error ends where it begins
_HEADROOM = 1.5  # factor of the upper limit, for the numbers at the highest values
_FOOTROOM = 1.5  # divisor of the lower limit, for the name of the grey mark
_LETTER = 0.045  # width of a letter of a number [widths of a chart]
_EDGE = 0.02  # a mark of success that is nearer to the left edge is not drawn [widths of a chart]
_KEY_LETTERS = 32  # max length of a line of the key
_SUCCESS = 0.5  # the success rate that the charts mark


def draw_square_error(path, contestants, runs):
    """Draws Fig. 12c: the mean square error of the value estimates, a chart for each learner, over
    all runs. Omits contestants without updates, such as RANDOM."""
    learners = [one for one in contestants
                if np.isfinite(columns_of_runs(runs[one.name], "loss")).any()]
    figure, charts = chart_grid(max(1, len(learners)), "error [reward²]")
    courses, found = {}, {}
    for axes, one in zip(charts, learners):
        plot_square_error(axes, [one], runs)
        if not axes.lines:
            continue
        courses[one.label] = _mark_course(axes, one.colour)
        first, _, last = map(_significant, courses[one.label])
        axes.set_title(f"{one.label}: {first} → {last}", fontsize=12, color=legible(one.colour))
        found[axes] = _mark_success(axes, runs[one.name])
        _mark_low(axes, runs[one.name], one.colour)
    low, high = charts[0].get_ylim()
    charts[0].set_ylim(low / _FOOTROOM, _HEADROOM * high)  # the charts share their scale
    for axes, marked in found.items():
        _name_success(axes, *marked)
    headline = describe_courses(courses)
    explain(figure, as_printed(headline, learners), " ".join(filter(None, [
        f"Fig. 12c: mean square error over {measures.WINDOW} episodes, logarithmic.",
        "×: last value relative to the first." if "×" in headline else "",
        _explain_marks(figure.axes[len(charts):], charts), describe_shading(contestants, runs),
        "Each learner has its own targets: errors of different learners cannot be compared, and a "
        "low error does not mean a good policy."])))
    save(figure, path)


def _explain_marks(empty, charts):
    """Writes the key of the marks on the first of the empty axes. Returns the key as a note if
    there are no empty axes."""
    share = f"{100 * _SUCCESS:.0f} %"
    style = {"color": "0.45", "linestyle": "none"}
    lows = any(line.get_label() == "_low" for axes in charts for line in axes.lines)
    spans = any(axes.patches for axes in charts)
    marks = [(Line2D([], [], marker="o", **style), "dot",
              "first, last and, if it is far from both, highest value")]
    marks += [(Line2D([], [], marker="v", markersize=8, markeredgecolor="black", **style),
               "triangle", f"lowest error of a run, if less than {share} succeed then")] * lows
    marks += [(Patch(facecolor="0.88", edgecolor="0.6"), "grey area",
               f"{share} of the last {measures.WINDOW} episodes succeed for the first time, from "
               "the earliest to the latest run")] * spans
    if not empty:
        return " ".join(f"{name.capitalize()}: {words}." for _, name, words in marks)
    empty[0].legend([mark for mark, _, _ in marks],
                    [textwrap.fill(words, _KEY_LETTERS) for _, _, words in marks],
                    loc="upper left", frameon=False, fontsize=10, labelspacing=1.0,
                    borderaxespad=0.0)
    return ""


def describe_courses(courses):
    """Returns the headline of Fig. 12c.

    courses: {name of a learner: (first, highest, last) error}
    """
    changes = {name: last / first for name, (first, _, last) in courses.items()}
    higher = [f"{name} (×{changes[name]:.1f})" for name in sorted(changes, key=changes.get)
              if changes[name] > 1.0 + _SAME][::-1]
    lower = [name for name in changes if changes[name] < 1.0 - _SAME]
    if not higher and not lower:
        return "Error of the value estimates in training"
    said = _ending(higher or lower, "higher" if higher else "lower")
    said = f"Only the {said}" if lower and len(higher) == 1 else f"The {said}"
    course = "ends lower after a peak of" if higher else "first rises to"
    peaks = [f"that of {name} {course} {_significant(peak)}"
             for name, (first, peak, last) in courses.items()
             if name in lower and peak > _PEAK * max(first, last)]
    return f"{said}; {joined(peaks)}" if peaks else said


def _ending(names, where):
    return (f"errors of {joined(names)} end {where} than they begin" if len(names) > 1 else
            f"error of {names[0]} ends {where} than it begins")


def _significant(value):
    return f"{value:,.0f}" if value >= 10.0 else f"{value:.2g}"


def _mark_course(axes, colour):
    """Marks the first, the highest and the last value of the line on the axes. Returns them. The
    numbers are above the line and its shade."""
    x, y = axes.lines[0].get_data()
    top = int(np.argmax(y))
    # A highest value near the first or the last one has no mark of its own.
    near = 0.12 * (x[-1] - x[0])
    marks = {0: "left", **({top: "center"} if near < x[top] - x[0] < x[-1] - x[0] - near else {}),
             len(x) - 1: "right"}
    edge = (axes.collections[0].get_paths()[0].vertices if axes.collections else
            np.column_stack([x, y]))
    for i, across in marks.items():
        text = _significant(y[i])
        width = _LETTER * len(text) * (x[-1] - x[0])
        axes.plot(x[i], y[i], "o", color=colour, markersize=5, zorder=5, label="_value",
                  clip_on=False)
        covered = np.abs(edge[:, 0] - x[i]) <= (0.5 if across == "center" else 1.0) * width
        axes.annotate(text, (x[i], edge[covered, 1].max()), textcoords="offset points",
                      xytext=(3 if across == "left" else 0, 4), ha=across, color=legible(colour),
                      fontsize=11, weight="bold", zorder=6,
                      path_effects=[withStroke(linewidth=3, foreground="white")])
    return y[0], y[top], y[-1]


def _mark_success(axes, of_one):
    """Shades the episodes at which the success rate of the runs first reaches _SUCCESS, from the
    earliest to the latest run that reaches it. Returns (episodes, is_shown). is_shown is False if
    there are no such episodes, or if all are at the left edge."""
    found = []
    for successes in columns_of_runs(of_one, "success"):
        episodes, means = moving_means(successes)
        found += list(episodes[means >= _SUCCESS][:1])
    is_shown = bool(found) and max(found) - episodes[0] > _EDGE * (episodes[-1] - episodes[0])
    if is_shown:
        axes.axvspan(min(found), max(found), facecolor="0.88", edgecolor="0.6", linewidth=1.0,
                     zorder=0)
    return found, is_shown


def _smooth(of_one):
    """Returns (episodes, 50-episode means of the squared TD error [runs, episodes]). Means are NaN
    before the first update."""
    errors = columns_of_runs(of_one, "loss")
    window = min(measures.WINDOW, errors.shape[1])
    return (np.arange(window, errors.shape[1] + 1),
            np.array([measures.known_moving_mean(row, window) for row in errors]))


def _mark_low(axes, of_one, colour):
    """Marks the lowest error of all runs if less than _SUCCESS of the last episodes of the run
    succeed there: then a low error does not mean a good policy."""
    episodes, errors = _smooth(of_one)
    positive = np.where(errors > 0.0, errors, np.inf)
    run, at = np.unravel_index(positive.argmin(), errors.shape)
    succeeded = moving_means(columns_of_runs(of_one, "success")[run])[1][at]
    if succeeded >= _SUCCESS:
        return
    is_left = episodes[at] < sum(axes.get_xlim()) / 2
    axes.plot(episodes[at], errors[run, at], "v", color=colour, markersize=8,
              markeredgecolor="black", zorder=6, label="_low")
    axes.annotate(f"{_significant(errors[run, at])} ({100 * succeeded:.0f} % succeed)",
                  (episodes[at], errors[run, at]), textcoords="offset points", va="center",
                  xytext=(7 if is_left else -7, -1), ha="left" if is_left else "right", fontsize=10,
                  color=legible(colour), zorder=6,
                  path_effects=[withStroke(linewidth=3, foreground="white")])


def _name_success(axes, episodes, is_shown):
    """Writes when _SUCCESS of the episodes succeed at the bottom of a chart: next to the grey area,
    or in words if the chart has none.

    episodes, is_shown: result of _mark_success
    """
    share, y = f"{100 * _SUCCESS:.0f} % succeed", 0.03
    style = {"textcoords": "offset points", "fontsize": 10, "color": "0.35"}
    if is_shown:
        is_left = max(episodes) < sum(axes.get_xlim()) / 2
        axes.annotate(share, (max(episodes) if is_left else min(episodes), y),
                      xytext=(4 if is_left else -4, 0), ha="left" if is_left else "right",
                      xycoords=axes.get_xaxis_transform(), **style)
        return
    words = f"{share} by episode {max(episodes):,}" if episodes else f"{share}: not reached"
    axes.annotate(words, (0.02, y), xytext=(0, 0), ha="left", xycoords="axes fraction", **style)


def plot_square_error(axes, contestants, runs):
    """Plots the 50-episode mean of the squared TD error: the median of the runs, shaded between
    their lowest and highest value. Omits contestants without updates, such as RANDOM."""
    for one in contestants:
        episodes, smooth = _smooth(runs[one.name])
        smooth = smooth[np.isfinite(smooth).any(axis=1)]  # omits runs without an update
        known = np.isfinite(smooth).all(axis=0) & (smooth > 0.0).all(axis=0)
        if not len(smooth) or not known.any():
            continue
        logs = np.log(smooth[:, known])
        low, median, high = np.exp(np.quantile(logs, (0.0, 0.5, 1.0), axis=0))
        axes.plot(episodes[known], median, **line_style(one), linewidth=2.2, label=one.label)
        if len(smooth) > 1:
            shade(axes, episodes[known], low, high, one.colour)
    axes.margins(x=0.0)
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.6g}")
    axes.yaxis.set_minor_formatter(ticker.NullFormatter())
