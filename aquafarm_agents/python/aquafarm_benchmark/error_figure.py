# SPDX-License-Identifier: BSD-3-Clause
"""Draws Fig. 12c, the error of the value estimates, as PNG from the data of results.py."""
import numpy as np
from matplotlib import ticker
from matplotlib.patheffects import withStroke

from aquafarm_benchmark import measures
from aquafarm_benchmark.curves import End, columns_of_runs, describe_shading, moving_means
from aquafarm_benchmark.style import (explain, joined, label_axes, legible, line_style, name_ends,
                                      plt, save, shade)

_PEAK = 2.0  # a peak is at least this multiple of the first and of the last value
_SAME = 0.05  # relative change below which an error ends where it begins
_HEADROOM = 1.5  # factor of the upper limit, for the numbers at the highest values
_SUCCESS = 0.5  # the success rate that the charts mark


def draw_square_error(path, contestants, runs):
    """Draws Fig. 12c: the mean square error of the value estimates, a chart for each learner, over
    all runs. An unused place has a chart of all medians. Omits contestants without updates, such as
    RANDOM."""
    learners = [one for one in contestants
                if np.isfinite(columns_of_runs(runs[one.name], "loss")).any()]
    columns = min(3, max(1, len(learners)))
    rows = max(1, -(-len(learners) // columns))
    figure, all_axes = plt.subplots(rows, columns, figsize=(3.1 * columns, 1.2 + 2.5 * rows),
                                    squeeze=False, sharex=True, sharey=True, layout="constrained")
    courses = {}
    for axes, one in zip(all_axes.flat, learners):
        label_axes(axes, "", "", "episode")
        if plot_square_error(axes, [one], runs):
            courses[one.label] = _mark_course(axes, one.colour)
            first, _, last = courses[one.label]
            axes.set_title(f"{one.label}: ends at ×{last / first:.1f}", fontsize=12,
                           color=legible(one.colour))
            _mark_success(axes, runs[one.name])
    for axes in all_axes.flat:
        axes.tick_params(labelbottom=True, labelleft=axes in all_axes[:, 0])
    for axes in all_axes[:, 0]:
        axes.set_ylabel("error [reward²]")
    low, high = all_axes[0, 0].get_ylim()
    all_axes[0, 0].set_ylim(low, _HEADROOM * high)  # the charts share their scale
    unused = all_axes.flat[len(learners):]
    for axes in unused[1:]:
        axes.axis("off")
    explain(figure, describe_courses(courses),
            f"Fig. 12c: mean square error over {measures.WINDOW} episodes, logarithmic. Dots: "
            "first value, last value, and the highest if it is far from both; ×: last value "
            f"relative to the first. Grey: when {100 * _SUCCESS:.0f} % of the last "
            f"{measures.WINDOW} episodes first succeed, from the earliest run to the latest. "
            f"{describe_shading(contestants, runs)} Each learner has "
            "its own targets: a lower error does not mean a better policy.")
    if len(unused):
        label_axes(unused[0], "all medians", "", "episode")
        name_ends(unused[0], plot_square_error(unused[0], learners, runs, is_shaded=False))
    save(figure, path)


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
    peaks = [f"that of {name} first rises to {_significant(peak)}"
             for name, (first, peak, last) in courses.items()
             if name in lower and peak > _PEAK * max(first, last)]
    return f"{said}; {joined(peaks)}" if peaks else said


def _ending(names, where):
    return (f"errors of {joined(names)} end {where} than they begin" if len(names) > 1 else
            f"error of {names[0]} ends {where} than it begins")


def _significant(value):
    return f"{value:,.0f}" if value >= 10.0 else f"{value:.2g}"


def _mark_course(axes, colour):
    """Marks the first, the highest and the last value of the line on the axes. Returns them."""
    x, y = axes.lines[0].get_data()
    top = int(np.argmax(y))
    # A highest value near the first or the last one has no mark of its own.
    near = 0.12 * (x[-1] - x[0])
    marks = {0: "left", **({top: "center"} if near < x[top] - x[0] < x[-1] - x[0] - near else {}),
             len(x) - 1: "right"}
    for i, across in marks.items():
        offset = (3 if across == "left" else 0, 8)
        axes.plot(x[i], y[i], "o", color=colour, markersize=5, zorder=5, label="_value")
        axes.annotate(_significant(y[i]), (x[i], y[i]), xytext=offset, textcoords="offset points",
                      ha=across, color=legible(colour), fontsize=11, weight="bold", zorder=6,
                      path_effects=[withStroke(linewidth=3, foreground="white")])
    return y[0], y[top], y[-1]


def _mark_success(axes, of_one):
    """Shades the episodes at which the success rate of the runs first reaches _SUCCESS, from the
    earliest run to the latest."""
    found = []
    for successes in columns_of_runs(of_one, "success"):
        episodes, means = moving_means(successes)
        found += list(episodes[means >= _SUCCESS][:1])
    if found:
        axes.axvspan(min(found), max(found), facecolor="0.88", edgecolor="0.6", linewidth=1.0,
                     zorder=0)


def plot_square_error(axes, contestants, runs, is_shaded=True):
    """Plots the 50-episode mean of the squared TD error: the median of the runs, shaded between
    their lowest and highest value. Omits contestants without updates, such as RANDOM. Returns the
    ends of the lines."""
    ends = []
    for one in contestants:
        errors = columns_of_runs(runs[one.name], "loss")
        window = min(measures.WINDOW, errors.shape[1])
        smooth = np.array([measures.known_moving_mean(row, window) for row in errors])
        episodes = np.arange(window, errors.shape[1] + 1)
        smooth = smooth[np.isfinite(smooth).any(axis=1)]  # omits runs without an update
        known = np.isfinite(smooth).all(axis=0) & (smooth > 0.0).all(axis=0)
        if not len(smooth) or not known.any():
            continue
        logs = np.log(smooth[:, known])
        low, median, high = np.exp(np.quantile(logs, (0.0, 0.5, 1.0), axis=0))
        axes.plot(episodes[known], median, **line_style(one), linewidth=2.2, label=one.label)
        if is_shaded and len(smooth) > 1:
            shade(axes, episodes[known], low, high, one.colour)
        ends.append(End(episodes[known][-1], float(median[-1]), one.colour, one.label))
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.6g}")
    axes.yaxis.set_minor_formatter(ticker.NullFormatter())
    return ends
