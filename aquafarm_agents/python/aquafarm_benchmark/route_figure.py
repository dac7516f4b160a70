# SPDX-License-Identifier: BSD-3-Clause
"""Draws route files as PNG: the preferred action of a policy in each cell and its route (Fig.
11)."""
import json

import numpy as np
import yaml
from matplotlib.collections import PatchCollection
from matplotlib.patches import Polygon, Rectangle
from matplotlib.patheffects import withStroke

from aquafarm_benchmark.style import legible, number, plt, save

_DIRECTIONS = {"north": (0, 1), "south": (0, -1), "west": (-1, 0), "east": (1, 0),
               "north_west": (-1, 1), "north_east": (1, 1), "south_west": (-1, -1),
               "south_east": (1, -1)}
_EVERY = 2  # arrows are drawn in every second column and row, so that they can be long enough
_SHOWN_STEPS = 4  # number of steps whose rings are drawn
_ARROW = 0.48  # length of an arrow, as a fraction of the distance to the next one
_RIM = 0.7  # distance from the centres of the outermost cells to the edge of the axes [cells]
_LANE = 0.14  # offset of a leg (route between two stops) from its cells [cells]; alternating sign
# Style of a leg by whether a device is aboard; colours of Okabe and Ito (2008).
LEGS = {False: ("#0072b2", (0, (4, 1.5)), "route with nothing aboard"),
         True: ("#d55e00", "solid", "route with a device aboard")}
_DEVICE = "#c2185b"
# Marker, colour and name of a device by its kind, as in pictures of aquafarm_viz.
_KINDS = {"temporary_breeding": ("s", "#e8dcc8", "temporary"),
          "monitoring": ("^", "#a8e6a0", "monitoring"),
          "breeding_release": ("h", "#c4c4ff", "release"),
          "deep_water_breeding": ("o", "#7fd4d4", "deep water")}
_MOVE = "#34506b"
_SEA = "#eaf3f9"
_LAND = "#c9b98a"
EDGE = "#5b6b78"
# Marker and name of the actions at a stop.
STOPS = {"pickup": ("D", "pickup"), "drop_off": ("o", "drop-off")}
# Keys of a disaster that give it other risks than its key `risks`.
_OTHER_RISKS = {"grade_risks", "grade_factors", "track", "storms"}
_IN_RING = "in a ring: step 0 → at the stop"  # title of a column of the table of stops
_WIDTHS = (0.1, 0.17, 0.09, 0.11, 0.53)  # of the columns of this table
_STOP_STYLE = {"s": 400, "color": "#f0e442", "edgecolor": "black", "linewidth": 1.0, "zorder": 2.5}
RING = "#b22222"


def draw_route(path, label, route_file, best_file=None):
    """Draws Fig. 11: the greedy actions at the start and after the first pickup, and the route.

    label: name of the policy
    best_file: route of the clairvoyant; its return is stated if it is of the same episode
    """
    route = json.loads(route_file.read_text())
    best = json.loads(best_file.read_text()) if best_file and best_file.is_file() else None
    is_same = best and all(best[key] == route[key]
                           for key in ("scenario_hash", "farm_seed", "episode"))
    loaded = next((at for at, step in enumerate(route["steps"]) if step["aboard"]), 0)
    panels = [("best_moves_at_start", "Best move at step 0, nothing aboard"),
              ("best_moves_after_pickup", f"Best move at step {loaded}, a device aboard")]
    panels = [(name, f"({letter}) {title}\narrows: every {_EVERY}nd column and row, none near "
               "devices") for letter, (name, title) in
              zip("ab", [panel for panel in panels if route[panel[0]]])]
    rows = 2 if panels else 1
    figure, all_axes = plt.subplots(rows, 2, figsize=(10.5, 5.4 * rows), squeeze=False,
                                    layout="constrained")
    figure.get_layout_engine().set(h_pad=0.12)
    all_axes = list(all_axes.flat)
    chart = route["chart"]
    at_sea = [one for one in chart["devices"] if one["cell"] != route["steps"][loaded]["cell"]]
    charts = [{**chart, "devices": at_sea} if key == "best_moves_after_pickup" else chart
              for key, _ in panels] + [chart]
    for axes, shown, (key, words) in zip(all_axes, charts, panels):
        draw_chart(axes, shown)
        plot_moves(axes, route[key], shown)
        axes.set_title(words, fontsize=11.5)
    axes = all_axes[len(panels)]
    for empty in all_axes[len(panels) + 1:]:
        empty.axis("off")
    sea = draw_chart(axes, chart)
    names = place_names(chart)
    ports = {tuple(cell) for cell in chart["ports"]}
    stops = plot_route(axes, route["steps"], names, ports)
    for shown, of_one in zip(all_axes, charts):
        there = {*ports, *(tuple(one["cell"]) for one in of_one["devices"])}
        for cell, name in ((cell, name) for cell, name in names.items() if cell in there):
            shown.annotate(name, cell, xytext=(0, -0.5) if cell in ports else (11, -9),
                           textcoords="offset points", fontsize=8.5 if cell in ports else 10,
                           ha="center", va="center", weight="bold", zorder=8,
                           path_effects=[withStroke(linewidth=2.5, foreground="white")])
    _disasters(axes, route["steps"], sea, risks_of(route_file.parent / "scenario.yaml"))
    for shown in all_axes[:len(panels) + 1]:
        shown.set_xlabel("cells to the east")
        shown.set_ylabel("cells to the north")
    letter = f"({'abc'[len(panels)]}) " if panels else ""
    axes.set_title(f"{letter}Route in this episode", fontsize=11.5)
    figure.suptitle(f"{label} in episode {route['episode']}: {route['reason'].replace('_', ' ')} "
                    f"after {len(route['steps']) - 1} steps, return {route['return']:.1f}" +
                    (f" (clairvoyant: {best['return']:.1f})" if is_same else ""), fontsize=13.5,
                    weight="bold", x=0.01, ha="left")
    _explain(all_axes[-1], [*all_axes[:len(panels)], axes], stops)
    save(figure, path, dpi=110)  # reports show it at full size; it fits a window of 1280 pixels


def symbols_of(charts):
    """Returns {label: symbol} for the legend of several axes."""
    symbols = {}
    for axes in charts:
        symbols.update(reversed(pair) for pair in zip(*axes.get_legend_handles_labels()))
    return symbols


def draw_chart(axes, chart, window=None, left=None):
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
    axes.add_patch(Rectangle(**shown, fill=False, edgecolor=EDGE, zorder=2))  # above the islands
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
    ports and around devices and their names. A pickup or drop-off is a mark."""
    taken = [*chart["ports"], *([device["cell"][0] + right, device["cell"][1] + up]
                                for device in chart["devices"] for right in range(-1, 3)
                                for up in range(-1, 2))]
    pointed = [(x, y, *_DIRECTIONS[action]) for x, y, action in moves
               if action in _DIRECTIONS and x % _EVERY == 0 and y % _EVERY == 0
               and [x, y] not in taken]
    if pointed:
        x, y, dx, dy = np.array(pointed, dtype=float).T
        share = _ARROW * _EVERY / np.hypot(dx, dy)
        axes.quiver(x, y, dx * share, dy * share, pivot="mid", angles="xy", scale_units="xy",
                    scale=1, width=0.006, headwidth=4.5, color=_MOVE, zorder=4)
        axes.scatter([], [], marker="$\u2192$", s=220, color=_MOVE, label="best move")
    for action, (marker, name) in STOPS.items():
        cells = [(x, y) for x, y, chosen in moves if chosen == action]
        if cells:
            axes.scatter(*zip(*cells), marker=marker, label=name, **_STOP_STYLE)


def legs(steps):
    """Splits a route at its pickups and drop-offs into [(is a device aboard, cells of the leg)]."""
    found = []
    for before, after in zip(steps, steps[1:]):
        if not found or before["action"] in STOPS:
            found.append((before["aboard"] > 0 if not found else after["aboard"] > 0,
                          [before["cell"]]))
        found[-1][1].append(after["cell"])
    return found


def _plot_legs(axes, steps):
    for i, (loaded, cells) in enumerate(legs(steps)):
        colour, dashes, name = LEGS[loaded]
        x, y = np.array(cells, dtype=float).T
        lane = np.full(len(x), _LANE if i % 2 else -_LANE)
        for end in (cells[0], cells[-1]):  # legs meet in the centre of a cell
            lane[[cell == end for cell in cells]] = 0.0
        axes.plot(x + lane, y - lane, color=colour, linestyle=dashes, linewidth=2.2, zorder=2.8,
                  label=name if i < len(LEGS) else "_leg")
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
    """Draws the legs of a route and numbers its stops. Returns [(number, action, place, step, in a
    ring)]. An action of step t is complete in step t + 1. The last column states whether the place
    is in a ring at the start and in that step.

    names: see place_names
    ports: cells (x, y) of the ports; the numbers of stops there are below the names of the ports
    """
    _plot_legs(axes, steps)
    axes.scatter(*steps[0]["cell"], s=340, facecolor="none", edgecolor="black", linewidth=1.6,
                 linestyle=(0, (2, 1.2)), zorder=6, label="start")
    stops, here = [], {}
    for at, step in enumerate(steps):
        if step.get("action") in STOPS:
            then = steps[min(at + 1, len(steps) - 2)]  # in the last state disasters may have ended
            inside = ["yes" if any(covering_rings(disaster, [step["cell"]])
                                   for disaster in one["disasters"]) else "no"
                      for one in (steps[0], then)]
            stops.append((len(stops) + 1, STOPS[step["action"]][1],
                          names.get(tuple(step["cell"]), ""), at + 1, " → ".join(inside)))
            here.setdefault(tuple(step["cell"]), []).append(len(stops))
    for cell, numbers in here.items():  # a cell may have several stops
        offset, across, up = ((0, -12), "center", "top") if cell in ports else (
            (-12, 0), "right", "center")
        axes.annotate(", ".join(map(str, numbers)), cell, xytext=offset, zorder=8,
                      textcoords="offset points", ha=across, va=up, fontsize=10,
                      weight="bold", bbox={"boxstyle": "round,pad=0.15,rounding_size=0.5",
                                           "facecolor": "white", "edgecolor": "black"})
    return stops


def _explain(empty, charts, stops):
    """Writes the legend and below it the table of stops on empty axes, next to the map of the
    route."""
    symbols = symbols_of(charts)
    legend = empty.legend(symbols.values(), symbols.keys(), loc="upper left", frameon=False,
                          fontsize=11, bbox_to_anchor=(0.0, 1.0), labelspacing=0.7, ncols=2,
                          markerscale=0.8)
    if stops:
        empty.figure.draw_without_rendering()  # sets the size of the axes
        top = empty.transAxes.inverted().transform(legend.get_window_extent())[0][1]
        height = 0.06 * (len(stops) + 1)
        table = empty.table(stops, colLabels=["stop", "action", "at", "step", _IN_RING],
                            cellLoc="left", colLoc="left", edges="horizontal", colWidths=_WIDTHS,
                            bbox=(0.02, top - 0.02 - height, 1.15, height))
        table.auto_set_font_size(False)
        table.set_fontsize(11)


def _quadrants(disaster):
    """Returns the radii of each ring of a disaster in its quadrants, clockwise from north-east."""
    return disaster.get("quadrants") or [[radius] * 4 for radius in disaster["radii"]]


def rings_of(disaster):
    """Yields the outline of each ring of a disaster, [360, 2]. A ring may have a radius for each
    quadrant."""
    bearings = np.radians(np.arange(360.0))
    for ring in _quadrants(disaster):
        radii = np.repeat(ring, 90)  # quadrants are clockwise from north-east, as bearings
        yield np.column_stack([disaster["x"] + radii * np.sin(bearings),
                               disaster["y"] + radii * np.cos(bearings)])


def covering_rings(disaster, cells):
    """Returns the indices of the rings of a disaster that cover at least one of the cells [x, y].
    The rules are those of the farm (QuadrantOf and RiskOf in aquafarm/farm/disaster.h)."""
    quadrants = _quadrants(disaster)
    if not len(cells) or not quadrants:
        return []
    away = np.asarray(cells, dtype=float) - (disaster["x"], disaster["y"])
    east, north = away.T
    quadrant = np.select([(east >= 0.0) & (north > 0.0), east > 0.0, north < 0.0, east < 0.0],
                         [0, 1, 2, 3], 0)
    reach = np.asarray(quadrants)[:, quadrant]
    inside = (np.hypot(*away.T) <= reach) & (reach > 0.0)
    return [int(one) for one in np.flatnonzero(inside.any(axis=1))]


def risks_of(scenario_file):
    """Returns the risks of the rings, from the innermost to the outermost, if the scenario has one
    disaster whose risks are always those of its key `risks`. Returns an empty list if not, or if
    there is no file."""
    if not scenario_file.is_file():
        return []
    scenario = yaml.safe_load(scenario_file.read_text(encoding="utf-8")) or {}
    disasters = scenario.get("disasters") or []
    if len(disasters) != 1 or disasters[0].keys() & _OTHER_RISKS:
        return []
    return [float(one) for one in disasters[0].get("risks", ())]


def ring_steps(steps):
    """Returns the steps whose rings are drawn: the start, and the first steps after pickups. With
    many pickups, only some of them; without pickups, steps at equal intervals."""
    pickups = [at + 1 for at, step in enumerate(steps) if step.get("action") == "pickup"]
    shown = [0, *pickups] if pickups else range(len(steps))
    chosen = np.unique(np.linspace(0, len(shown) - 1, min(_SHOWN_STEPS, len(shown))).astype(int))
    return [int(shown[i]) for i in chosen]


def _disasters(axes, steps, sea, risks=()):
    """Draws all rings at the start, and the outermost rings in the steps of ring_steps. The colour
    and a label specify the step. The key has the risks of the rings at the start."""
    stops = [step["cell"] for step in steps if step.get("action") in STOPS]
    shown = ring_steps(steps)
    colours = plt.get_cmap("RdPu")(np.linspace(0.95, 0.5, len(shown)))
    rings = [(at, colour, list(rings_of(disaster))) for at, colour in zip(shown, colours)
             for disaster in steps[at]["disasters"]]
    is_known = {len(of_one) for at, _, of_one in rings if at == 0} == {len(risks)}
    for at, colour in zip(shown, colours):
        words = f"outer ring at step {at}" if at else "rings at step 0"
        if at == 0 and is_known:
            words += f" (risk {' to '.join(dict.fromkeys(map(number, (risks[-1], risks[0]))))})"
        if any(one == at for one, _, _ in rings):
            axes.plot([], [], color=colour, linewidth=1.8, label=words)
    for at, colour, (*inner, outer) in rings:
        for ring in [*inner, outer] if at == 0 else [outer]:
            axes.add_patch(Polygon(ring, fill=False, color=colour, zorder=2,
                                   linewidth=1.8 if ring is outer else 1.0)).set_clip_path(sea)
        # A label is at the point that is farthest from the stops and from the other rings.
        _label_ring(axes, outer, f"step {at}", colour, [
            *stops, *(point for _, _, others in rings for ring in others if ring is not outer
                      for point in ring[::10])])


def _label_ring(axes, ring, words, colour, others):
    """Writes words on a ring, at the point in the axes that is farthest from the other points."""
    inside = axes.viewLim.padded(-0.3)
    west = axes.viewLim.xmin + 2.0  # labels of points west of this x are to the right of the ring
    seen = [point for point in ring[::10]  # with space for the label's height
            if all(inside.contains(*(point + (0.0, up))) for up in (-0.5, 0.5))]
    if not seen:
        return
    others = np.array(others, dtype=float).reshape(-1, 2)
    best = max(seen, key=lambda point: min(np.hypot(*(others - point).T), default=0.0))
    axes.annotate(words, best, color=legible(colour[:3]), fontsize=10, va="center",
                  ha="left" if best[0] < west else "center", xytext=(3, 0), zorder=7,
                  textcoords="offset points", weight="bold",
                  bbox={"boxstyle": "round,pad=0.1", "facecolor": _SEA, "edgecolor": "none"})
