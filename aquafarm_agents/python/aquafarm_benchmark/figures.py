# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of the paper's §4 as PNG from the data of results.py.

Each function draw_… creates a figure and saves it. The functions plot_… draw on given axes. The
end of a line in a chart is (x, y, colour, name), where x and y are those of its last point.
"""
import numpy as np
from matplotlib import ticker

from aquafarm_benchmark import measures
from aquafarm_benchmark.curves import (columns_of_runs, describe_shading, most_common_count,
                                       moving_means)
from aquafarm_benchmark.protocol import PRINTED
from aquafarm_benchmark.style import (explain, label_axes, legible, line_style, name_ends, number,
                                      plt, save, shade)

_NBSP = "\N{NO-BREAK SPACE}"
_REACHED = 0.9  # a learner has learnt once it reaches this fraction of the best reference


def _learners(contestants):
    """Returns the contestants except RANDOM."""
    return [one for one in contestants if not one.name.startswith("random")]


def _highest(contestants, ends, what, digits=0):
    """Returns the headline of a chart, such as "DQN has the highest return: 271". Compares the last
    values of the lines, rounded to `digits`, without RANDOM. If all labels end with PRINTED, the
    headline begins with "With the settings as printed" instead of repeating PRINTED."""
    learners = {one.label for one in _learners(contestants)}
    last = sorted(((y, name) for _, y, _, name in ends if name in learners), reverse=True)
    if not last:
        return what.capitalize()
    value = number(last[0][0], digits)
    names = [name for y, name in last if number(y, digits) == value]
    said = f"{names[0]}: {what} {value}" if len(last) == 1 else (
        f"{' and '.join(names)} {'has' if len(names) == 1 else 'have'} the highest {what}: {value}")
    if all(name.endswith(PRINTED) for _, name in last):
        return f"With the settings as printed, {said.replace(PRINTED, '')}"
    return said


def _with_values(contestants, ends, digits=0):
    """Returns the ends of lines. Appends the last values to the names of contestants: "DQN 271"."""
    labels = {one.label for one in contestants}
    return [(x, y, colour, f"{name}{_NBSP}{number(y, digits)}" if name in labels else name)
            for x, y, colour, name in ends]


def _range_of(axes):
    """Returns the lowest and highest values on the axes, without the lowest 2 % of each line."""
    shown = [line.get_ydata() for line in axes.lines]
    return min(np.quantile(y, 0.02) for y in shown), max(np.max(y) for y in shown)


def _scale_returns(axes):
    """Sets a scale that is linear above 0 and logarithmic below, or only linear if both values of
    _range_of have the same sign. The first episodes have very low returns, which on a linear scale
    would hide the differences between learners. Returns a note on the scale for the label of the
    axis."""
    low, top = _range_of(axes)
    if top <= 0.0 or low >= 0.0:
        margin = 0.05 * (top - low)
        axes.set_ylim(low - margin, top + margin)
        return ""
    unit = top / 3.0  # the scale is nearly linear down to -unit, logarithmic below
    axes.set_yscale("function", functions=(
        lambda y: np.where(y < 0.0, -unit * np.log1p(np.maximum(-y, 0.0) / unit), y),
        lambda y: np.where(y < 0.0, unit * (1.0 - np.exp(np.maximum(-y, 0.0) / unit)), y)))
    above = [tick for tick in ticker.MaxNLocator(6).tick_values(0.0, top) if 0.0 <= tick <= top]
    below = [tick for power in range(1, 8) for tick in (-(10.0 ** power), -3.0 * 10.0 ** power)
             if low <= tick <= -unit]
    axes.set_yticks([*below, *above])
    axes.set_ylim(1.15 * low, 1.07 * top)
    axes.axhspan(1.15 * low, 0.0, color=_LOGARITHMIC, linewidth=0, zorder=0)
    return "\n(logarithmic below 0)"


def _draw_returns(path, contestants, find, note, ylabel, plots):
    """Draws charts of returns, one below the other, on the scale of _scale_returns. Names the lines
    whose ends the functions in `plots` return.

    find: function that returns the headline, given the ends of the lines of the last chart
    note: how the data were computed
    plots: for each chart, from top to bottom: (function, xlabel, has_values). The function plots on
        axes and returns the ends of the lines without a name, for name_ends; has_values: names are
        followed by the last values
    """
    figure, rows = plt.subplots(len(plots), 1, figsize=(8.7, 1.0 + 4.4 * len(plots)),
                                squeeze=False, layout="constrained")
    charts = [(axes, plot(axes), xlabel, has_values)
              for (plot, xlabel, has_values), axes in zip(plots, rows[:, 0])]
    explain(figure, find(charts[-1][1]), note)
    for axes, ends, xlabel, has_values in charts:
        label_axes(axes, "", ylabel + _scale_returns(axes), xlabel)
        axes.yaxis.set_major_formatter(lambda value, _: number(value))
        name_ends(axes, _with_values(contestants, ends) if has_values else ends)
    save(figure, path)


_LOGARITHMIC = "#eef1f4"  # background of the logarithmic part of a scale
_MOST_SHADED = 2  # the shades of more lines would mix
_LETTER = 0.013  # mean width of a letter of a name [widths of the axes]
_ALIKE = 0.02  # references share one line if their relative difference is below this


def _plot_references(axes, references, end, digits=0):
    """Draws horizontal lines for reference values {name: value}. Similar values share one line, see
    _ALIKE. Returns the ends of the lines."""
    ends = []
    for name, value in sorted(references.items(), key=lambda pair: -pair[1]):
        words = f"{name} {value:.{digits}f}"
        if ends and ends[-1][1] - value < _ALIKE * abs(value):
            ends[-1] = (*ends[-1][:3], f"{ends[-1][3]}, {words}")
            continue
        axes.axhline(value, color="black", linestyle="--", linewidth=1.2, label="_reference")
        ends.append((end, value, "black", words))
    return ends


def _plot_one_run(axes, one, curve, x):
    """Plots the 50-episode mean return of a run. Returns the end of the line.

    x: position of each episode on the x axis
    """
    episodes, means = moving_means(curve["return"])
    axes.plot(x[episodes - 1], means, linewidth=1.2, **line_style(one), label=one.label)
    return x[episodes[-1] - 1], means[-1], one.colour, one.label


def _mark_reached(axes, references):
    """Draws a dotted line at the return to which the headline of Fig. 12a refers. Returns this
    return, and the end of the line in a list. Without a positive reference, returns infinity and an
    empty list."""
    target = _REACHED * max(references.values(), default=0.0)
    if target <= 0.0:
        return np.inf, []
    axes.axhline(target, color="black", linestyle=":", linewidth=1.2, label="_reached")
    return target, [(axes.get_xlim()[1], target, "black",
                     f"{100 * _REACHED:.0f} % of {target / _REACHED:.0f}")]


def _name_reached(axes, ends, target):
    """Marks where lines reach the return `target`. Writes the names and numbers of steps of these
    lines above the axes, in several rows if they are close. Returns the ends of all other lines."""
    others = []
    reached = []
    for end in ends:
        line, = (one for one in axes.lines if one.get_label() == end[3])
        x, y = line.get_data()
        if (y >= target).any():
            reached.append((x[np.argmax(y >= target)], end[2], end[3]))
        else:
            others.append(end)
    to_axes = axes.transData + axes.transAxes.inverted()
    row_ends = [-np.inf] * len(reached)  # where the last names of the rows end [widths of the axes]
    for steps, colour, name in sorted(reached):
        words = f"{name} {_steps_text(float(f'{steps:.2g}'))}"
        place = float(to_axes.transform((steps, target))[0])
        row = next(i for i, end in enumerate(row_ends) if place - _LETTER * len(words) > end)
        row_ends[row] = place
        axes.plot(steps, target, "o", color=colour, markersize=5, zorder=5, label="_reached")
        axes.annotate(words, (steps, target), xytext=(place, 1.025 + 0.05 * row),
                      textcoords=axes.transAxes, ha="right", va="bottom", color=legible(colour),
                      fontsize=10, annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8,
                                  "relpos": (1.0, 0.0), "shrinkA": 0.0, "shrinkB": 2.0})
    return others


def plot_rewards_by_steps(axes, contestants, runs, references):
    """Plots Fig. 12a: the 50-episode mean return of the first run by time steps taken so far.
    Returns the ends of the lines that have no name yet."""
    ends = []
    for one in contestants:
        curve = runs[one.name][0]["curve"]
        ends.append(_plot_one_run(axes, one, curve, np.cumsum(curve["steps"])))
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(lambda value, _: _steps_text(value))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())
    # RANDOM takes the most steps. The chart ends where the last learner ends.
    learners = {one.label for one in _learners(contestants)}
    last = max((x for x, _, _, name in ends if name in learners), default=np.inf)
    ends = [end for end in (_cut(axes, end, last) for end in ends) if end]
    axes.relim()
    axes.margins(x=0.0)
    axes.autoscale_view()
    target, reference = _mark_reached(axes, references)
    ends = _name_reached(axes, ends, target)
    return ends + reference + _plot_references(axes, references, axes.get_xlim()[1])


def _cut(axes, end, last):
    """Cuts the line with this end at x = last. Returns its new end. If nothing is left, removes the
    line and returns None."""
    if end[0] <= last:
        return end
    line, = (one for one in axes.lines if one.get_label() == end[3])
    x, y = line.get_data()
    shown = x <= last
    if not shown.any():
        line.remove()
        return None
    line.set_data(x[shown], y[shown])
    return x[shown][-1], y[shown][-1], *end[2:]


def _steps_text(value):
    """Returns a number of steps as text: "200k", "1M"."""
    return f"{value / 1e6:g}M" if value >= 1e6 else f"{value / 1e3:g}k" if value >= 1e3 else f"{value:g}"


def plot_rewards_by_episodes(axes, contestants, runs, references):
    """Plots the 50-episode mean return of the first run by episode. Returns the ends of lines."""
    ends = []
    for one in contestants:
        curve = runs[one.name][0]["curve"]
        ends.append(_plot_one_run(axes, one, curve, np.arange(1, len(curve["return"]) + 1)))
    return ends + _plot_references(axes, references, max(end[0] for end in ends))


def draw_rewards(path, contestants, runs, references):
    """Draws Fig. 12a, and below it the same data by episodes."""
    data = (contestants, runs, references)
    _draw_returns(
        path, contestants, lambda ends: _learning_times(contestants, runs, references) or
        _highest(contestants, ends, "return at the end of the training"),
        f"Fig. 12a: the first run of each learner, means of {measures.WINDOW} episodes. The upper "
        "chart ends with the last learner; RANDOM takes more steps.",
        f"{measures.WINDOW}-episode mean return", [
            (lambda axes: plot_rewards_by_steps(axes, *data), "time steps so far (logarithmic)",
             False),
            (lambda axes: plot_rewards_by_episodes(axes, *data), "episode", True)])


def _learning_times(contestants, runs, references):
    """Returns the headline of Fig. 12a: after how many steps the first run of each learner reaches
    _REACHED of the best reference. "" if there is no positive reference."""
    best = max(references, key=references.get, default=None)
    if best is None or references[best] <= 0.0:
        return ""
    found = []
    for one in _learners(contestants):
        curve = runs[one.name][0]["curve"]
        episodes, means = moving_means(curve["return"])
        reached = means >= _REACHED * references[best]
        steps = np.cumsum(curve["steps"])[episodes[np.argmax(reached)] - 1] if reached.any() else np.inf
        found.append((steps, one.label))
    texts = [f"{name}{_NBSP}{float(f'{steps:.2g}'):,.0f}" if steps < np.inf else
             f"{name}{_NBSP}never" for steps, name in sorted(found)]
    return (f"Time steps until {100 * _REACHED:.0f} % of the return of the {best}: "
            f"{', '.join(texts)}")


def draw_average_rewards(path, contestants, runs, references):
    """Draws Fig. 12b: the mean return of all episodes so far, over all runs."""
    _draw_returns(
        path, contestants,
        lambda ends: _highest(contestants, ends, "mean return of all episodes"),
        f"Fig. 12b: mean return of all episodes so far. {describe_shading(contestants, runs)}",
        "mean return so far",
        [(lambda axes: plot_average_rewards(axes, contestants, runs, references), "episode", True)])


def plot_average_rewards(axes, contestants, runs, references):
    """Plots the mean return of all episodes so far: the median of the runs, shaded between their
    lowest and highest value. Returns the ends of the lines."""
    ends = []
    for one in contestants:
        curves = columns_of_runs(runs[one.name], "return")
        episodes = np.arange(1, curves.shape[1] + 1)
        ends.append(_plot_shaded(axes, episodes, np.cumsum(curves, axis=1) / episodes, one, one.label))
    return ends + _plot_references(axes, references, max(end[0] for end in ends))


def draw_mean_score(path, contestants, runs, references):
    """Draws Fig. 13: the mean return per step by episode: (a) LSTM-DQN, (b) SARSA, (c) all
    contestants. If several contestants have the algorithm of (a) or (b), the one with its name is
    shown, or the first.

    references: {name: return per step}, drawn for comparison
    """
    panels = []
    for letter, algorithm in (("a", "lstm_dqn"), ("b", "sarsa")):
        rows = [one for one in contestants if one.algorithm_name == algorithm]
        rows.sort(key=lambda one: one.name != algorithm)
        panels += [(letter, [one]) for one in rows[:1]]
    figure = plt.figure(figsize=(9, 8.4 if panels else 4.9), layout="constrained")
    places = [[letter for letter, _ in panels], ["c"] * len(panels)] if panels else [["c"]]
    all_axes = figure.subplot_mosaic(places, height_ratios=[3, 4] if panels else None)
    is_shaded = len(contestants) <= _MOST_SHADED
    note = (f"Fig. 13: means of {measures.WINDOW} episodes. " +
            (describe_shading(contestants, runs) if is_shaded or panels else
             f"Median of {most_common_count(contestants, runs)} runs.") +
            ("" if is_shaded or not panels else " The lower chart shows the medians only."))
    for letter, panel in [("c", contestants), *panels]:
        whose = "All" if letter == "c" else panel[0].label
        label_axes(all_axes[letter], f"{whose} (Fig. 13{letter})", "return per step")
        limits = None if letter == "c" else all_axes["c"].get_ylim()
        ends = plot_mean_score(all_axes[letter], panel, runs, references, limits)
        all_axes[letter].margins(x=0.0)
        if letter == "c":  # in the other panels the title names the line
            explain(figure, _highest(contestants, ends, "return per step at the end", digits=2), note)
            name_ends(all_axes[letter], _with_values(contestants, ends, digits=2))
        for name, value in references.items():
            if letter != "c":
                all_axes[letter].annotate(name, (0.99, value), xytext=(0, -3), va="top", ha="right",
                                          xycoords=all_axes[letter].get_yaxis_transform(),
                                          textcoords="offset points", fontsize=9.5)
    save(figure, path)


def plot_mean_score(axes, contestants, runs, references, limits=None):
    """Plots the 50-episode mean return per step: the median of the runs. Up to _MOST_SHADED lines
    are shaded between the lowest and the highest run. Returns the ends of the lines.

    references: {name: return per step}, drawn for comparison
    limits: limits of the y axis; None: automatic
    """
    ends = []
    for one in contestants:
        returns = columns_of_runs(runs[one.name], "return")
        steps = columns_of_runs(runs[one.name], "steps")
        window = min(measures.WINDOW, returns.shape[1])
        scores = np.array([measures.return_per_step(*pair, window)
                           for pair in zip(returns, steps)])
        episodes = np.arange(window, returns.shape[1] + 1)
        plot = _plot_shaded if len(contestants) <= _MOST_SHADED else _plot_median
        ends.append(plot(axes, episodes, scores, one, one.label))
    axes.axhline(0.0, color="black", linewidth=0.5, label="_zero")
    ends += _plot_references(axes, references, max(end[0] for end in ends), digits=2)
    if limits:
        axes.set_ylim(limits)
    return ends


def draw_evaluation(path, contestants, rows):
    """Draws the return of greedy episodes that are not used for training, with 95 % intervals.
    The upper chart shows only the part above 0, the lower chart the whole range."""
    figure, (zoom, whole) = plt.subplots(2, 1, figsize=(8, 6), sharex=True, layout="constrained",
                                         height_ratios=[3, 2])
    label_axes(zoom, "Return on episodes never trained on", "return of an episode\nenlarged: above 0",
           "")
    label_axes(whole, "", "whole range", "")
    for axes in (zoom, whole):
        plot_evaluation(axes, contestants, rows)
    if zoom.get_ylim()[1] > 0.0:
        zoom.set_ylim(bottom=0.0)
    save(figure, path)


def plot_evaluation(axes, contestants, rows):
    """Plots a bar for each contestant: interquartile mean of its runs, with the 95 % interval."""
    by_name = {row["name"]: row for row in rows}
    for place, one in enumerate(contestants):
        row = by_name[one.name]
        value = row["return_iqm"]
        low, high = row["return_interval"]
        error = None if np.isnan(low) else [[value - low], [high - value]]
        axes.bar(place, value, color=one.colour, yerr=error, capsize=4)
        axes.annotate(f"{value:.0f}", (place, max(value, 0.0)), xytext=(0, 8),
                      textcoords="offset points", ha="center")
    axes.axhline(0.0, color="black", linewidth=0.5)
    axes.margins(y=0.15)
    axes.set_xticks(range(len(contestants)), [one.label for one in contestants], rotation=15)


def draw_repeated(path, contestants, runs, references):
    """Draws Fig. 14: the 50-episode mean return over all runs."""
    _draw_returns(
        path, contestants,
        lambda ends: _highest(contestants, ends, "return at the end of the training"),
        f"Fig. 14: repeated trainings, means of {measures.WINDOW} episodes. "
        f"{describe_shading(contestants, runs)}", f"{measures.WINDOW}-episode mean return",
        [(lambda axes: plot_repeated(axes, contestants, runs, references), "episode", True)])


def plot_repeated(axes, contestants, runs, references):
    """Plots the 50-episode mean return: the median of the runs, shaded between their lowest and
    highest value. Returns the ends of the lines."""
    ends = []
    for one in contestants:
        smooth = [moving_means(curve) for curve in columns_of_runs(runs[one.name], "return")]
        values = np.array([curve for _, curve in smooth])
        ends.append(_plot_shaded(axes, smooth[0][0], values, one, one.label))
    return ends + _plot_references(axes, references, max(end[0] for end in ends))


def _plot_median(axes, episodes, values, one, label):
    """Plots the median of values [runs, episodes]. Returns the end of the line."""
    median = np.median(values, axis=0)
    axes.plot(episodes, median, **line_style(one), label=label)
    return episodes[-1], median[-1], one.colour, label


def _plot_shaded(axes, episodes, values, one, label):
    """Plots the median of values [runs, episodes], shaded between their lowest and highest value.
    Returns the end of the line."""
    shade(axes, episodes, values.min(axis=0), values.max(axis=0), one.colour)
    return _plot_median(axes, episodes, values, one, label)
