# SPDX-License-Identifier: BSD-3-Clause
"""Draws route files as PNG: the preferred action of a policy in each cell and its route (Fig. 11),
and the routes of episodes that ended with devices at sea."""
import collections
import json

import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.legend_handler import HandlerTuple
from matplotlib.patches import Polygon, Rectangle
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from aquafarm_benchmark.style import joined, legible, plt, save, wrap_evenly

_DIRECTIONS = {"north": (0, 1), "south": (0, -1), "west": (-1, 0), "east": (1, 0),
               "north_west": (-1, 1), "north_east": (1, 1), "south_west": (-1, -1),
               "south_east": (1, -1)}
_EVERY = 2  # arrows are drawn in every second column and row, so that they can be long enough
_SHOWN_STEPS = 4  # number of steps whose rings are drawn
_ARROW = 0.48  # length of an arrow, as a fraction of the distance to the next one
_RIM = 0.7  # distance from the centres of the outermost cells to the edge of the axes [cells]
_LANE = 0.14  # offset of a leg (route between two stops) from its cells [cells]; alternating sign
# Style of a leg by whether a device is aboard; colours of Okabe and Ito (2008).
_LEGS = {False: ("#0072b2", (0, (4, 1.5)), "route with nothing aboard"),
         True: ("#d55e00", "solid", "route with a device aboard")}
_MARGIN = 3  # min number of cells around the last leg that the map of an episode shows
_RATIO = 1.45  # width of this map, divided by its height
# Min number of visits of a cell on the last leg, with the colour and label of the cell.
_VISITS = {2: ("#c6dbef", "cell with 2 to 4 visits"), 5: ("#6baed6", "cell with 5 to 9 visits"),
           10: ("#2171b5", "cell with 10 or more visits")}
_DEVICE = "#c2185b"
# Marker, colour and name of a device by its kind, as in pictures of aquafarm_viz.
_KINDS = {"temporary_breeding": ("s", "#e8dcc8", "temporary"),
          "monitoring": ("^", "#a8e6a0", "monitoring"),
          "breeding_release": ("h", "#c4c4ff", "release"),
          "deep_water_breeding": ("o", "#7fd4d4", "deep water")}
_SEA = "#eaf3f9"
_LAND = "#c9b98a"
_EDGE = "#5b6b78"
# Marker and name of the actions at a stop.
_STOPS = {"pickup": ("D", "pickup"), "drop_off": ("o", "drop-off")}
_STOP_STYLE = {"s": 400, "color": "#f0e442", "edgecolor": "black", "linewidth": 1.0, "zorder": 2.5}
_RING = "#b22222"
_LEFT = "device that was not fetched"
_LAST_RING = "ring of a disaster in the last step"
# Steps before the end whose rings are drawn, and their colour and label.
_BEFORE = {120: ("#f0b4b4", "the same ring 120 steps before"),
           60: ("#dd7d7d", "the same ring 60 steps before")}


def draw_route(path, label, route_file, best_file=None):
    """Draws Fig. 11: the greedy actions at the start and after the first pickup, and the route.

    label: name of the policy
    best_file: route of the clairvoyant; its return is stated if it is of the same episode
    """
    route = json.loads(route_file.read_text())
    best = json.loads(best_file.read_text()) if best_file and best_file.is_file() else None
    is_same = best and all(best[key] == route[key]
                           for key in ("scenario_hash", "farm_seed", "episode"))
    panels = [("best_moves_at_start", "with nothing aboard"),
              ("best_moves_after_pickup", "with a device aboard")]
    panels = [panel for panel in panels if route[panel[0]]]
    rows = 2 if panels else 1
    figure, all_axes = plt.subplots(rows, 2, figsize=(10.5, 5.4 * rows), squeeze=False,
                                    layout="constrained")
    figure.get_layout_engine().set(h_pad=0.12)
    all_axes = list(all_axes.flat)
    for axes, (key, words) in zip(all_axes, panels):
        _chart(axes, route["chart"])
        plot_moves(axes, route[key], route["chart"])
        axes.set_title(f"best move {words}")
    axes = all_axes[len(panels)]
    for empty in all_axes[len(panels) + 1:]:
        empty.axis("off")
    sea = _chart(axes, route["chart"])
    names = place_names(route["chart"])
    ports = {tuple(cell) for cell in route["chart"]["ports"]}
    stops = plot_route(axes, route["steps"], names, ports)
    for shown in all_axes[:len(panels) + 1]:
        for cell, name in names.items():
            shown.annotate(name, cell, xytext=(0, -0.5) if cell in ports else (11, -9),
                           textcoords="offset points", fontsize=8.5 if cell in ports else 10,
                           ha="center", va="center", weight="bold", zorder=8,
                           path_effects=[withStroke(linewidth=2.5, foreground="white")])
    _disasters(axes, route["steps"], sea)
    for shown in all_axes[:len(panels) + 1]:
        shown.set_xlabel("cells to the east")
        shown.set_ylabel("cells to the north")
    axes.set_title("the route in this episode")
    figure.suptitle(f"{label}: {route['reason'].replace('_', ' ')} after {len(route['steps']) - 1} "
                    f"steps, return {route['return']:.1f}" +
                    (f" (clairvoyant: {best['return']:.1f})" if is_same else ""), fontsize=13.5,
                    weight="bold", x=0.01, ha="left")
    _explain(all_axes[-1], [*all_axes[:len(panels)], axes], stops, bool(panels))
    save(figure, path, dpi=110)  # reports show it at full size; it fits a window of 1280 pixels


def devices_left(route):
    """Returns the cells [x, y] of the devices that the ship of the route did not fetch."""
    fetched = [before["cell"] for before, after in zip(route["steps"], route["steps"][1:])
               if after["aboard"] > before["aboard"]]
    return [device["cell"] for device in route["chart"]["devices"]
            if device["cell"] not in fetched]


def draw_unfinished(path, routes, title):
    """Draws the last legs of episodes that ended with devices at sea, and the rings of disasters in
    the last step and before.

    routes: {name of the ranch: route file}
    title: title of the figure, which is followed by the causes of the failures
    """
    columns = 2
    rows = -(-(len(routes) + 1) // columns)  # the last map is followed by the legend
    routes = {name: json.loads(file.read_text()) for name, file in routes.items()}
    figure, all_axes = plt.subplots(rows, columns, figsize=(5.0 * columns, 4.0 * rows),
                                    squeeze=False, layout="constrained")
    figure.get_layout_engine().set(h_pad=0.1)
    all_axes = list(all_axes.flat)
    charts = all_axes[:len(routes)]
    for axes, (name, route) in zip(charts, routes.items()):
        plot_unfinished(axes, name, route)
    for empty in all_axes[len(routes):]:
        empty.axis("off")
    figure.suptitle("\n".join(wrap_evenly(f"{title}: {describe_failures(routes)}")),
                    fontsize=13.5, weight="bold", x=0.01, ha="left")
    symbols = _symbols(charts)
    diamonds, = (one for one in charts[0].collections if one.get_label() == "_device")
    symbols[_LEFT] = (symbols[_LEFT], diamonds)  # drawn on top of each other
    rings = [label for label in (_LAST_RING, *(label for _, label in reversed(_BEFORE.values())))
             if label in symbols]
    visits = [label for _, label in _VISITS.values() if label in symbols]
    labels = [*(label for label in symbols if label not in (*rings, *visits)), *visits, *rings]
    all_axes[-1].legend([symbols[label] for label in labels], labels, loc="center left",
                        frameon=False, fontsize=11, labelspacing=0.5,
                        handler_map={tuple: HandlerTuple(ndivide=1)}, alignment="left",
                        title="Needed: min number of moves from the last stop to the\n"
                        "nearest device not fetched. Left: steps after this stop.\n"
                        "A map contains the last leg; other devices may be outside.",
                        title_fontproperties={"size": 10})
    save(figure, path)


def describe_failures(routes):
    """Returns a text on the causes of failed episodes. routes: {name, such as "ranch 7": route}"""
    causes = {"time runs out": [], "a device is left inside a ring": []}
    for name, route in routes.items():
        needed, had, is_covered = shortage(route)
        cause = "time runs out" if needed > had else "a device is left inside a ring"
        if needed > had or is_covered:
            causes[cause].append(name.replace("ranch ", ""))
    return "; ".join(f"{cause} in {'ranches' if len(names) > 1 else 'ranch'} {joined(names)}"
                     for cause, names in causes.items() if names)


def shortage(route):
    """Returns (needed, had, is_covered) of an episode that did not succeed: the min number of moves
    from the last stop (without a stop: from the start) to the nearest device that was not fetched,
    the number of steps after this stop, and whether, in the last step, a ring covers a device that
    was not fetched."""
    left, (*before, (_, last_leg)) = devices_left(route), legs(route["steps"])
    needed, _ = _nearest(last_leg[0], left)
    rings = [ring for one in route["steps"][-2]["disasters"] for ring in _rings(one)]
    # The action of step t is complete in step t + 1, as in plot_route.
    had = len(last_leg) - (2 if before else 1)
    return needed, had, any(_covers_any(ring, left) for ring in rings)


def _nearest(cell, others):
    """Returns the min number of moves from a cell to the nearest of other cells, and the index of
    this cell. A move may be diagonal."""
    moves = np.abs(np.array(others) - cell).max(axis=1)
    return int(moves.min()), int(moves.argmin())


def plot_unfinished(axes, name, route):
    """Draws the last leg of an episode that did not succeed, and the devices that were left. The
    map shows the cells around them."""
    chart, last = route["chart"], route["steps"][-1]
    left = devices_left(route)
    *before, (loaded, last_leg) = legs(route["steps"])
    sea = _chart(axes, chart, _window([*last_leg, *left], (chart["width"], chart["height"])), left)
    axes.set_anchor("NW")
    axes.set_xlabel("cells to the east")
    axes.set_ylabel("cells to the north")
    _plot_last_rings(axes, route["steps"], left, sea)
    for _, cells in before:
        line, = axes.plot(*np.array(cells, dtype=float).T, color=_EDGE, linewidth=0.8, zorder=2,
                          alpha=0.25, label="route before")
        line.set_clip_path(sea)
    counts = _shade_visits(axes, last_leg)
    colour, kind = _LEGS[loaded][0], f"{'a device' if loaded else 'nothing'} aboard"
    moves = [np.array(pair, dtype=float) for pair in zip(last_leg, last_leg[1:])]
    axes.add_collection(LineCollection(
        moves, color=colour, zorder=5, label="_moves",
        linewidths=[2.2 if any(counts[tuple(cell)] == 1 for cell in move) else 0.6
                    for move in moves]))
    axes.plot([], [], color=colour, linewidth=2.2, label=f"last leg, {kind}")
    axes.scatter(*zip(*left), s=260, facecolor="none", edgecolor="black", linewidth=2.2, zorder=8,
                 clip_on=False, label=_LEFT)
    axes.scatter(*last["cell"], s=190, marker="*", color="#f0e442", edgecolor="black", zorder=9,
                 label="ship at the end")
    _measure(axes, last["cell"], left)
    result = f"{route['return']:.0f}".replace("-", "−")
    needed, had, is_covered = shortage(route)
    axes.set_title(f"{name}: {last['delivered']} of {len(chart['devices'])} devices in port, "
                   f"return {result}\n{_count(needed, 'move')} needed, {_count(had, 'step')} left"
                   f"{'; device inside a ring' if is_covered else ''}", fontsize=10.5, loc="left")


def _count(number, noun):
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _window(cells, size):
    """Returns the first and last column, and the first and last row, of a map that contains cells.
    The map has the shape of _RATIO, if the ranch is large enough. size: that of the ranch"""
    low = np.maximum(np.min(cells, axis=0) - _MARGIN, 0)
    high = np.minimum(np.max(cells, axis=0) + _MARGIN, np.array(size) - 1)
    for axis, ratio in ((0, _RATIO), (1, 1.0 / _RATIO)):
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
        rings = list(_rings(disaster))
        covering = [k for k, ring in enumerate(rings) if _covers_any(ring, left)]
        for count, (colour, label) in _BEFORE.items() if covering else ():
            then = len(steps) - 2 - count
            before = steps[then]["disasters"] if then >= 0 else []
            if len(before) == len(at_end):  # if not, their indices differ
                _plot_ring(axes, list(_rings(before[i]))[covering[-1]], sea, colour, linewidth=2.0,
                           label=label)
        for ring in rings:
            inside = axes.add_patch(Polygon(ring, color=_RING, alpha=0.12, zorder=1))
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


def _measure(axes, cell, left):
    """Connects the ship to the nearest device in `left`. Writes the min number of moves between
    them."""
    moves, nearest = _nearest(cell, left)
    axes.plot(*zip(cell, left[nearest]), color="black", linestyle=":", linewidth=1.4, zorder=5,
              label="min number of moves at the end")
    east, north = np.array(left[nearest]) - cell
    is_below = north > 0  # the line is above
    axes.annotate(f"≥ {_count(moves, 'move')}", cell, xytext=(0, -10 if is_below else 10),
                  textcoords="offset points", ha="left" if east > 0 else "right",
                  va="top" if is_below else "bottom", fontsize=11, weight="bold", zorder=10,
                  path_effects=[withStroke(linewidth=3, foreground="white")])


def _symbols(charts):
    """Returns {label: symbol} for the legend of several axes."""
    symbols = {}
    for axes in charts:
        symbols.update(reversed(pair) for pair in zip(*axes.get_legend_handles_labels()))
    return symbols


def _chart(axes, chart, window=None, left=None):
    """Draws a ranch. Returns the patch of its sea.

    window: first and last column, first and last row of the part to draw; None: the whole ranch
    left: cells of the devices that were not fetched; the symbols of other devices are hollow. None:
        the symbols of all devices show their kind
    """
    west, east, south, north = window or (0, chart["width"] - 1, 0, chart["height"] - 1)
    width, height = east - west + 1, north - south + 1
    axes.set_aspect("equal")
    for spine in axes.spines.values():  # the patch of the sea has an edge
        spine.set_visible(False)
    for axis, low, count in ((axes.xaxis, west, width), (axes.yaxis, south, height)):
        step = 5 if count <= 30 else 10
        axis.set_ticks(range(-(-low // step) * step, low + count, step))
    axes.set_xlim(west - _RIM, east + _RIM)
    axes.set_ylim(south - _RIM, north + _RIM)
    shown = {"xy": (west - 0.5, south - 0.5), "width": width, "height": height}
    sea = axes.add_patch(Rectangle(**shown, facecolor=_SEA, zorder=0))
    axes.add_patch(Rectangle(**shown, fill=False, edgecolor=_EDGE, zorder=2))  # above the islands
    area = 4900.0 / max(width, height)  # area of a marker that fills a cell [pt²]
    groups = [(chart["islands"], {"color": _LAND, "marker": "s", "s": area}, "island"),
              (chart["rocks"], {"color": "#9aa5ae" if left is None else "#cfd6db", "marker": "^",
                                "s": 0.18 * area}, "rock"),
              (chart["ports"], {"facecolor": "white", "edgecolor": "black", "linewidth": 2.0,
                                "s": 0.9 * area}, "port")]
    if left is None:
        kinds = {device.get("kind") for device in chart["devices"]}
        for kind in sorted(kinds, key=str):
            marker, colour, name = _KINDS.get(kind, ("D", _DEVICE, "device"))
            groups.append(([one["cell"] for one in chart["devices"] if one.get("kind") == kind],
                           {"facecolor": colour, "edgecolor": "black", "marker": marker,
                            "s": 0.8 * area}, f"device: {name}" if kind in _KINDS else name))
    else:
        cells = [device["cell"] for device in chart["devices"]]
        groups += [([cell for cell in cells if cell not in left],
                    {"facecolor": "white", "edgecolor": _DEVICE, "marker": "D", "s": 0.5 * area},
                    "device that was fetched"),
                   (left, {"color": _DEVICE, "marker": "D", "s": 0.6 * area}, "_device")]
    for cells, style, label in groups:
        cells = [(x, y) for x, y in cells if west <= x <= east and south <= y <= north]
        if not cells:
            continue
        if label == "island":
            axes.add_collection(PatchCollection(
                [Rectangle((x - 0.5, y - 0.5), 1.0, 1.0) for x, y in cells], facecolor=_LAND,
                edgecolor=_LAND, zorder=1))
            cells = np.empty((0, 2))  # for the legend
        axes.scatter(*np.transpose(cells), label=label, zorder=3, **style)
    return sea


def plot_moves(axes, moves, chart):
    """Draws the preferred actions. A move is an arrow, in every second column and row except at
    ports, at devices and below their names. A pickup or drop-off is a mark."""
    taken = [*chart["ports"], *([device["cell"][0] + right, device["cell"][1] - down]
                                for device in chart["devices"] for right in range(3)
                                for down in range(2))]
    pointed = [(x, y, *_DIRECTIONS[action]) for x, y, action in moves
               if action in _DIRECTIONS and x % _EVERY == 0 and y % _EVERY == 0
               and [x, y] not in taken]
    if pointed:
        x, y, dx, dy = np.array(pointed, dtype=float).T
        share = _ARROW * _EVERY / np.hypot(dx, dy)
        axes.quiver(x, y, dx * share, dy * share, pivot="mid", angles="xy", scale_units="xy",
                    scale=1, width=0.006, headwidth=4.5, color="#34506b", zorder=4)
    for action, (marker, name) in _STOPS.items():
        cells = [(x, y) for x, y, chosen in moves if chosen == action]
        if cells:
            axes.scatter(*zip(*cells), marker=marker, label=name, **_STOP_STYLE)


def legs(steps):
    """Splits a route at its pickups and drop-offs into [(is a device aboard, cells of the leg)]."""
    found = []
    for before, after in zip(steps, steps[1:]):
        if not found or before["action"] in _STOPS:
            found.append((before["aboard"] > 0 if not found else after["aboard"] > 0,
                          [before["cell"]]))
        found[-1][1].append(after["cell"])
    return found


def _plot_legs(axes, steps):
    for i, (loaded, cells) in enumerate(legs(steps)):
        colour, dashes, name = _LEGS[loaded]
        x, y = np.array(cells, dtype=float).T
        lane = np.full(len(x), _LANE if i % 2 else -_LANE)
        for end in (cells[0], cells[-1]):  # legs meet in the centre of a cell
            lane[[cell == end for cell in cells]] = 0.0
        axes.plot(x + lane, y - lane, color=colour, linestyle=dashes, linewidth=2.2, zorder=2.8,
                  label=name if i < len(_LEGS) else "_leg")
        _point_along(axes, x + lane, y - lane, colour)


def _point_along(axes, x, y, colour):
    """Draws an arrowhead in the middle of a line, unless the line has no length there."""
    middle = len(x) // 2
    if len(x) > 2 and (x[middle - 1], y[middle - 1]) != (x[middle], y[middle]):
        axes.annotate("", (x[middle], y[middle]), (x[middle - 1], y[middle - 1]), zorder=6,
                      arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 0,
                                  "mutation_scale": 18, "shrinkA": 0, "shrinkB": 0})


def place_names(chart):
    """Returns {(x, y): name} of the devices, "F0", "F1", …, and the first 26 ports, "A" to "Z"."""
    names = {tuple(device["cell"]): f"F{i}" for i, device in enumerate(chart["devices"])}
    names.update({tuple(cell): chr(ord("A") + i) for i, cell in enumerate(chart["ports"][:26])})
    return names


def plot_route(axes, steps, names, ports):
    """Draws the legs of a route and numbers its stops. Returns [(number, action, place, step)].
    An action of step t is complete in step t + 1.

    names: see place_names
    ports: cells (x, y) of the ports; the numbers of stops there are below the names of the ports
    """
    _plot_legs(axes, steps)
    axes.scatter(*steps[0]["cell"], s=340, facecolor="none", edgecolor="black", linewidth=1.6,
                 linestyle=(0, (2, 1.2)), zorder=6, label="start")
    stops, here = [], {}
    for at, step in enumerate(steps):
        if step.get("action") in _STOPS:
            stops.append((len(stops) + 1, _STOPS[step["action"]][1],
                          names.get(tuple(step["cell"]), ""), at + 1))
            here.setdefault(tuple(step["cell"]), []).append(len(stops))
    for cell, numbers in here.items():  # a cell may have several stops
        offset, across, up = ((0, -12), "center", "top") if cell in ports else (
            (-12, 0), "right", "center")
        axes.annotate(", ".join(map(str, numbers)), cell, xytext=offset, zorder=8,
                      textcoords="offset points", ha=across, va=up, fontsize=10,
                      weight="bold", bbox={"boxstyle": "round,pad=0.15,rounding_size=0.5",
                                           "facecolor": "white", "edgecolor": "black"})
    return stops


def _explain(empty, charts, stops, has_moves):
    """Writes the legend and the table of stops on empty axes."""
    symbols = _symbols(charts)
    empty.legend(symbols.values(), symbols.keys(), loc="upper left", frameon=False, fontsize=11,
                 bbox_to_anchor=(0.0, 1.0), labelspacing=0.7, ncols=2, markerscale=0.8)
    if has_moves:
        empty.text(0.02, 0.56, f"arrow: the preferred move, in every {_EVERY}nd column and row\n"
                   "yellow: cells where the preferred action is a pickup or drop-off",
                   transform=empty.transAxes, va="top", fontsize=11)
    if stops:
        height = 0.06 * (len(stops) + 1)
        table = empty.table(stops, colLabels=["stop", "action", "at", "step"], cellLoc="left",
                            colLoc="left", edges="horizontal",
                            bbox=(0.02, 0.43 - height, 0.6, height))
        table.auto_set_font_size(False)
        table.auto_set_column_width(range(len(stops[0])))
        table.set_fontsize(11)


def _rings(disaster):
    """Yields the outline of each ring of a disaster, [360, 2]. A ring may have a radius for each
    quadrant."""
    bearings = np.radians(np.arange(360.0))
    quadrants = disaster.get("quadrants") or [[radius] * 4 for radius in disaster["radii"]]
    for ring in quadrants:
        radii = np.repeat(ring, 90)  # quadrants are clockwise from north-east, as bearings
        yield np.column_stack([disaster["x"] + radii * np.sin(bearings),
                               disaster["y"] + radii * np.cos(bearings)])


def _covers_any(ring, cells):
    """Returns whether a ring [360, 2] contains one of the cells [x, y]."""
    return Path(ring).contains_points(cells).any()


def _plot_ring(axes, ring, sea, colour=_RING, **style):
    """Draws the outline of a ring, clipped at the edge of the sea."""
    outline, = axes.plot(*np.vstack([ring, ring[:1]]).T, color=colour, zorder=3.5, **style)
    outline.set_clip_path(sea)


def _disasters(axes, steps, sea):
    """Draws all rings at the start, and the outermost rings in some later steps. The colour and a
    label specify the step."""
    stops = [step["cell"] for step in steps if step.get("action") in _STOPS]
    inside = axes.viewLim.padded(-0.3)
    west = axes.viewLim.xmin + 2.0  # labels of points west of this x are to the right of the ring
    axes.plot([], [], color=_RING, linewidth=1.8, label="ring of the disaster, by step")
    shown = np.unique(np.linspace(0, len(steps) - 1, _SHOWN_STEPS).astype(int))
    rings = [(at, list(_rings(disaster))) for at in shown for disaster in steps[at]["disasters"]]
    for at, (*inner, outer) in rings:
        colour = plt.get_cmap("YlOrRd")(0.95 - 0.45 * at / max(1, shown[-1]))
        for ring in [*inner, outer] if at == 0 else [outer]:
            axes.add_patch(Polygon(ring, fill=False, color=colour, zorder=2,
                                   linewidth=1.8 if ring is outer else 1.0)).set_clip_path(sea)
        seen = [point for point in outer[::10]  # with space for the label's height
                if all(inside.contains(*(point + (0.0, up))) for up in (-0.5, 0.5))]
        if not seen:
            continue
        # The label is at the point that is farthest from the stops and from the other rings.
        others = np.array([*stops, *(point for _, other in rings if other[-1] is not outer
                                     for point in other[-1][::10])], dtype=float).reshape(-1, 2)
        best = max(seen, key=lambda point: min(np.hypot(*(others - point).T), default=0.0))
        axes.annotate(f"step {at}", best, color=legible(colour[:3]), fontsize=10, va="center",
                      ha="left" if best[0] < west else "center", xytext=(3, 0), zorder=7,
                      textcoords="offset points", weight="bold",
                      bbox={"boxstyle": "round,pad=0.1", "facecolor": _SEA, "edgecolor": "none"})
