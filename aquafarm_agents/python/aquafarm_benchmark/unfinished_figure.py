# SPDX-License-Identifier: BSD-3-Clause
"""Draws route files of episodes that ended with devices at sea as PNG: their last legs, grouped by
the cause of the failure."""
import collections
import json

import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.legend_handler import HandlerTuple
from matplotlib.patches import Polygon, Rectangle

from aquafarm_benchmark.route_figure import (LEGS, RING, covering_rings, draw_chart, legs, rings_of,
                                               symbols_of)
from aquafarm_benchmark.style import plt, save

# Causes of a failure, with the words of the headline and the heading of the group. "{goal}" stands
# for the nearest device or port.
_CAUSES = {
    "time": ("time runs out", "Time runs out: the moves to the nearest {goal} and a pickup or "
             "drop-off need more steps than are left"),
    "ring": ("the ship waits before a ring", "The ship waits before a ring: the steps left could "
             "be enough, but a ring covers a device that was not fetched"),
    "other": ("another cause", "Another cause: the steps left could be enough, and no ring covers a "
              "device that was not fetched")}
_COLUMNS = 3  # max number of maps in a row
_WIDTH, _HEIGHT = 12.0, 3.0  # width of the figure, height of a map [inch]
# Heights of the headline, a heading, the titles of a map, its labels, and the legend [inch].
_HEADLINE, _HEADING, _TITLES, _LABELS, _KEY = 0.45, 0.25, 0.5, 0.6, 0.95
_SIDE = 0.6  # space to the left of a map, for its labels [inch]
_MARGIN = 3  # min number of cells around the last leg that the map of an episode shows
# Min number of visits of a cell on the last leg, with the colour and label of the cell.
_VISITS = {2: ("#c6dbef", "cell with 2 to 4 visits"), 5: ("#6baed6", "cell with 5 or more visits")}
_LEFT = "device that was not fetched"
_LAST_RING = "ring of a disaster in the last step"
# Steps before the end whose rings are drawn, and their line style and label.
_BEFORE = {120: (":", "ring over a device left, 120 steps before"),
           60: ("--", "ring over a device left, 60 steps before")}


def devices_left(route):
    """Returns the cells [x, y] of the devices that the ship of the route did not fetch."""
    fetched = [before["cell"] for before, after in zip(route["steps"], route["steps"][1:])
               if after["aboard"] > before["aboard"]]
    return [device["cell"] for device in route["chart"]["devices"]
            if device["cell"] not in fetched]


def _goals(route):
    """Returns the cells of the devices that the ship did not fetch, or of the ports if it fetched
    all devices: then one is still aboard."""
    return devices_left(route) or route["chart"]["ports"]


def draw_unfinished(path, routes, ranches, shown):
    """Draws the last legs of episodes that ended with devices at sea, and the rings of disasters in
    the last step and before. The headline counts the causes of all failures and the maps. The maps
    are grouped by cause.

    routes: {name of the ranch: route file} of all failures
    ranches: number of ranches that were played
    shown: max number of maps; the failures with the lowest returns have one
    """
    found = {name: json.loads(file.read_text()) for name, file in routes.items()}
    worst = sorted(found, key=lambda name: found[name]["return"])[:shown]
    groups = group_by_cause({name: found[name] for name in worst})
    rows = [(cause if i == 0 else "", group[i:i + _COLUMNS]) for cause, group in groups.items()
            for i in range(0, len(group), _COLUMNS)]
    height = _HEADLINE + _KEY + sum(_row_height(heading) for heading, _ in rows)
    figure = plt.figure(figsize=(_WIDTH, height))
    figure.suptitle(f"{len(found):,} failure{'' if len(found) == 1 else 's'} in {ranches:,} ranches: "
                    f"{describe_failures(group_by_cause(found))}" +
                    (f" ({len(worst)} of the {len(found):,} shown)" if len(worst) < len(found)
                     else ""), fontsize=13.5, weight="bold", x=0.01, y=1.0 - 0.1 / height,
                    ha="left", va="top")
    charts, top = [], height - _HEADLINE
    for cause, group in rows:
        if cause:
            figure.text(0.01, (top - 0.05) / height, _heading(cause, groups[cause]), fontsize=12,
                        weight="bold", va="top")
        top -= _row_height(cause)
        column = _WIDTH / len(group)
        for i, (name, route) in enumerate(group):
            width = column - _SIDE - 0.15
            axes = figure.add_axes(((i * column + _SIDE) / _WIDTH, (top + _LABELS) / height,
                                    width / _WIDTH, _HEIGHT / height))
            plot_unfinished(axes, name, route, width / _HEIGHT)
            charts.append(axes)
    _draw_key(figure, charts, "" if len(worst) == len(found) else
              "The map shows the failure with the lowest return. " if len(worst) == 1 else
              f"The maps show the {len(worst)} failures with the lowest returns. ")
    save(figure, path)


def _heading(cause, group):
    """Returns the heading of a group of maps. group: [(name, route)]"""
    has_left = {bool(devices_left(route)) for _, route in group}
    return _CAUSES[cause][1].format(goal={
        (True,): "device left", (False,): "port",
        (False, True): "device left (or port, if no device is left)"}[tuple(sorted(has_left))])


def _row_height(heading):
    return (_HEADING if heading else 0.0) + _TITLES + _HEIGHT + _LABELS


def _draw_key(figure, charts, note):
    """Draws the legend of all maps below them, with a note above it."""
    symbols = symbols_of(charts)
    diamonds = [one for axes in charts for one in axes.collections if one.get_label() == "_device"]
    if diamonds:
        symbols[_LEFT] = (symbols[_LEFT], diamonds[0])  # drawn on top of each other
    rings = [label for label in (_LAST_RING, *(label for _, label in reversed(_BEFORE.values())))
             if label in symbols]
    visits = [label for _, label in _VISITS.values() if label in symbols]
    labels = [*(label for label in symbols if label not in (*rings, *visits)), *visits, *rings]
    figure.legend([symbols[label] for label in labels], labels, loc="lower left", frameon=False,
                  fontsize=10, ncols=4, columnspacing=1.5, bbox_to_anchor=(0.01, 0.0),
                  handler_map={tuple: HandlerTuple(ndivide=1)}, alignment="left", markerscale=0.7,
                  title=f"{note}A map contains the last leg; other devices may be outside. The "
                  "scales differ. Rocks and earlier legs are not drawn.",
                  title_fontproperties={"size": 10})


def group_by_cause(routes):
    """Returns {cause: [(name, route)]} of failed episodes, in the order of _CAUSES.

    routes: {name, such as "ranch 7": route}
    """
    groups = {cause: [] for cause in _CAUSES}
    for name, route in routes.items():
        needed, had, is_covered = shortage(route)
        groups["time" if needed >= had else "ring" if is_covered else "other"].append((name, route))
    return {cause: group for cause, group in groups.items() if group}


def describe_failures(groups):
    """Returns a text such as "time runs out in 3, the ship waits before a ring in 2", given the
    result of group_by_cause."""
    return ", ".join(f"{_CAUSES[cause][0]} in {len(group)}" for cause, group in groups.items())


def shortage(route):
    """Returns (needed, had, is_covered) of an episode that did not succeed: the min number of moves
    from the last stop (without a stop: from the start) to the nearest device that was not fetched
    (or port, if all were fetched), the number of steps after this stop, and whether, in the last
    step, a ring covers a device that was not fetched."""
    left, (*before, (_, last_leg)) = devices_left(route), legs(route["steps"])
    needed, _ = _nearest(last_leg[0], _goals(route))
    # The action of step t is complete in step t + 1, as in plot_route.
    had = len(last_leg) - (2 if before else 1)
    return needed, had, any(covering_rings(one, left) for one in route["steps"][-2]["disasters"])


def _nearest(cell, others):
    """Returns the min number of moves from a cell to the nearest of other cells, and the index of
    this cell. A move may be diagonal."""
    moves = np.abs(np.array(others) - cell).max(axis=1)
    return int(moves.min()), int(moves.argmin())


def plot_unfinished(axes, name, route, ratio):
    """Draws the last leg of an episode that did not succeed, and the devices that were left. The
    map shows the cells around them. A dotted line leads from the last stop to the nearest of these
    devices, or to a port if all devices were fetched.

    ratio: width of the map, divided by its height
    """
    chart, last = {**route["chart"], "rocks": []}, route["steps"][-1]
    left, goals = devices_left(route), _goals(route)
    loaded, last_leg = legs(route["steps"])[-1]
    needed, had, _ = shortage(route)
    nearest = goals[_nearest(last_leg[0], goals)[1]]
    window = _window([*last_leg, *left, nearest], (chart["width"], chart["height"]), ratio)
    sea = draw_chart(axes, chart, window, left)
    axes.set_anchor("NW")
    axes.set_xlabel("cells to the east")
    axes.set_ylabel("cells to the north")
    _plot_last_rings(axes, route["steps"], left, sea)
    counts = _shade_visits(axes, last_leg)
    colour, kind = LEGS[loaded][0], f"{'a device' if loaded else 'nothing'} aboard"
    moves = [np.array(pair, dtype=float) for pair in zip(last_leg, last_leg[1:])]
    axes.add_collection(LineCollection(
        moves, color=colour, zorder=5, label="_moves",
        linewidths=[2.2 if any(counts[tuple(cell)] == 1 for cell in move) else 0.6
                    for move in moves]))
    axes.plot([], [], color=colour, linewidth=2.2, label=f"last leg, {kind}")
    axes.plot(*zip(last_leg[0], nearest), color="0.35", linestyle=":", linewidth=1.1, zorder=4,
              label=f"last stop to nearest {'device left' if left else 'port'} (no route)")
    if left:
        axes.scatter(*zip(*left), s=260, facecolor="none", edgecolor="black", linewidth=2.2,
                     zorder=8, clip_on=False, label=_LEFT)
    axes.scatter(*last["cell"], s=190, marker="*", color="#f0e442", edgecolor="black", zorder=9,
                 label="ship at the end")
    result = f"{route['return']:.0f}".replace("-", "−")
    axes.set_title(f"{name}: {last['delivered']} of {len(chart['devices'])} in port, return "
                   f"{result}\n≥ {_count(needed, 'move')} needed, {_count(had, 'step')} left",
                   fontsize=11, loc="left")


def _count(number, noun):
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _window(cells, size, shape):
    """Returns the first and last column, and the first and last row, of a map that contains cells.
    If the ranch is large enough, the map has the given shape (width / height). size: that of the
    ranch"""
    low = np.maximum(np.min(cells, axis=0) - _MARGIN, 0)
    high = np.minimum(np.max(cells, axis=0) + _MARGIN, np.array(size) - 1)
    for axis, ratio in ((0, shape), (1, 1.0 / shape)):
        length = int(ratio * (high - low)[1 - axis])
        if length > high[axis] - low[axis]:
            low[axis] = max(0, (low[axis] + high[axis] - length) // 2)
            high[axis] = min(size[axis] - 1, low[axis] + length)
            low[axis] = max(0, high[axis] - length)
    return int(low[0]), int(high[0]), int(low[1]), int(high[1])


def _plot_last_rings(axes, steps, left, sea):
    """Draws the rings in the last step. If rings of a disaster cover a device in `left`, also draws
    the last of them as it was some steps before (_BEFORE)."""
    at_end = steps[-2]["disasters"]  # in the last state they may have ended
    for i, disaster in enumerate(at_end):
        rings = list(rings_of(disaster))
        covering = covering_rings(disaster, left)
        for count, (style, label) in _BEFORE.items() if covering else ():
            then = len(steps) - 2 - count
            before = steps[then]["disasters"] if then >= 0 else []
            if len(before) == len(at_end):  # if not, their indices differ
                _plot_ring(axes, list(rings_of(before[i]))[covering[-1]], sea, linestyle=style,
                           linewidth=2.0, label=label)
        for ring in rings:
            inside = axes.add_patch(Polygon(ring, color=RING, alpha=0.12, zorder=1))
            inside.set_clip_path(sea)
            _plot_ring(axes, ring, sea, linewidth=1.6, label=_LAST_RING)


def _shade_visits(axes, cells):
    """Shades the cells that a route visits more than once. Returns the visits of each cell. Steps
    without a move, such as a pickup, are no visits."""
    counts = collections.Counter(tuple(cell) for before, cell in zip([None, *cells], cells)
                                 if cell != before)
    for i, (low, (colour, label)) in enumerate(_VISITS.items()):
        high = [*_VISITS, np.inf][i + 1]
        shown = [cell for cell, count in counts.items() if low <= count < high]
        if shown:
            axes.add_collection(PatchCollection(
                [Rectangle((x - 0.5, y - 0.5), 1.0, 1.0) for x, y in shown], facecolor=colour,
                edgecolor="none", zorder=1.5))  # below ports and devices
            axes.scatter([], [], color=colour, marker="s", s=150, label=label)
    return counts


def _plot_ring(axes, ring, sea, **style):
    """Draws the outline of a ring, clipped at the edge of the sea."""
    outline, = axes.plot(*np.vstack([ring, ring[:1]]).T, color=RING, zorder=3.5, **style)
    outline.set_clip_path(sea)
