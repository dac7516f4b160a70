# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of the paper's §4 as PNG from the data of results.py.

Each function draw_… creates a figure and saves it. The functions plot_… draw on given axes.
"""
import math

import numpy as np
from matplotlib import ticker

from aquafarm_benchmark import headlines, measures
from aquafarm_benchmark.curves import (End, columns_of_runs, describe_random, describe_shading,
                                       most_common_count, moving_means)
from aquafarm_benchmark.style import (chart_grid, explain, joined, label_axes, legible, line_style,
                                      name_ends, number, plt, save, shade)


def _range_of(axes):
    """Returns the lowest and highest values on the axes, without the lowest 2 % of each line."""
    shown = [line.get_ydata() for line in axes.lines]
    return min(np.quantile(y, 0.02) for y in shown), max(np.max(y) for y in shown)


def _scale_returns(axes):
    """Sets a scale that is linear above 0 and logarithmic below, or only linear if both values of
    _range_of have the same sign. The first episodes have very low returns, which on a linear scale
    would hide the differences between learners. Returns a note on the scale for the label of the
    axis. Does nothing if the limits of the axis are fixed."""
    if not axes.get_autoscaley_on():
        return ""
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


def _draw_returns(path, contestants, find, note, ylabel, plots, xlabel="episode", strip=None):
    """Draws charts of returns, one below the other, on the scale of _scale_returns. Names the lines
    whose ends the functions in `plots` return.

    find: function that returns the headline, given the ends of the lines of the first chart
    note: how the data were computed
    plots: for each chart, from top to bottom: (function, title, has_values). The function plots on
        axes and returns the ends of the lines without a name, for name_ends; has_values: names are
        followed by the last values
    strip: (function, title, number of rows) of a chart below the others, with the x axis of the
        first chart; the function plots on axes
    """
    heights = [4.4, 2.9][:len(plots)] + ([0.6 + 0.22 * strip[2]] if strip else [])
    figure, rows = plt.subplots(len(heights), 1, figsize=(8.7, 0.6 + sum(heights)), squeeze=False,
                                height_ratios=heights, layout="constrained")
    charts = [(axes, plot(axes), title, has_values)
              for (plot, title, has_values), axes in zip(plots, rows[:, 0])]
    headline = find(charts[0][1])
    explain(figure, headline, " ".join(filter(None, [
        note, headlines.describe_failed(headline), describe_random(contestants)])))
    for axes, ends, title, has_values in charts:
        label_axes(axes, title, ylabel + _scale_returns(axes), xlabel)
        axes.yaxis.set_major_formatter(lambda value, _: number(value))
        name_ends(axes, headlines.with_values(contestants, ends) if has_values else ends)
    if strip:
        plot_strip, title, _ = strip
        below, first = rows[-1, 0], charts[0][0]
        plot_strip(below)
        below.set_xlim(first.get_xlim())
        label_axes(below, "", "", xlabel)
        below.set_title(title, fontsize=10.5)
        first.set_xlabel("")
    save(figure, path)


_LOGARITHMIC = "#eef1f4"  # background of the logarithmic part of a scale
_END = 0.25  # the lower chart of Fig. 14 shows this last part of the training
_STRIP = 0.15  # width of the space for ranges to the right of it [lengths of this part]
_LETTER = 0.013  # mean width of a letter of a name [widths of the axes]
_BEFORE = 0.8  # Fig. 12a begins at this fraction of the steps of the first value
_TITLE = 31  # max length of a line of a title of Fig. 13
_ALIKE = 0.02  # a reference is not drawn if it is below another one by less than this


def _plot_references(axes, references, end, digits=0, alike=_ALIKE):
    """Draws horizontal lines for reference values {name: value}. Leaves out a value that is below
    another one by less than `alike`, relative to its size. Returns the ends of the lines."""
    ends = []
    for name, value in sorted(references.items(), key=lambda pair: -pair[1]):
        if not ends or ends[-1].y - value >= alike * abs(value):
            axes.axhline(value, color="black", linestyle="--", linewidth=1.2, label="_reference")
            ends.append(End(end, value, "black", f"{name} {value:.{digits}f}"))
    return ends


def _plot_one_run(axes, one, curve, **style):
    """Plots the 50-episode mean return of a run by time steps. Returns the end of the line."""
    episodes, means = moving_means(curve["return"])
    steps = np.cumsum(curve["steps"])[episodes - 1]
    axes.plot(steps, means, **{**line_style(one), "label": one.label, "linewidth": 1.5, **style})
    return End(steps[-1], means[-1], one.colour, one.label)


def _mark_reached(axes, references):
    """Draws a dotted line at the value of target_of. Returns the end of the line in a list, or an
    empty list if the value is infinite."""
    target = headlines.target_of(references)
    if target == math.inf:
        return []
    axes.axhline(target, color="black", linestyle=":", linewidth=1.2, label="_reached")
    return [End(axes.get_xlim()[1], target, "black",
                f"{100 * headlines.REACHED:.0f} % of {target / headlines.REACHED:.0f}")]


def _name_reached(axes, ends, target, steps_of):
    """Marks the median numbers of steps at which learners reach the return `target`. Writes them
    and the names of the learners above the axes, in several rows if they are close. Returns the
    ends of all other lines.

    steps_of: {name of a line: numbers of steps of the runs}
    """
    last = axes.get_xlim()[1]
    others = [end for end in ends if np.median(steps_of[end.name]) > last]
    reached = [(np.median(steps_of[end.name]), end.colour, end.name) for end in ends
               if end not in others]
    to_axes = axes.transData + axes.transAxes.inverted()
    row_ends = [-np.inf] * len(reached)  # where the last names of the rows end [widths of the axes]
    for steps, colour, name in sorted(reached):
        words = f"{name} {headlines.rounded_steps(steps)}"
        if max(steps_of[name]) == math.inf:
            words += f" ({headlines.in_some(steps_of[name])})"
        place, width = float(to_axes.transform((steps, target))[0]), _LETTER * len(words)
        right = max(place, width)  # a name begins right of the axis of returns
        # A name also leaves space for the leaders of the names above it.
        row = next(i for i in range(len(row_ends)) if right - width > max(row_ends[i:]))
        row_ends[row] = right
        axes.plot(steps, target, "o", color=colour, markersize=7, markeredgecolor="white", zorder=6,
                  label="_reached")
        axes.annotate(words, (steps, target), xytext=(right, 1.025 + 0.05 * row),
                      textcoords=axes.transAxes, ha="right", va="bottom", color=legible(colour),
                      fontsize=10, annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8,
                                  "relpos": (1.0 - (right - place) / width, 0.0),
                                  "shrinkA": 0.0, "shrinkB": 2.0})
    return others


def plot_rewards_by_steps(axes, contestants, runs, references):
    """Plots Fig. 12a: the 50-episode mean return by time steps taken so far. The line of the run
    nearest to the median is thick, see _nearest_to_median. Returns the ends of the lines that have
    no name yet."""
    target = headlines.target_of(references)
    steps_of = {one.label: headlines.steps_until(runs[one.name], target) for one in contestants}
    main = {one.name: _nearest_to_median(steps_of[one.label]) for one in contestants}
    ends = [_plot_one_run(axes, one, runs[one.name][main[one.name]]["curve"])
            for one in contestants]
    _scale_steps(axes)
    thin = [_plot_one_run(axes, one, run["curve"], label="_run", linewidth=0.8, alpha=0.5)
            for one in headlines.learners_of(contestants)
            for i, run in enumerate(runs[one.name]) if i != main[one.name]]
    # RANDOM takes the most steps. The chart ends where the last run of a learner ends.
    learners = {one.label for one in headlines.learners_of(contestants)}
    last = max((end.x for end in ends + thin if end.name in learners), default=np.inf)
    ends = [end for end in (_cut(axes, end, last) for end in ends) if end]
    axes.relim()
    axes.margins(x=0.0)
    axes.autoscale_view()
    axes.set_xlim(left=_BEFORE * axes.get_xlim()[0])
    reference = _mark_reached(axes, references)
    ends = [_with_failure(end, steps_of[end.name]) if end.name in learners and target < math.inf
            else end for end in _name_reached(axes, ends, target, steps_of)]
    return ends + reference + _plot_references(axes, references, axes.get_xlim()[1])


def _scale_steps(axes):
    """Sets a logarithmic x axis of time steps."""
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(lambda value, _: headlines.steps_text(value))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())


def plot_times(axes, learners, runs, target):
    """Plots the numbers of time steps at which the runs of each learner reach the return `target`:
    a row for each learner, the fastest at the top, with a dot for each run, a tick for the median
    and a bar for the range. States how many runs reach it if not all do."""
    rows = sorted(((headlines.steps_until(runs[one.name], target), one) for one in learners),
                  key=lambda row: (np.median(row[0]), min(row[0]), row[1].label))
    for y, (steps, one) in enumerate(rows):
        known = [value for value in steps if value < math.inf]
        if known:
            axes.plot([min(known), max(known)], [y, y], color=one.colour, linewidth=2.5,
                      label="_range")
            axes.plot(known, [y] * len(known), "o", color=one.colour, markersize=5, label="_runs")
        if np.median(steps) < math.inf:
            axes.plot(np.median(steps), y, "|", color=one.colour, markersize=15,
                      markeredgewidth=2.5, label="_median")
        if len(known) < len(steps):
            words = headlines.in_some(steps) if known else "not reached"
            at = (max(known), y) if known else (1.0, y)
            axes.annotate(words, at, xytext=(8 if known else -4, 0), textcoords="offset points",
                          xycoords="data" if known else axes.get_yaxis_transform(), va="center",
                          ha="left" if known else "right", color=legible(one.colour))
    axes.set_yticks(range(len(rows)), [one.label for _, one in rows])
    for name, (_, one) in zip(axes.get_yticklabels(), rows):
        name.set_color(legible(one.colour))
    axes.tick_params(axis="y", length=0)
    _scale_steps(axes)
    axes.set_ylim(len(rows) - 0.4, -0.6)


def _with_failure(end, steps):
    """Returns the end of a line. Appends that the learner does not reach the target, or in how many
    runs it does."""
    words = headlines.in_some(steps) if min(steps) < math.inf else "not reached"
    return end._replace(name=f"{end.name}: {100 * headlines.REACHED:.0f} % {words}")


def _cut(axes, end, last):
    """Cuts the line with this end at x = last. Returns its new end. If nothing is left, removes the
    line and returns None."""
    if end.x <= last:
        return end
    line, = (one for one in axes.lines if one.get_label() == end.name)
    x, y = line.get_data()
    shown = x <= last
    if not shown.any():
        line.remove()
        return None
    line.set_data(x[shown], y[shown])
    return end._replace(x=x[shown][-1], y=y[shown][-1])


def draw_rewards(path, contestants, runs, references):
    """Draws Fig. 12a."""
    count, learners = most_common_count(contestants, runs), headlines.learners_of(contestants)
    target = headlines.target_of(references)
    has_target = target < math.inf
    share = f"{100 * headlines.REACHED:.0f} %"
    late = [one.label for one in learners
            if np.median(headlines.steps_until(runs[one.name], target)) == np.inf]
    shown = ("one run of each learner" if count == 1 else f"{count} runs of each learner; thick: "
             + (f"the run whose time to {share} is nearest to the median" +
                (f" (of {joined(late)}: the first run without {share})" if late else "")
                if has_target else "the first"))
    dots = (f"Dots on the dotted line: {share} is reached for the first time"
            f"{' (median of the runs)' if count > 1 else ''}. ")
    title = f"Time steps until {share} is reached" + (
        ": runs (dots), median (tick), range (bar)" if count > 1 else "")
    _draw_returns(
        path, contestants, lambda ends: headlines.learning_times(contestants, runs, references) or
        headlines.highest(contestants, runs, ends, "return"),
        f"Fig. 12a: {shown}. Means of {measures.WINDOW} episodes: a line begins after episode "
        f"{measures.WINDOW}. {dots if has_target else ''}The chart ends with the last run of a "
        f"learner{'' if len(learners) == len(contestants) else '; RANDOM takes more steps'}.",
        f"{measures.WINDOW}-episode mean return",
        [(lambda axes: plot_rewards_by_steps(axes, contestants, runs, references), "", False)],
        "time steps so far (logarithmic)",
        (lambda axes: plot_times(axes, learners, runs, target), title, len(learners))
        if has_target and learners else None)


def _nearest_to_median(values):
    """Returns the index of the value that is nearest to the median. All infinite values are
    equally near to an infinite median."""
    median = np.median(values)
    return min(range(len(values)),
               key=lambda i: 0.0 if values[i] == median else abs(values[i] - median))


def draw_average_rewards(path, contestants, runs, references):
    """Draws Fig. 12b: the mean return of all episodes so far, over all runs."""
    has_dots = any(1 < headlines.recovery(runs[one.name]) < math.inf for one in contestants)
    _draw_returns(
        path, contestants, lambda ends: headlines.recovery_times(contestants, runs) or
        headlines.highest(contestants, runs, ends, "mean return of all episodes"),
        "Fig. 12b: mean return of all episodes so far; bad early episodes count to the end. "
        "Fig. 14 shows the means of the last episodes. "
        f"{'Dots: the median rises above 0. ' if has_dots else ''}"
        f"{describe_shading(contestants, runs)}"
        f"{' Thin: the runs.' if most_common_count(contestants, runs) > 1 else ''}",
        "mean return so far",
        [(lambda axes: plot_average_rewards(axes, contestants, runs, references), "", True)])


def plot_average_rewards(axes, contestants, runs, references):
    """Plots the mean return of all episodes so far: the median of the runs, shaded between their
    lowest and highest value. Returns the ends of the lines."""
    ends = []
    for one in contestants:
        means = headlines.means_so_far(runs[one.name])
        ends.append(_plot_shaded(axes, np.arange(1, means.shape[1] + 1), means, one))
        axes.plot(np.arange(1, means.shape[1] + 1), means.T, color=one.colour, linewidth=0.7,
                  alpha=0.6, label="_run")
        if 1 < headlines.recovery(runs[one.name]) < math.inf:
            axes.plot(headlines.recovery(runs[one.name]), 0.0, "o", color=one.colour, markersize=6,
                      markeredgecolor="white", zorder=5, label="_recovery")
    return ends + _plot_references(axes, references, max(end.x for end in ends))


def draw_mean_score(path, contestants, runs, references):
    """Draws Fig. 13: the mean return per step by episode: a chart for each learner with the range
    of its runs and RANDOM, in the order of the contestants, and a last chart with the medians of
    all. The last chart enlarges the end of the training if two or more learners learn the task.

    references: {name: return per step}, drawn for comparison
    """
    learners = headlines.learners_of(contestants)
    random = [one for one in contestants if one not in learners]
    figure, charts = chart_grid(len(learners) + 1, "points per step")
    every, others = [], []
    for axes, one in zip(charts, learners):
        own, *others = plot_mean_score(axes, [one, *random], runs, references)
        every.append(own)
    titles = [(end.name, headlines.with_range(end, 2)) for end in every]
    is_long = any(len(": ".join(title)) > _TITLE for title in titles)
    for axes, one, title in zip(charts, learners, titles):
        axes.set_title((":\n" if is_long else ": ").join(title), fontsize=11,
                       color=legible(one.colour))
    is_repeated = most_common_count(contestants, runs) > 1
    failed = headlines.failed_learners(contestants, runs)
    learnt = [one for one in learners if one.label not in failed]
    is_enlarged = len(learnt) > 1
    axes, shown = charts[-1], learnt if is_enlarged else contestants
    if is_enlarged:  # this chart has its own scale
        axes.remove()
        axes = figure.add_subplot(axes.get_subplotspec())
        label_axes(axes, "", "")
    ends = plot_mean_score(axes, shown, runs, references, is_shaded=False)
    if is_enlarged:
        _enlarge_end(axes)
    part = f", last {100 * _END:.0f} % enlarged" if is_enlarged else ""
    axes.set_title(f"{'medians' if is_repeated else 'lines'} of "
                   f"{'all' if shown is contestants or not failed else 'those that learn'}{part}",
                   fontsize=11)
    headline = headlines.highest(contestants, runs, every, "return per step", digits=2)
    explain(figure, headline, " ".join(filter(None, [
        f"Fig. 13: return per step, means of {measures.WINDOW} episodes.",
        describe_shading(contestants, runs),
        f"Titles: last {measures.WINDOW} episodes"
        f"{' (range of runs)' if is_repeated else ''}.",
        headlines.describe_failed(headline), describe_random(contestants)])))
    name_ends(axes, headlines.with_values(
        contestants, [end._replace(low=math.nan) for end in ends], digits=2))
    for end in headlines.with_values(contestants, [one._replace(low=math.nan) for one in others],
                                     digits=2):  # RANDOM and references
        charts[0].annotate(end.name, (charts[0].get_xlim()[1], end.y), xytext=(-2, 3), ha="right",
                           textcoords="offset points", fontsize=9.5, color=legible(end.colour))
    save(figure, path)


def _enlarge_end(axes):
    """Sets the limits of axes to the last part of the lines."""
    last = max(line.get_xdata()[-1] for line in axes.lines if line.get_label()[0] != "_")
    start = (1.0 - _END) * last
    shown = np.concatenate([line.get_ydata()[line.get_xdata() >= start] for line in axes.lines
                            if line.get_label()[0] != "_"] +
                           [line.get_ydata() for line in axes.lines
                            if line.get_label() == "_reference"])
    margin = 0.06 * (shown.max() - shown.min())
    axes.set_xlim(start, last)
    axes.set_ylim(shown.min() - margin, shown.max() + margin)


def plot_mean_score(axes, contestants, runs, references, is_shaded=True):
    """Plots the 50-episode mean return per step: the median of the runs, shaded between their
    lowest and highest value. Returns the ends of the lines.

    references: {name: return per step}, drawn for comparison
    """
    ends = []
    for one in contestants:
        returns = columns_of_runs(runs[one.name], "return")
        steps = columns_of_runs(runs[one.name], "steps")
        window = min(measures.WINDOW, returns.shape[1])
        scores = np.array([measures.return_per_step(*pair, window)
                           for pair in zip(returns, steps)])
        episodes = np.arange(window, returns.shape[1] + 1)
        ends.append(_plot_shaded(axes, episodes, scores, one, is_shaded))
    axes.axhline(0.0, color="black", linewidth=0.5, label="_zero")
    ends += _plot_references(axes, references, max(end.x for end in ends), digits=2)
    axes.margins(x=0.0, y=0.1)
    return ends


def draw_repeated(path, contestants, runs, references):
    """Draws Fig. 14: the 50-episode mean return over all runs. A second chart enlarges the end of
    the training for the learners that learn the task. It is left out if there are fewer than two,
    or if a return in it is not above 0."""
    failed = headlines.failed_learners(contestants, runs)
    learnt = [one for one in headlines.learners_of(contestants) if one.label not in failed]
    plots = [(lambda axes: plot_repeated(axes, contestants, runs, references), "", True)]
    if len(learnt) > 1 and all(_lowest_at_end(runs[one.name]) > 0.0 for one in learnt):
        title = f"Enlarged: the last {100 * _END:.0f} % of the training" + (
            ", medians of the runs" if most_common_count(contestants, runs) > 1 else "")
        plots.append((lambda axes: plot_enlarged(axes, learnt, runs, references), title, False))
    _draw_returns(
        path, contestants,
        lambda ends: headlines.highest(contestants, runs, ends, "return"),
        f"Fig. 14: repeated trainings, means of {measures.WINDOW} episodes. "
        f"{describe_shading(contestants, runs)}", f"{measures.WINDOW}-episode mean return", plots)


def _lowest_at_end(of_one):
    """Returns the lowest value that the enlarged chart shows of a learner: of the median in the
    last part of the training, or of the last value of a run."""
    episodes, means = _repeated(of_one)
    at_end = episodes >= (1.0 - _END) * episodes[-1]
    return min(np.median(means, axis=0)[at_end].min(), means[:, -1].min())


def _repeated(of_one):
    """Returns (episodes, 50-episode mean returns [runs, episodes])."""
    smooth = [moving_means(curve) for curve in columns_of_runs(of_one, "return")]
    return smooth[0][0], np.array([curve for _, curve in smooth])


def plot_repeated(axes, contestants, runs, references, is_enlarged=False):
    """Plots the 50-episode mean return: the median of the runs, shaded between their lowest and
    highest value. Returns the ends of the lines.

    is_enlarged: True draws no shades, and a line for each reference
    """
    ends = [_plot_shaded(axes, *_repeated(runs[one.name]), one, not is_enlarged)
            for one in contestants]
    return ends + _plot_references(axes, references, max(end.x for end in ends),
                                   alike=0.0 if is_enlarged else _ALIKE)


def plot_enlarged(axes, contestants, runs, references):
    """Plots the medians of the last part of Fig. 14. Bars to the right of the lines show the ranges
    of the runs at the end, because shades would cover each other. Returns the ends of the lines in
    the chart; a line with a bar ends there."""
    ends = plot_repeated(axes, contestants, runs, references, is_enlarged=True)
    last = max(end.x for end in ends)
    start, strip = (1.0 - _END) * last, _STRIP * _END * last
    ranges = sorted((end for end in ends if end.low < end.high), key=lambda end: end.y)
    for i, end in enumerate(ranges, start=1):  # the highest is next to the names
        x = last + strip * i / (len(ranges) + 1)
        axes.errorbar(x, end.y, [[end.y - end.low], [end.high - end.y]], color=end.colour, fmt="o",
                      markersize=5, linewidth=2.0, capsize=4.0, capthick=2.0, zorder=5)
        ends[ends.index(end)] = end._replace(x=x)
    right = last + strip if ranges else last
    ends = [end if end.x > last else end._replace(x=right) for end in ends]
    if ranges:
        axes.axvspan(last, right, color="0.95", linewidth=0, zorder=0)
        axes.annotate("range of\nthe runs", (last + strip / 2.0, 0.0), xytext=(0, -19), ha="center",
                      va="top", xycoords=axes.get_xaxis_transform(), textcoords="offset points")
    low = min(_lowest_at_end(runs[one.name]) for one in contestants)
    high = max([*(np.max(line.get_ydata()) for line in axes.lines), *(end.high for end in ranges)])
    margin = 0.06 * (high - low)
    axes.set_xlim(start, right)
    axes.set_ylim(low - margin, high + margin)
    return [end for end in ends if end.y >= low - margin]  # a reference may be below


def _plot_shaded(axes, episodes, values, one, is_shaded=True):
    """Plots the median of values [runs, episodes], shaded between their lowest and highest value
    unless is_shaded is False. Returns the end of the line."""
    low, median, high = np.quantile(values, (0.0, 0.5, 1.0), axis=0)
    if is_shaded and len(values) > 1:
        shade(axes, episodes, low, high, one.colour)
    axes.plot(episodes, median, **line_style(one), label=one.label)
    span = (low[-1], high[-1]) if len(values) > 1 else ()
    return End(episodes[-1], median[-1], one.colour, one.label, *span)
