# SPDX-License-Identifier: BSD-3-Clause
"""Draws Fig. 12c, the error of the value estimates, as PNG from the data of results.py."""
import numpy as np
from matplotlib import ticker

from aquafarm_benchmark import measures
from aquafarm_benchmark.curves import columns_of_runs, describe_shading
from aquafarm_benchmark.style import (explain, label_axes, legible, line_style, plt, save, shade,
                                      write_note)


def draw_square_error(path, contestants, runs):
    """Draws Fig. 12c: the mean square error of the value estimates, a chart for each learner, over
    all runs. Omits contestants without updates, such as RANDOM."""
    learners = [one for one in contestants
                if np.isfinite(columns_of_runs(runs[one.name], "loss")).any()]
    columns = min(3, max(1, len(learners)))
    rows = max(1, -(-len(learners) // columns))
    figure, all_axes = plt.subplots(rows, columns, figsize=(3.3 * columns, 1.2 + 2.5 * rows),
                                    squeeze=False, sharex=True, sharey=True, layout="constrained")
    changes = []
    for axes, one in zip(all_axes.flat, learners):
        ends = plot_square_error(axes, [one], runs)
        label_axes(axes, "", "", "episode")
        axes.tick_params(labelbottom=True, labelleft=axes in all_axes[:, 0])
        if ends:
            first, last = axes.lines[0].get_ydata()[[0, -1]]
            axes.set_title(f"{one.label}: {_significant(first)} → {_significant(last)} "
                           f"(×{last / first:.1f})", fontsize=11, color=legible(one.colour))
            changes.append((last / first, one.label))
    for axes in all_axes[:, 0]:
        axes.set_ylabel("error [reward²]")
    changes = [f"×{ratio:.1f} ({name})" for ratio, name in sorted(changes)]
    found = f"{changes[0]} to {changes[-1]}" if len(changes) > 1 else ", ".join(changes) or "none"
    note = (f"Fig. 12c: mean square error over {measures.WINDOW} episodes, logarithmic. The titles "
            "give the first and the last value and their ratio. "
            f"{describe_shading(contestants, runs)} The error is measured against each learner's "
            "own targets, so a lower error does not mean a better policy: a policy that fails can "
            "have a low error.")
    unused = all_axes.flat[len(learners):]
    for axes in unused:
        axes.axis("off")
    if len(unused):
        write_note(unused[0], note)
    explain(figure, f"Error of the value estimates in training: {found}",
            "" if len(unused) else note)
    save(figure, path)


def _significant(value):
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.2g}"


def plot_square_error(axes, contestants, runs):
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
        if len(smooth) > 1:
            shade(axes, episodes[known], low, high, one.colour)
        ends.append((episodes[known][-1], float(median[-1]), one.colour, one.label))
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.6g}")
    axes.yaxis.set_minor_formatter(ticker.NullFormatter())
    return ends
