# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of §4 as PNG from the data of results.py.

Each plot_… function draws on axes; each draw_… function creates a figure with them and saves it.
"""
import json

import matplotlib

matplotlib.use("Agg")  # needs no display
import numpy as np  # noqa: E402
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.patches import Polygon  # noqa: E402
from matplotlib.ticker import Locator, MaxNLocator, NullLocator  # noqa: E402

from aquafarm_benchmark import losses, measures  # noqa: E402

_DIRECTIONS = {"north": (0, 1), "south": (0, -1), "west": (-1, 0), "east": (1, 0),
               "north_west": (-1, 1), "north_east": (1, 1), "south_west": (-1, -1),
               "south_east": (1, -1)}
_DPI = 110
_MOST_PROBED = 40  # max number of disasters drawn along a route


def _rings(disaster):
    """Yields the outlines of a disaster's rings, which may have a radius for each quadrant."""
    bearings = np.radians(np.arange(360.0))
    quadrants = disaster.get("quadrants") or [[radius] * 4 for radius in disaster["radii"]]
    for ring in quadrants:
        radii = np.repeat(ring, 90)  # north-east first, clockwise like bearings
        yield np.column_stack([disaster["x"] + radii * np.sin(bearings),
                               disaster["y"] + radii * np.cos(bearings)])


def _save(figure, path):
    figure.savefig(path, dpi=_DPI, bbox_inches="tight")
    plt.close(figure)


def _axes(title, ylabel, xlabel="episode"):
    figure, axes = plt.subplots(figsize=(8, 4.5))
    _label(axes, title, ylabel, xlabel)
    return figure, axes


def _label(axes, title, ylabel, xlabel="episode"):
    axes.set_title(title)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    axes.grid(alpha=0.3)


def _smooth(values):
    """Returns the episodes and values of the moving mean over the protocol's window."""
    window = min(measures.WINDOW, len(values))
    return np.arange(window, len(values) + 1), measures.moving_mean(values, window)


def _show_returns(axes, curves, optimum=None):
    """Scales the axes to the learnt returns; low returns at the start do not affect the scale."""
    if optimum is not None:
        axes.axhline(optimum, color="black", linestyle="--", label="clairvoyant")
        curves = [*curves, np.array([optimum])]
    top = max(curve.max() for curve in curves)
    low = min(np.quantile(curve, 0.02) for curve in curves)
    _scale_returns(axes)
    axes.set_ylim(low - 0.2 * abs(low), top + 0.5 * abs(top))
    axes.axhline(0.0, color="black", linewidth=0.5)


class _ReturnTicks(Locator):
    """Round returns on both parts of the scale; more of them where few are in view."""
    ROUND = (50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0)

    def __call__(self):
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin, vmax):
        ticks = sorted([0.0, *self.ROUND, *(-value for value in self.ROUND)])
        seen = [tick for tick in ticks if vmin <= tick <= vmax]
        return seen if len(seen) >= 4 else MaxNLocator(5).tick_values(vmin, vmax)


def _scale_returns(axes):
    """A linear scale up to ±100 and a logarithmic one beyond, which the axis states."""
    axes.set_yscale("symlog", linthresh=_LINEAR)
    axes.yaxis.set_major_locator(_ReturnTicks())
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    axes.set_ylabel(f"{axes.get_ylabel()}\n(scale: linear to ±{_LINEAR:.0f}, then logarithmic)")


_LINEAR = 100.0  # returns up to this one have a linear scale
_NAME_GAP = 0.062  # height of a name, as a share of the axes


def spread(places, gap, low=0.0, high=1.0):
    """Returns ascending places moved apart to at least a gap, each as little as possible (least
    squares), within [low, high] if they fit."""
    groups = []  # (mean of the place of the first one, count) of places that touch each other
    for i, place in enumerate(places):
        groups.append((place - i * gap, 1))
        while len(groups) > 1 and groups[-2][0] >= groups[-1][0]:
            (first, n), (second, m) = groups[-2:]
            groups[-2:] = [((n * first + m * second) / (n + m), n + m)]
    moved = [start for start, count in groups for _ in range(count)]
    room = high - gap * (len(places) - 1)
    return [min(max(start, low), max(room, low)) + i * gap for i, start in enumerate(moved)]


def _name_ends(axes, ends):
    """Writes a name next to the end of each line, at the right edge and apart from each other, with
    a line to it that ends before the name.

    ends: (x, y, colour, name) of each line
    """
    axes.margins(x=0.0)
    axes.set_ylim(axes.get_ylim())  # stays as it is
    to_axes = axes.transData + axes.transAxes.inverted()
    ends = sorted(ends, key=lambda end: end[1])
    places = spread([float(to_axes.transform((x, y))[1]) for x, y, _, _ in ends], _NAME_GAP)
    for (x, y, colour, name), place in zip(ends, places):
        axes.annotate(name, (x, y), xytext=(1.05, place), textcoords=axes.transAxes,
                      color=colour, va="center", fontsize=10, annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8,
                                  "relpos": (0.0, 0.5), "shrinkA": 1.0, "shrinkB": 0.0})


def _optimum_end(ends, optimum):
    """The end of the line of the optimum, at the right edge of the others."""
    if optimum is None:
        return []
    return [(max(end[0] for end in ends), optimum, "black", "clairvoyant")]


def _name_beside(axes):
    """A legend to the right of the axes, where it covers no line."""
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=9)


def _runs_text(count):
    return f"{count} {'run' if count == 1 else 'runs'}"


def plot_rewards_by_steps(axes, contestants, runs, optimum):
    """Fig. 12a: 50-episode mean return of the first run by time steps taken so far."""
    curves = []
    for one in contestants:
        curve = runs[one.name][0]["curve"]
        episodes, means = _smooth(curve["return"])
        axes.plot(np.cumsum(curve["steps"])[episodes - 1], means, color=one.colour,
                  label=one.label)
        curves.append(means)
    axes.set_xscale("log")
    _show_returns(axes, curves, optimum)
    _name_beside(axes)


def plot_rewards_by_episodes(axes, contestants, runs, optimum):
    """Return of every episode of the first run, and its 50-episode mean."""
    curves, ends = [], []
    for one in contestants:
        curve = runs[one.name][0]["curve"]["return"]
        axes.plot(np.arange(1, len(curve) + 1), curve, color=one.colour, alpha=0.15, linewidth=0.5)
        episodes, means = _smooth(curve)
        axes.plot(episodes, means, color=one.colour, label=one.label)
        curves.append(curve)
        ends.append((episodes[-1], means[-1], one.colour, one.label))
    _show_returns(axes, curves, optimum)
    _name_ends(axes, ends + _optimum_end(ends, optimum))


def draw_rewards(path, contestants, runs, optimum):
    """Fig. 12a by time steps, above the same data by episodes."""
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(9, 8), layout="constrained")
    _label(upper, "Return by time steps, first run (Fig. 12a)", "50-episode mean return",
           "time steps so far (logarithmic scale)")
    plot_rewards_by_steps(upper, contestants, runs, optimum)
    _label(lower, "Return by episode, first run: each (thin) and 50-episode mean",
           "return of an episode")
    plot_rewards_by_episodes(lower, contestants, runs, optimum)
    _save(figure, path)


def draw_average_rewards(path, contestants, runs):
    """Fig. 12b: mean return of all episodes so far, over all runs."""
    figure, axes = _axes("Mean return of all episodes so far, all runs (Fig. 12b)",
                         "mean return so far")
    plot_average_rewards(axes, contestants, runs)
    _save(figure, path)


def plot_average_rewards(axes, contestants, runs):
    """Mean over the runs of their mean returns of all episodes so far."""
    curves, ends = [], []
    for one in contestants:
        curve = _curves(runs[one.name], "return").mean(axis=0)
        curve = np.cumsum(curve) / np.arange(1, len(curve) + 1)
        axes.plot(np.arange(1, len(curve) + 1), curve, color=one.colour, label=one.label)
        curves.append(curve)
        ends.append((len(curve), curve[-1], one.colour, one.label))
    _show_returns(axes, curves)
    _name_ends(axes, ends)


def draw_square_error(path, contestants, runs):
    """Fig. 12c: mean square error of the learners' value estimates, over all runs."""
    figure, axes = _axes("Mean square error of the value estimates (Fig. 12c)",
                         f"{measures.WINDOW}-episode mean [reward²]\n(logarithmic scale)")
    plot_square_error(axes, contestants, runs)
    axes.text(0.0, -0.17, "Lower: the value of a step agrees better with its reward and the next "
              "value. Thick: median of the runs,\nshaded: their middle half, thin: each run.",
              transform=axes.transAxes, fontsize=9, va="top")
    _save(figure, path)


def plot_square_error(axes, contestants, runs):
    """50-episode means of the squared TD error, without RANDOM: the median of the runs, shaded
    between their quartiles, and each run. Each line ends with its name."""
    ends = []
    for one in contestants:
        errors = _curves(runs[one.name], "loss")
        window = min(measures.WINDOW, errors.shape[1])
        smooth = np.array([measures.known_moving_mean(row, window) for row in errors])
        episodes = np.arange(window, errors.shape[1] + 1)
        smooth = smooth[np.isfinite(smooth).any(axis=1)]  # without runs that had no update
        known = np.isfinite(smooth).all(axis=0) & (smooth > 0.0).all(axis=0)
        if not len(smooth) or not known.any():
            continue
        logs = np.log(smooth[:, known])
        low, median, high = np.exp(np.quantile(logs, (0.25, 0.5, 0.75), axis=0))
        axes.plot(episodes[known], median, color=one.colour, linewidth=2.2, label=one.label)
        if len(smooth) > 1:
            axes.plot(episodes[known], np.exp(logs).T, color=one.colour, linewidth=0.7, alpha=0.45,
                      label="_run")
            axes.fill_between(episodes[known], low, high, color=one.colour, alpha=0.18,
                              linewidth=0)
        ends.append((episodes[known][-1], float(median[-1]), one.colour,
                     f"{one.label}, {_runs_text(len(smooth))}"))
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.6g}")
    if ends:
        _name_ends(axes, ends)


def draw_mean_score(path, contestants, runs):
    """Fig. 13: mean return per step by episode: (a) LSTM-DQN, (b) SARSA, (c) all learners."""
    panels = [("a", [one for one in contestants if one.algorithm_name == "lstm_dqn"]),
              ("b", [one for one in contestants if one.algorithm_name == "sarsa"])]
    panels = [(letter, panel) for letter, panel in panels if panel]
    figure = plt.figure(figsize=(9, 8 if panels else 4.5), layout="constrained")
    places = [[letter for letter, _ in panels], ["c"] * len(panels)] if panels else [["c"]]
    all_axes = figure.subplot_mosaic(places, height_ratios=[3, 4] if panels else None)
    for letter, panel in [*panels, ("c", contestants)]:
        _label(all_axes[letter], f"Return per step (Fig. 13{letter})",
               f"{measures.WINDOW}-episode mean ± std. deviation")
        plot_mean_score(all_axes[letter], panel, runs)
    _save(figure, path)


def plot_mean_score(axes, contestants, runs):
    """50-episode mean return per step, mean over the runs, shaded by a standard deviation."""
    ends = []
    for one in contestants:
        returns, steps = _curves(runs[one.name], "return"), _curves(runs[one.name], "steps")
        window = min(measures.WINDOW, returns.shape[1])
        scores = np.array([measures.return_per_step(*pair, window)
                           for pair in zip(returns, steps)])
        episodes = np.arange(window, returns.shape[1] + 1)
        _plot_shaded(axes, episodes, scores, one, one.label)
        ends.append((episodes[-1], scores.mean(axis=0)[-1], one.colour, one.label))
    axes.axhline(0.0, color="black", linewidth=0.5)
    _name_ends(axes, ends)


def draw_evaluation(path, contestants, rows):
    """Mean return of greedy episodes not used for training, with its 95 % interval."""
    figure, axes = _axes("Return on episodes never trained on", "return of an episode", "")
    plot_evaluation(axes, contestants, rows)
    _save(figure, path)


def plot_evaluation(axes, contestants, rows):
    """One bar per row: the interquartile mean of the runs and its interval."""
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
    _scale_returns(axes)
    axes.margins(y=0.15)
    axes.set_xticks(range(len(contestants)), [one.label for one in contestants], rotation=15)


def draw_losses(path, contestants, rows):
    """Exceedance curves of the losses, next to the mean loss by kind of device."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 4.5), layout="constrained")
    unit = next(row["money"]["currency"] for row in rows if row["money"])
    _label(left, "Exceedance of losses", "probability of a larger loss", f"loss x [{unit}]")
    plot_exceedance(left, contestants, rows)
    _label(right, "Mean loss by kind of device", f"loss per episode [{unit}]", "")
    plot_loss_by_kind(right, contestants, rows)
    _save(figure, path)


def _with_money(contestants, rows):
    by_name = {row["name"]: row["money"] for row in rows}
    return [(one, by_name[one.name]) for one in contestants if by_name.get(one.name)]


def plot_exceedance(axes, contestants, rows):
    """P(loss > x) by x, a step curve from probability 1 at 0, with CVaR as a mark at 5 %."""
    for one, money in _with_money(contestants, rows):
        x, probability = money["exceedance"]
        axes.step([0.0, *x], [1.0 if x[0] > 0.0 else probability[0], *probability], where="post",
                  color=one.colour, label=one.label)
        axes.plot(money["cvar"], losses.TAIL, marker="v", color=one.colour)
    axes.axhline(losses.TAIL, color="black", linewidth=0.5, linestyle="--")
    axes.set_ylim(-0.02, 1.02)
    axes.legend(loc="best")


def plot_loss_by_kind(axes, contestants, rows):
    """One group of bars per kind: damaged, and lost on top of it, a bar for each contestant."""
    shown = _with_money(contestants, rows)
    kinds = sorted({kind for _, money in shown for kind in money["by_kind"]})
    width = 0.8 / max(1, len(shown))
    for place, (one, money) in enumerate(shown):
        x = np.arange(len(kinds)) + width * (place - (len(shown) - 1) / 2.0)
        parts = {part: np.array([money["by_kind"].get(kind, {}).get(part, 0.0) for kind in kinds])
                 for part in ("damaged", "lost")}
        axes.bar(x, parts["damaged"], width, color=one.colour, label=one.label)
        axes.bar(x, parts["lost"], width, bottom=parts["damaged"], color=one.colour, alpha=0.5)
    axes.set_xticks(range(len(kinds)), [kind.replace("_", " ") for kind in kinds], rotation=15)
    tallest = max((bar.get_y() + bar.get_height() for bar in axes.patches), default=0.0)
    axes.set_ylim(0.0, 1.08 * tallest or 1.0)
    axes.legend(loc="best", title="dark: damaged, light: lost")


def draw_repeated(path, contestants, runs, optimum):
    """Fig. 14: 50-episode means over all runs, shaded by ± one standard deviation."""
    figure, axes = _axes("Repeated trainings (Fig. 14): mean and standard deviation",
                         "50-episode mean return")
    plot_repeated(axes, contestants, runs, optimum)
    _save(figure, path)


def plot_repeated(axes, contestants, runs, optimum):
    """Mean over the runs of their 50-episode means, shaded by ± one standard deviation."""
    curves, ends = [], []
    for one in contestants:
        smooth = [_smooth(curve) for curve in _curves(runs[one.name], "return")]
        values = np.array([curve for _, curve in smooth])
        name = f"{one.label}, {_runs_text(len(values))}"
        _plot_shaded(axes, smooth[0][0], values, one, name)
        curves.append(values.mean(axis=0))
        ends.append((smooth[0][0][-1], curves[-1][-1], one.colour, name))
    _show_returns(axes, curves, optimum)
    _name_ends(axes, ends + _optimum_end(ends, optimum))


def _plot_shaded(axes, episodes, values, one, label):
    """Plots the mean of values [runs, episodes], shaded by ± one standard deviation."""
    mean, spread = values.mean(axis=0), values.std(axis=0)
    axes.plot(episodes, mean, color=one.colour, label=label)
    axes.fill_between(episodes, mean - spread, mean + spread, color=one.colour, alpha=0.2,
                      linewidth=0)


def draw_route(path, label, route_file):
    """Fig. 11: the greedy action at each cell as arrows, before and after the first pickup, and the
    route coloured by time."""
    route = json.loads(route_file.read_text())
    panels = [("best_moves_at_start", "with nothing aboard"),
              ("best_moves_after_pickup", "with a device aboard")]
    panels = [panel for panel in panels if route[panel[0]]]
    rows = 2 if panels else 1
    figure, all_axes = plt.subplots(rows, 2, figsize=(10.5, 5.4 * rows), squeeze=False,
                                    layout="constrained")
    all_axes = list(all_axes.flat)
    for axes, (key, words) in zip(all_axes, panels):
        _chart(axes, route["chart"])
        _arrows(axes, route[key])
        axes.set_title(f"{label}: best move, {words}")
    axes = all_axes[len(panels)]
    for empty in all_axes[len(panels) + 1:]:
        empty.axis("off")
    _chart(axes, route["chart"])
    _explain_route(all_axes[-1], axes, bool(panels))
    _disasters(axes, route["steps"])
    cells = np.array([step["cell"] for step in route["steps"]])
    rng = np.random.Generator(np.random.PCG64(1))  # separates repeated visits of a cell
    shown = cells + rng.uniform(-0.18, 0.18, cells.shape)
    axes.plot(shown[:, 0], shown[:, 1], color="black", linewidth=0.6, alpha=0.6, zorder=4)
    points = axes.scatter(shown[:, 0], shown[:, 1], c=np.arange(len(shown)), cmap="plasma", s=26,
                          zorder=5)
    figure.colorbar(points, ax=axes, label="step", shrink=0.75)
    axes.set_title(f"its route: {route['reason'].replace('_', ' ')}, return {route['return']:.1f}")
    _save(figure, path)


def _curves(of_one, column):
    """Returns [runs, episodes] with the length of the shortest run; lengths may differ slightly."""
    length = min(len(run["curve"][column]) for run in of_one)
    return np.array([run["curve"][column][:length] for run in of_one])


def _chart(axes, chart):
    axes.set_aspect("equal")
    axes.set_xlim(-0.5, chart["width"] - 0.5)
    axes.set_ylim(-0.5, chart["height"] - 0.5)
    axes.set_facecolor("#dcecf5")
    size = 4200.0 / max(chart["width"], chart["height"])
    for cells, colour, marker, label in (
            (chart["islands"], "#8d7b4a", "s", "island"), (chart["rocks"], "#555555", "o", "rock"),
            (chart["ports"], "#1a7f37", "P", "port"),
            ([device["cell"] for device in chart["devices"]], "#c2185b", "D", "device")):
        if cells:
            x, y = zip(*cells)
            axes.scatter(x, y, color=colour, marker=marker, label=label, zorder=3,
                         s=size * (1.0 if marker == "s" else 0.5))


def _explain_route(empty, chart, has_moves):
    """Explains the symbols of the other axes on empty ones."""
    empty.legend(*chart.get_legend_handles_labels(), loc="upper left", frameon=False, fontsize=11,
                 bbox_to_anchor=(0.05, 0.95), labelspacing=0.9)
    lines = ["axes: cells, east and north", "", "route: dots from violet (start) to yellow (end)",
             "red ×: centre of a disaster at the start", "red circles: its rings in each step"]
    if has_moves:
        lines = ["arrow: the move that the policy prefers in a cell",
                 "+ pickup, × drop-off", "", *lines]
    empty.text(0.05, 0.55, "\n".join(lines), transform=empty.transAxes, va="top", fontsize=11,
               linespacing=1.4)


def _arrows(axes, moves):
    pointed = [(x, y, *_DIRECTIONS[action]) for x, y, action in moves if action in _DIRECTIONS]
    if pointed:
        x, y, dx, dy = np.array(pointed, dtype=float).T
        length = np.hypot(dx, dy)
        axes.quiver(x, y, dx / length, dy / length, pivot="mid", scale=32, width=0.004, zorder=4)
    for letter, action in (("+", "pickup"), ("×", "drop_off")):
        for x, y, chosen in moves:
            if chosen == action:
                axes.text(x, y, letter, ha="center", va="center", weight="bold", zorder=6)


def _disasters(axes, steps):
    every = max(1, len(steps) // _MOST_PROBED)
    for step in steps[::every]:
        for disaster in step["disasters"]:
            for ring in _rings(disaster):
                axes.add_patch(Polygon(ring, fill=False, color="#b22222", alpha=0.1, zorder=2))
    for disaster in steps[0]["disasters"]:
        axes.plot(disaster["x"], disaster["y"], marker="x", color="#b22222", zorder=4)
