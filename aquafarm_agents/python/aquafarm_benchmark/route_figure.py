# SPDX-License-Identifier: BSD-3-Clause
"""Draws route files as PNG: the preferred action of a policy in each cell and its route (Fig. 11),
and the routes of episodes that ended with devices at sea."""
import json

import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Polygon, Rectangle
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from aquafarm_benchmark.style import plt, save

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
_REPEATED = 0.35  # opacity of a path that may overlap itself
_DEVICE = "#c2185b"
_SEA = "#eaf3f9"
_LAND = "#c9b98a"
_STOPS = {"pickup": ("P", "pickup"), "drop_off": ("X", "drop-off")}
_STOP_STYLE = {"s": 130, "color": "#f0e442", "edgecolor": "black", "linewidth": 1.0, "zorder": 7}
_RING = "#b22222"
_LAST_RING = "ring of a disaster in the last step"
# Steps before the end whose rings are drawn, and their colour and label.
_BEFORE = {120: ("#f0b4b4", "the same ring 120 steps before"),
           60: ("#dd7d7d", "the same ring 60 steps before")}


def draw_route(path, label, route_file):
    """Draws Fig. 11: the greedy actions at the start and after the first pickup, and the route.

    label: name of the policy
    """
    route = json.loads(route_file.read_text())
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
            shown.annotate(name, cell, xytext=(0, 11) if cell in ports else (10, -7),
                           textcoords="offset points", fontsize=9.5, ha="center", va="center",
                           weight="bold", zorder=8,
                           path_effects=[withStroke(linewidth=2.5, foreground="white")])
    _disasters(axes, route["steps"], sea)
    for shown in all_axes[:len(panels) + 1]:
        shown.set_xlabel("cells to the east")
        shown.set_ylabel("cells to the north")
    axes.set_title("the route in this episode")
    figure.suptitle(f"{label}: {route['reason'].replace('_', ' ')} after {len(route['steps']) - 1} "
                    f"steps, return {route['return']:.1f}", fontsize=13.5, weight="bold", x=0.01,
                    ha="left")
    _explain(all_axes[-1], [*all_axes[:len(panels)], axes], stops, bool(panels))
    save(figure, path, dpi=110)  # reports show it at full size; it fits a window of 1280 pixels


def devices_left(route):
    """Returns the cells [x, y] of the devices that the ship of the route did not fetch."""
    fetched = [before["cell"] for before, after in zip(route["steps"], route["steps"][1:])
               if after["aboard"] > before["aboard"]]
    return [device["cell"] for device in route["chart"]["devices"]
            if device["cell"] not in fetched]


def draw_unfinished(path, routes, title):
    """Draws the routes of episodes that ended with devices at sea, and the rings of disasters in
    the last step and before. All maps have the same scale.

    routes: {name of the ranch: route file}
    title: title of the figure
    """
    columns = 2
    rows = -(-(len(routes) + 1) // columns)  # the last map is followed by the legend
    routes = {name: json.loads(file.read_text()) for name, file in routes.items()}
    size = [max(route["chart"][side] for route in routes.values()) for side in ("width", "height")]
    figure, all_axes = plt.subplots(
        rows, columns, figsize=(5.0 * columns, (0.8 + 5.0 * size[1] / size[0]) * rows),
        squeeze=False, layout="constrained")
    figure.get_layout_engine().set(h_pad=0.2)
    all_axes = list(all_axes.flat)
    charts = all_axes[:len(routes)]
    for axes, (name, route) in zip(charts, routes.items()):
        plot_unfinished(axes, name, route, size)
    for empty in all_axes[len(routes):]:
        empty.axis("off")
    figure.suptitle(title, fontsize=13.5, weight="bold", x=0.01, ha="left")
    symbols = _symbols(charts)
    rings = [label for label in (_LAST_RING, *(label for _, label in reversed(_BEFORE.values())))
             if label in symbols]
    labels = [*(label for label in symbols if label not in rings), *rings]
    all_axes[-1].legend([symbols[label] for label in labels], labels, loc="center", frameon=False,
                        fontsize=11, labelspacing=0.9)
    save(figure, path)


def plot_unfinished(axes, name, route, size):
    """Draws the route of an episode that did not succeed. size: numbers of columns and rows of
    the axes, each the largest of all ranches"""
    chart, last = route["chart"], route["steps"][-1]
    left = devices_left(route)
    sea = _chart(axes, chart, size, left)
    axes.set_xlabel("cells to the east")
    axes.set_ylabel("cells to the north")
    at_end = route["steps"][-2]["disasters"]  # in the last state they may have ended
    for i, disaster in enumerate(at_end):
        rings = list(_rings(disaster))
        covering = [k for k, ring in enumerate(rings) if _covers_any(ring, left)]
        for steps, (colour, label) in _BEFORE.items() if covering else ():
            then = len(route["steps"]) - 2 - steps
            before = route["steps"][then]["disasters"] if then >= 0 else []
            if len(before) == len(at_end):  # if not, their indices differ
                _plot_ring(axes, list(_rings(before[i]))[covering[-1]], sea, colour, linewidth=2.0,
                           label=label)
        for ring in rings:
            inside = axes.add_patch(Polygon(ring, color=_RING, alpha=0.12, zorder=1))
            inside.set_clip_path(sea)
            _plot_ring(axes, ring, sea, linewidth=1.6, label=_LAST_RING)
    *before, (loaded, last_leg) = legs(route["steps"])
    for _, cells in before:
        axes.plot(*np.array(cells, dtype=float).T, color="#5b6b78", linewidth=1.0, zorder=4,
                  alpha=0.45, label="route before")
    colour, kind = _LEGS[loaded][0], f"{'a device' if loaded else 'nothing'} aboard"
    axes.add_collection(LineCollection(  # one segment per step: repeated segments look darker
        [np.array(pair, dtype=float) for pair in zip(last_leg, last_leg[1:])], color=colour,
        linewidth=2.0, zorder=5, alpha=_REPEATED, label=f"last leg, {kind}; darker: repeated"))
    axes.scatter(*zip(*left), s=260, facecolor="none", edgecolor="black",
                 linewidth=2.2, zorder=8, label="device that was not fetched")
    axes.scatter(*last["cell"], s=150, marker="*", color="#f0e442", edgecolor="black", zorder=9,
                 label="ship at the end")
    result = f"{route['return']:.0f}".replace("-", "−")
    end = len(route["steps"]) - 1
    # The action of step t is complete in step t + 1, as in plot_route.
    stop = f"last stop at {end - len(last_leg) + 2}" if before else "no stop"
    axes.set_title(f"{name}: {last['delivered']} of {len(chart['devices'])} devices in port, "
                   f"return {result}\n"
                   f"{route['reason'].replace('_', ' ')} at step {end}, {stop}",
                   fontsize=10.5, loc="left")


def _symbols(charts):
    """Returns {label: symbol} for the legend of several axes."""
    symbols = {}
    for axes in charts:
        symbols.update(reversed(pair) for pair in zip(*axes.get_legend_handles_labels()))
    return symbols


def _chart(axes, chart, size=None, left=None):
    """Draws a ranch. Returns the patch of its sea.

    size: columns and rows that fill the axes; None: those of the ranch
    left: cells of the devices that were not fetched; the symbols of other devices are hollow. None:
        all symbols are filled
    """
    width, height = size or (chart["width"], chart["height"])
    axes.set_aspect("equal")
    for spine in axes.spines.values():  # the patch of the sea has an edge
        spine.set_visible(False)
    for axis, count in ((axes.xaxis, chart["width"]), (axes.yaxis, chart["height"])):
        axis.set_ticks(range(0, count, 5 if count <= 30 else 10))
    axes.set_xlim(-_RIM, width - 1 + _RIM)
    axes.set_ylim(chart["height"] - height - _RIM, chart["height"] - 1 + _RIM)  # ranch at the top
    axes.spines["bottom"].set_position(("data", -_RIM))
    sea = axes.add_patch(Rectangle((-0.5, -0.5), chart["width"], chart["height"], facecolor=_SEA,
                                   edgecolor="#5b6b78", zorder=0))
    if chart["islands"]:
        axes.add_collection(PatchCollection(
            [Rectangle((x - 0.5, y - 0.5), 1.0, 1.0) for x, y in chart["islands"]],
            facecolor=_LAND, edgecolor=_LAND, zorder=1))
        axes.scatter([], [], color=_LAND, marker="s", s=200, label="island")
    area = 4900.0 / max(width, height)  # area of a marker that fills a cell [pt²]
    devices = [device["cell"] for device in chart["devices"]]
    fetched = [] if left is None else [cell for cell in devices if cell not in left]
    for cells, style, share, label in (
            (chart["rocks"], {"color": "#d3dae0", "marker": "^"}, 0.18, "rock"),
            (chart["ports"], {"color": "#1a7f37", "marker": "s"}, 0.6, "port"),
            (fetched, {"facecolor": "white", "edgecolor": _DEVICE, "marker": "D"}, 0.5,
             "device that was fetched"),
            ([cell for cell in devices if cell not in fetched], {"color": _DEVICE, "marker": "D"},
             0.6, "device" if left is None else "_device")):
        if cells:
            axes.scatter(*zip(*cells), label=label, zorder=6 if cells is fetched else 3,
                         s=area * share, **style)
    return sea


def plot_moves(axes, moves, chart):
    """Draws the preferred actions. A move is an arrow, in every second column and row except at
    ports and devices. A pickup or drop-off is a mark."""
    taken = [*chart["ports"], *(device["cell"] for device in chart["devices"])]
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
        axes.plot(x + lane, y - lane, color=colour, linestyle=dashes, linewidth=2.2, zorder=5,
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
    axes.scatter(*steps[0]["cell"], s=170, facecolor="none", edgecolor="black", linewidth=1.8,
                 zorder=6, label="start")
    stops, here = [], {}
    for at, step in enumerate(steps):
        if step.get("action") in _STOPS:
            stops.append((len(stops) + 1, _STOPS[step["action"]][1],
                          names.get(tuple(step["cell"]), ""), at + 1))
            here.setdefault(tuple(step["cell"]), []).append(len(stops))
    for cell, numbers in here.items():  # a cell may have several stops
        offset, across, up = ((0, -11), "center", "top") if cell in ports else (
            (-10, 0), "right", "center")
        axes.annotate(", ".join(map(str, numbers)), cell, xytext=offset, zorder=8,
                      textcoords="offset points", ha=across, va=up, fontsize=10,
                      weight="bold", bbox={"boxstyle": "round,pad=0.15,rounding_size=0.5",
                                           "facecolor": "white", "edgecolor": "black"})
    return stops


def _explain(empty, charts, stops, has_moves):
    """Writes the legend and the table of stops on empty axes."""
    symbols = _symbols(charts)
    empty.legend(symbols.values(), symbols.keys(), loc="upper left", frameon=False, fontsize=11,
                 bbox_to_anchor=(0.0, 1.0), labelspacing=0.7, ncols=2)
    if has_moves:
        empty.text(0.02, 0.63, f"arrow: the preferred move, in every {_EVERY}nd column and row",
                   transform=empty.transAxes, va="top", fontsize=11)
    if stops:
        table = empty.table(stops, colLabels=["stop", "action", "at", "step"], cellLoc="left",
                            colLoc="left", edges="horizontal",
                            bbox=(0.02, 0.5 - 0.06 * (len(stops) + 1), 0.6, 0.06 * (len(stops) + 1)))
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
    """Draws all rings at the start, and in thinner lines the outermost rings in some later
    steps."""
    stops = np.array([step["cell"] for step in steps if step.get("action") in _STOPS],
                     dtype=float).reshape(-1, 2)
    inside = axes.viewLim.padded(-0.3)
    west = axes.viewLim.xmin + 2.0  # labels of points west of this x are to the right of the ring
    axes.plot([], [], color=_RING, linewidth=1.6, label="ring of the disaster")
    for at in np.linspace(0, len(steps) - 1, _SHOWN_STEPS).astype(int):
        style = {"linewidth": 1.6, "alpha": 0.9} if at == 0 else {"linewidth": 0.9, "alpha": 0.6}
        for disaster in steps[at]["disasters"]:
            *inner, outer = _rings(disaster)
            for ring in [*inner, outer] if at == 0 else [outer]:
                axes.add_patch(Polygon(ring, fill=False, color=_RING, zorder=2,
                                       **style)).set_clip_path(sea)
            seen = [point for point in outer[::15] if inside.contains(*point)]
            if not seen:
                continue
            # The label is at the point that is farthest from the stops of the route.
            best = max(seen, key=lambda point: min(np.hypot(*(stops - point).T), default=0.0))
            axes.annotate(f"step {at}", best, color=_RING, fontsize=9, va="center",
                          ha="left" if best[0] < west else "center", xytext=(3, 0),
                          textcoords="offset points",
                          zorder=7, bbox={"boxstyle": "round,pad=0.1", "facecolor": _SEA,
                                          "edgecolor": "none"})
