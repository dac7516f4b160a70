# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of the paper's §4 as PNG from the data of results.py.

Each function draw_… creates a figure and saves it. The functions plot_… draw on given axes.
"""
import math

import numpy as np
from matplotlib import ticker

from aquafarm_benchmark import measures
from aquafarm_benchmark.curves import (End, columns_of_runs, describe_random, describe_shading,
                                       most_common_count, moving_means)
from aquafarm_benchmark.protocol import PRINTED
from aquafarm_benchmark.style import (chart_grid, explain, joined, label_axes, legible, line_style,
                                      name_ends, number, plt, save, shade)

_NBSP = "\N{NO-BREAK SPACE}"
_REACHED = 0.9  # a learner has learnt once it reaches this fraction of the best reference


def _learners(contestants):
    """Returns the contestants except RANDOM."""
    return [one for one in contestants if not one.name.startswith("random")]


def _highest(contestants, ends, what, digits=0):
    """Returns the headline of a chart, such as "DQN has the highest return: 271". Compares the last
    values of the lines, rounded to `digits`, without RANDOM. With ranges, the headline states
    whether the runs of other learners reach the lowest run of the first. If all labels end with
    PRINTED, it begins with "With the settings as printed" instead of repeating PRINTED."""
    learners = {one.label for one in _learners(contestants)}
    last = sorted((end for end in ends if end.name in learners), key=lambda end: (-end.y, end.name))
    if not last:
        return what.capitalize()
    value = number(last[0].y, digits)
    names = [end.name for end in last if number(end.y, digits) == value]
    others = last[len(names):]
    said = f"{last[0].name}: {what} {value}" if len(last) == 1 else (
        f"{joined(names)} {'has' if len(names) == 1 else 'have'} the highest {what}: {value}")
    if others and len(names) == 1 and not math.isnan(last[0].low):
        near = [end.name for end in others  # a line of one run has no range
                if (end.y if math.isnan(end.high) else end.high) >= last[0].low]
        said += (f"; its runs are not all above those of {joined(near)}" if near else
                 "; each of its runs is above all runs of the others")
    if all(end.name.endswith(PRINTED) for end in last):
        return f"With the settings as printed, {said.replace(PRINTED, '')}"
    return said


def _with_values(contestants, ends, digits=0):
    """Returns the ends of lines. Appends the last values to the names of contestants, and the range
    of the runs of learners: "DQN 271 (268 to 273)"."""
    labels = {one.label for one in contestants}
    learners = {one.label for one in _learners(contestants)}
    values = [_with_range(end, digits) if end.name in learners else number(end.y, digits)
              for end in ends]
    return [end._replace(name=f"{end.name}{_NBSP}{value}") if end.name in labels else end
            for end, value in zip(ends, values)]


def _with_range(end, digits=0):
    """Returns the value at the end of a line as text, with the range of the runs in brackets."""
    value, low, high = (number(one, digits) for one in (end.y, end.low, end.high))
    return value if math.isnan(end.low) or low == high else f"{value} ({low} to {high})"


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


def _draw_returns(path, contestants, find, note, ylabel, plots, xlabel="episode"):
    """Draws charts of returns, one below the other, on the scale of _scale_returns. Names the lines
    whose ends the functions in `plots` return.

    find: function that returns the headline, given the ends of the lines of the first chart
    note: how the data were computed
    plots: for each chart, from top to bottom: (function, title, has_values). The function plots on
        axes and returns the ends of the lines without a name, for name_ends; has_values: names are
        followed by the last values
    """
    heights = (4.4, 2.9)[:len(plots)]
    figure, rows = plt.subplots(len(plots), 1, figsize=(8.7, 0.6 + sum(heights)), squeeze=False,
                                height_ratios=heights, layout="constrained")
    charts = [(axes, plot(axes), title, has_values)
              for (plot, title, has_values), axes in zip(plots, rows[:, 0])]
    explain(figure, find(charts[0][1]), f"{note} {describe_random(contestants)}")
    for axes, ends, title, has_values in charts:
        label_axes(axes, title, ylabel + _scale_returns(axes), xlabel)
        axes.yaxis.set_major_formatter(lambda value, _: number(value))
        name_ends(axes, _with_values(contestants, ends) if has_values else ends)
    save(figure, path)


_LOGARITHMIC = "#eef1f4"  # background of the logarithmic part of a scale
_ENLARGED = 0.7  # the lower chart of Fig. 14 begins at this fraction of the best reference
_LETTER = 0.013  # mean width of a letter of a name [widths of the axes]
_ALIKE = 0.02  # references share one line if their relative difference is below this


def _plot_references(axes, references, end, digits=0):
    """Draws horizontal lines for reference values {name: value}. Similar values share one line, see
    _ALIKE. Returns the ends of the lines."""
    ends = []
    for name, value in sorted(references.items(), key=lambda pair: -pair[1]):
        words = f"{name} {value:.{digits}f}"
        if ends and ends[-1].y - value < _ALIKE * abs(value):
            ends[-1] = ends[-1]._replace(name=f"{ends[-1].name}, {words}")
            continue
        axes.axhline(value, color="black", linestyle="--", linewidth=1.2, label="_reference")
        ends.append(End(end, value, "black", words))
    return ends


def _plot_one_run(axes, one, curve, **style):
    """Plots the 50-episode mean return of a run by time steps. Returns the end of the line."""
    episodes, means = moving_means(curve["return"])
    steps = np.cumsum(curve["steps"])[episodes - 1]
    axes.plot(steps, means, **{**line_style(one), "label": one.label, "linewidth": 1.5, **style})
    return End(steps[-1], means[-1], one.colour, one.label)


def _target(references):
    """Returns the return to which the headline of Fig. 12a refers: _REACHED of the best reference,
    or infinity if there is no positive reference."""
    best = max(references.values(), default=0.0)
    return _REACHED * best if best > 0.0 else math.inf


def _mark_reached(axes, references):
    """Draws a dotted line at the value of _target. Returns the end of the line in a list, or an
    empty list if the value is infinite."""
    target = _target(references)
    if target == math.inf:
        return []
    axes.axhline(target, color="black", linestyle=":", linewidth=1.2, label="_reached")
    return [End(axes.get_xlim()[1], target, "black",
                f"{100 * _REACHED:.0f} % of {target / _REACHED:.0f}")]


def _name_reached(axes, ends, target, steps_of):
    """Marks the numbers of steps at which learners reach the return `target`: a large dot for the
    median, small dots for the runs. Writes the medians, the ranges of the runs and the names of the
    learners above the axes, in several rows if they are close. Returns the ends of all other lines.

    steps_of: {name of a line: numbers of steps of the runs}
    """
    last = axes.get_xlim()[1]
    for end in ends:
        shown = [steps for steps in steps_of[end.name] if steps <= last]
        if shown:
            axes.plot(shown, [target] * len(shown), "o", color=end.colour, markersize=3, zorder=5,
                      label="_reached")
    others = [end for end in ends if np.median(steps_of[end.name]) > last]
    reached = [(np.median(steps_of[end.name]), end.colour, end.name) for end in ends
               if end not in others]
    to_axes = axes.transData + axes.transAxes.inverted()
    row_ends = [-np.inf] * len(reached)  # where the last names of the rows end [widths of the axes]
    for steps, colour, name in sorted(reached):
        words = f"{name} {_rounded_steps(steps)}"
        of_runs = sorted(steps_of[name])
        if of_runs[-1] == math.inf:
            words += f" (from {_rounded_steps(of_runs[0])}, {_in_some(of_runs)})"
        elif of_runs[0] < of_runs[-1]:
            words += f" ({_rounded_steps(of_runs[0])} to {_rounded_steps(of_runs[-1])})"
        place = float(to_axes.transform((steps, target))[0])
        # A name also leaves space for the leaders of the names above it.
        row = next(i for i in range(len(row_ends))
                   if place - _LETTER * len(words) > max(row_ends[i:]))
        row_ends[row] = place
        axes.plot(steps, target, "o", color=colour, markersize=7, markeredgecolor="white", zorder=6,
                  label="_reached")
        axes.annotate(words, (steps, target), xytext=(place, 1.025 + 0.05 * row),
                      textcoords=axes.transAxes, ha="right", va="bottom", color=legible(colour),
                      fontsize=10, annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8,
                                  "relpos": (1.0, 0.0), "shrinkA": 0.0, "shrinkB": 2.0})
    return others


def plot_rewards_by_steps(axes, contestants, runs, references):
    """Plots Fig. 12a: the 50-episode mean return by time steps taken so far. The line of the run
    nearest to the median is thick, see _nearest_to_median. Returns the ends of the lines that have
    no name yet."""
    target = _target(references)
    steps_of = {one.label: _steps_until(runs[one.name], target) for one in contestants}
    main = {one.name: _nearest_to_median(steps_of[one.label]) for one in contestants}
    ends = [_plot_one_run(axes, one, runs[one.name][main[one.name]]["curve"])
            for one in contestants]
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(lambda value, _: _steps_text(value))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())
    thin = [_plot_one_run(axes, one, run["curve"], label="_run", linewidth=0.8, alpha=0.5)
            for one in _learners(contestants)
            for i, run in enumerate(runs[one.name]) if i != main[one.name]]
    # RANDOM takes the most steps. The chart ends where the last run of a learner ends.
    learners = {one.label for one in _learners(contestants)}
    last = max((end.x for end in ends + thin if end.name in learners), default=np.inf)
    ends = [end for end in (_cut(axes, end, last) for end in ends) if end]
    axes.relim()
    axes.margins(x=0.0)
    axes.autoscale_view()
    reference = _mark_reached(axes, references)
    ends = _name_reached(axes, ends, target, steps_of)
    return ends + reference + _plot_references(axes, references, axes.get_xlim()[1])


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


def _steps_text(value):
    """Returns a number of steps as text: "200k", "1M"."""
    return f"{value / 1e6:g}M" if value >= 1e6 else f"{value / 1e3:g}k" if value >= 1e3 else f"{value:g}"


def _rounded_steps(value):
    """Returns a number of steps with two digits as text."""
    return _steps_text(float(f"{value:.2g}"))


def _in_some(steps):
    """Returns a text such as "in 3 of 4 runs", given the result of _steps_until."""
    return f"in {np.isfinite(steps).sum()} of {len(steps)} runs"


def draw_rewards(path, contestants, runs, references):
    """Draws Fig. 12a."""
    count = most_common_count(contestants, runs)
    has_target = _target(references) < math.inf
    shown = ("one run of each learner" if count == 1 else f"{count} runs of each learner; thick: "
             + (f"the run whose time to {100 * _REACHED:.0f} % is nearest to the median"
                if has_target else "the first"))
    dots = (f"Dots: {100 * _REACHED:.0f} % is reached for the first time"
            f"{' (large: median; above: its value and the range)' if count > 1 else ''}. ")
    _draw_returns(
        path, contestants, lambda ends: _learning_times(contestants, runs, references) or
        _highest(contestants, ends, "return at the end of the training"),
        f"Fig. 12a: {shown}. Means of {measures.WINDOW} episodes: a line begins after episode "
        f"{measures.WINDOW}. {dots if has_target else ''}The chart ends with the last run of a "
        "learner; RANDOM takes more steps.",
        f"{measures.WINDOW}-episode mean return",
        [(lambda axes: plot_rewards_by_steps(axes, contestants, runs, references), "", False)],
        "time steps so far (logarithmic)")


def _steps_until(of_one, target):
    """Returns the number of steps after which the 50-episode mean return first reaches `target`,
    for each run. Infinity if it never does."""
    found = []
    for curve in (run["curve"] for run in of_one):
        episodes, means = moving_means(curve["return"])
        reached = episodes[means >= target]
        found.append(np.cumsum(curve["steps"])[reached[0] - 1] if len(reached) else math.inf)
    return found


def _nearest_to_median(values):
    """Returns the index of the value that is nearest to the median. All infinite values are
    equally near to an infinite median."""
    median = np.median(values)
    return min(range(len(values)),
               key=lambda i: 0.0 if values[i] == median else abs(values[i] - median))


def _learning_times(contestants, runs, references):
    """Returns the headline of Fig. 12a: after how many steps each learner reaches _REACHED of the
    best reference, in the median of its runs. "" if there is no positive reference."""
    target = _target(references)
    if target == math.inf:
        return ""
    steps_of = {one.label: _steps_until(runs[one.name], target) for one in _learners(contestants)}
    found = sorted((float(np.median(steps)), name) for name, steps in steps_of.items())
    texts = [f"{name}{_NBSP}{float(f'{steps:.2g}'):,.0f}" for steps, name in found
             if steps < math.inf]
    texts += [f"{name} only {_in_some(steps_of[name])}" for steps, name in found
              if min(steps_of[name]) < steps == math.inf]
    late = [name for _, name in found if min(steps_of[name]) == math.inf]
    if late:
        texts.append(f"{joined(late)} {_not_within(contestants, runs)}")
    count = most_common_count(contestants, runs)
    return (f"Time steps to {100 * _REACHED:.0f} % of the return of the "
            f"{max(references, key=references.get)}"
            f"{f' (median of {count} runs)' if count > 1 else ''}: {', '.join(texts)}")


def _not_within(contestants, runs):
    """Returns a text such as "not within 2,000 episodes", with the length of the longest run."""
    longest = max(len(run["curve"]["return"]) for one in contestants for run in runs[one.name])
    return f"not within {longest:,} episodes"


def draw_average_rewards(path, contestants, runs, references):
    """Draws Fig. 12b: the mean return of all episodes so far, over all runs."""
    has_dots = any(1 < _recovery(runs[one.name]) < math.inf for one in contestants)
    _draw_returns(
        path, contestants, lambda ends: _recovery_times(contestants, runs) or
        _highest(contestants, ends, "mean return of all episodes"),
        "Fig. 12b: mean return of all episodes so far; bad early episodes count to the end. "
        f"{'Dots: the median rises above 0. ' if has_dots else ''}"
        f"{describe_shading(contestants, runs)}", "mean return so far",
        [(lambda axes: plot_average_rewards(axes, contestants, runs, references), "", True)])


def _means_so_far(of_one):
    """Returns the mean return of all episodes so far, [runs, episodes]."""
    curves = columns_of_runs(of_one, "return")
    return np.cumsum(curves, axis=1) / np.arange(1, curves.shape[1] + 1)


def _recovery(of_one):
    """Returns the first episode at which the mean return so far is above 0, in the median of the
    runs. Infinity if this does not happen."""
    is_above = np.median(_means_so_far(of_one), axis=0) > 0.0
    return int(np.argmax(is_above)) + 1 if is_above.any() else math.inf


def _recovery_times(contestants, runs):
    """Returns the headline of Fig. 12b: the first episode at which the mean return so far is above
    0, in the median of the runs. "" if this is the first episode or does not happen."""
    found = [(_recovery(runs[one.name]), one.label) for one in _learners(contestants)]
    known = [f"{episode:,} ({name})" for episode, name in sorted(found) if episode < math.inf]
    never = [name for episode, name in found if episode == math.inf]
    if not known or min(found)[0] == 1:
        return ""
    return (f"The mean return of all episodes so far rises above 0 at episode {joined(known)}"
            f"{f'; {joined(never)}: {_not_within(contestants, runs)}' if never else ''}")


def plot_average_rewards(axes, contestants, runs, references):
    """Plots the mean return of all episodes so far: the median of the runs, shaded between their
    lowest and highest value. Returns the ends of the lines."""
    ends = []
    for one in contestants:
        means = _means_so_far(runs[one.name])
        ends.append(_plot_shaded(axes, np.arange(1, means.shape[1] + 1), means, one))
        if 1 < _recovery(runs[one.name]) < math.inf:
            axes.plot(_recovery(runs[one.name]), 0.0, "o", color=one.colour, markersize=6,
                      markeredgecolor="white", zorder=5, label="_recovery")
    return ends + _plot_references(axes, references, max(end.x for end in ends))


def draw_mean_score(path, contestants, runs, references):
    """Draws Fig. 13: the mean return per step by episode: a chart for each learner with the range
    of its runs, first (a) LSTM-DQN and (b) SARSA, and (c) the medians of all contestants. If
    several contestants have the algorithm of (a) or (b), the one with its name is shown there, or
    the first.

    references: {name: return per step}, drawn for comparison
    """
    panels = []
    for letter, algorithm in (("a", "lstm_dqn"), ("b", "sarsa")):
        rows = [one for one in contestants if one.algorithm_name == algorithm]
        rows.sort(key=lambda one: one.name != algorithm)
        panels += [(f"Fig. 13{letter}: ", one) for one in rows[:1]]
    lettered = [one for _, one in panels]
    panels += [("", one) for one in _learners(contestants) if one not in lettered]
    figure, charts = chart_grid(len(panels) + 1)
    for axes in charts:
        label_axes(axes, "", "return per step" if axes.get_subplotspec().is_first_col() else "")
    every = []
    for axes, (letter, one) in zip(charts, panels):
        every += [end for end in plot_mean_score(axes, [one], runs, references)
                  if end.name == one.label]
        axes.set_title(f"{letter}{one.label}\n{_with_range(every[-1], 2)} at the end", fontsize=11,
                       color=legible(one.colour))
    axes = charts[-1]
    axes.set_title("Fig. 13c: all medians" if most_common_count(contestants, runs) > 1 else
                   "Fig. 13c: all", fontsize=11)
    ends = plot_mean_score(axes, contestants, runs, references, is_shaded=False)
    explain(figure, _highest(contestants, every, "return per step at the end", digits=2),
            f"Fig. 13: means of {measures.WINDOW} episodes. {describe_shading(contestants, runs)} "
            f"{f'Dashed: {joined(list(references))}. ' if references else ''}"
            f"{describe_random(contestants)}")
    others = [one for one in contestants if one not in _learners(contestants)]
    name_ends(axes, _with_values(others, ends, digits=2))
    save(figure, path)


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
    """Draws Fig. 14: the 50-episode mean return over all runs. A second chart enlarges the returns
    above _ENLARGED of the best reference in the second half of the training. It shows the learners
    whose median is there at least half of the time. If there are none, it is left out."""
    best = max(references, key=references.get, default=None)
    level = _ENLARGED * references[best] if best else 0.0
    plots = [(lambda axes: plot_repeated(axes, contestants, runs, references), "", True)]
    high = [one for one in contestants if _is_mostly_above(runs[one.name], level)]
    if level > 0.0 and high:
        title = f"Enlarged: second half, above {100 * _ENLARGED:.0f} % of the {best}"
        low = [one.label for one in _learners(contestants) if one not in high]
        if low:
            title += f" ({joined(low)} {'is' if len(low) == 1 else 'are'} mostly below)"
        plots.append((lambda axes: plot_enlarged(axes, high, runs, references, level), title,
                      False))
    _draw_returns(
        path, contestants,
        lambda ends: _highest(contestants, ends, "return at the end of the training"),
        f"Fig. 14: repeated trainings, means of {measures.WINDOW} episodes. "
        f"{describe_shading(contestants, runs)}", f"{measures.WINDOW}-episode mean return", plots)


def _is_mostly_above(of_one, level):
    """Returns whether the median of the runs is above a level at least half of the time, in the
    second half of the training."""
    median = np.median(_repeated(of_one)[1], axis=0)
    return np.mean(median[len(median) // 2:] > level) >= 0.5


def _repeated(of_one):
    """Returns (episodes, 50-episode mean returns [runs, episodes])."""
    smooth = [moving_means(curve) for curve in columns_of_runs(of_one, "return")]
    return smooth[0][0], np.array([curve for _, curve in smooth])


def plot_repeated(axes, contestants, runs, references):
    """Plots the 50-episode mean return: the median of the runs, shaded between their lowest and
    highest value. Returns the ends of the lines."""
    ends = [_plot_shaded(axes, *_repeated(runs[one.name]), one) for one in contestants]
    return ends + _plot_references(axes, references, max(end.x for end in ends))


def plot_enlarged(axes, contestants, runs, references, level):
    """Plots the second half of Fig. 14, from the return `level` to the best reference. Returns the
    ends of the lines that are in the chart."""
    ends = plot_repeated(axes, contestants, runs, references)
    best, last = max(references.values()), max(end.x for end in ends)
    axes.set_xlim(last / 2, last)
    axes.set_ylim(level, best + 0.06 * (best - level))
    return [end for end in ends if level <= end.y]


def _plot_shaded(axes, episodes, values, one, is_shaded=True):
    """Plots the median of values [runs, episodes], shaded between their lowest and highest value
    unless is_shaded is False. Returns the end of the line."""
    low, median, high = np.quantile(values, (0.0, 0.5, 1.0), axis=0)
    if is_shaded and len(values) > 1:
        shade(axes, episodes, low, high, one.colour)
    axes.plot(episodes, median, **line_style(one), label=one.label)
    span = (low[-1], high[-1]) if len(values) > 1 else ()
    return End(episodes[-1], median[-1], one.colour, one.label, *span)
