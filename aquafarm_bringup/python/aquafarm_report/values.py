# SPDX-License-Identifier: BSD-3-Clause
"""Draws heat maps of V_π, the return of a policy from each start cell, and of the sea layers
(Fig. 10 of the paper), and computes the similarity of V_π and each layer."""
import json
import math
import pathlib
import textwrap

import matplotlib

matplotlib.use("Agg")
import numpy as np  # noqa: E402
from matplotlib import colors, patches, pyplot, ticker  # noqa: E402
from scipy import ndimage, stats  # noqa: E402
from skimage.metrics import structural_similarity  # noqa: E402

from aquafarm_bringup.files import open_atomically  # noqa: E402

MOST_WINDOW = 7  # max side of the window of the SSIM [cells], the default of scikit-image
_WEAK = 0.3  # below this absolute rank correlation, the headline states "no steady trend"
FEWEST_CELLS = 10  # min number of cells for a comparison
NEXT_TO = 2.0  # max distance at which a cell counts as next to a device or port [cells]
_COLUMN = 2.4  # width of a map in the figure; a map alone has twice this width [inch]
_RELATION = 2.1  # height of a chart of the second row [inch]
_GAP = 1.0  # between columns and between rows [inch]
_TOP = 1.15  # height of the titles with a headline of one line [inch]
_BOTTOM = 1.05  # height of the legend and of the labels of the last row [inch]
_LINE = 0.22  # height of a line of the headline [inch]
_LETTER = 0.11  # mean width of a letter of the headline (bold, 13 points) with a reserve [inch]
_LOW_COLOUR = "#440154"  # the first colour of viridis
# viridis without its yellow part, as in other pictures of values
_VALUE_COLOURS = colors.ListedColormap(pyplot.get_cmap("viridis")(np.linspace(0.0, 0.8, 256)))
_DISTANCE = "distance to a device"
_SHORT = {_DISTANCE: "distance"}  # short names for titles
_SEA_COLOURS = {"depth": "Blues", "warmth": "YlOrRd"}
_LOWEST = 0.05  # the cells with the lowest returns, this fraction of all, have one colour

NOTE = ("Spearman's rho compares the ranks of the cells in which both maps are known. Neighbouring "
        "cells are alike, so no significance is given. SSIM is the mean structural similarity "
        "(Wang et al. 2004) of both maps, scaled to [0, 1], over the same cells; other cells get "
        "the nearest known value. The second SSIM is that of the inverted sea map, for a sea that "
        "falls where V_π rises. Both numbers measure how alike two maps are, not whether one "
        "causes the other.")


class ValuesError(Exception):
    """A file or a request is invalid. The message is one line."""


def read(path):
    """Reads a file of aquafarm_evaluate --values. Returns its JSON object; V_π [H, W], rows from
    the south, NaN where it is undefined; and the sea layers [(name, unit, [H, W])]. Raises
    ValuesError."""
    try:
        text = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        values = np.array(text["values"], dtype=float)
        layers = [(layer["name"], layer["units"], np.array(layer["values"], dtype=float))
                  for layer in text["seas"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ValuesError(f"{path}: not a file of aquafarm_evaluate --values: {error}") from error
    if values.ndim != 2 or any(layer[2].shape != values.shape for layer in layers):
        raise ValuesError(f"{path}: got maps of different sizes, expected them all alike")
    return text, values, layers


def filled(field, known):
    """Replaces the unknown values of a field by the nearest known ones."""
    nearest = ndimage.distance_transform_edt(~known, return_distances=False, return_indices=True)
    return field[tuple(nearest)]


def scaled(field, known):
    low, high = field[known].min(), field[known].max()
    return (filled(field, known) - low) / (high - low)


def compare(values, field):
    """Returns the similarity of two maps over the cells where both are known: cells, spearman_rho,
    ssim, and ssim_turned, which is the SSIM with the second map inverted.

    Measures are None if they are undefined: fewer than FEWEST_CELLS cells, or a constant map. The
    SSIM is also None if a side of the maps is shorter than 3 cells.
    """
    known = np.isfinite(values) & np.isfinite(field)
    result = {"cells": int(known.sum()), "spearman_rho": None, "ssim": None, "ssim_turned": None}
    if result["cells"] < FEWEST_CELLS or np.ptp(values[known]) == 0 or np.ptp(field[known]) == 0:
        return result
    result["spearman_rho"] = float(stats.spearmanr(values[known], field[known]).correlation)
    window = min(MOST_WINDOW, *values.shape)
    window -= 1 - window % 2  # odd
    if window < 3:
        return result
    first, second = scaled(values, known), scaled(field, known)
    for key, other in (("ssim", second), ("ssim_turned", 1.0 - second)):
        _, similar = structural_similarity(first, other, win_size=window, data_range=1.0, full=True)
        result[key] = float(similar[known].mean())
    return result


def signed(number):
    return "-" if number is None else f"{number:+.2f}".replace("-", "−")


def place_words(cell, text):
    """Returns the position of a cell [east, north] as text, such as "next to a device". It names
    the nearest device or port if that is within NEXT_TO, and is empty if there is none."""
    east, north = cell
    near = [(math.hypot(east - x, north - y), words)
            for words, key in (("device", "devices"), ("port", "ports"))
            for x, y in text.get(key) or []]
    if not near or min(near)[0] > NEXT_TO:
        return ""
    distance, words = min(near)
    return f"{'at' if distance < 1.0 else 'next to'} a {words}"


def best_cell(values):
    """Returns the cell [east, north] with the highest return; None if all are equal or unknown."""
    known = values[np.isfinite(values)]
    if not len(known) or np.ptp(known) == 0.0:
        return None
    north, east = np.unravel_index(np.nanargmax(values), values.shape)
    return int(east), int(north)


def verdict(values, text):
    """Returns the range of the returns and the position of the best start as text. Empty if all
    values are equal or unknown."""
    best = best_cell(values)
    if best is None:
        return ""
    low, high = np.nanmin(values), np.nanmax(values)
    share = f" (a difference of {100.0 * (high - low) / high:.0f} %)" if low > 0.0 else ""
    place = place_words(best, text)
    return (f"All returns are between {low:.0f} and {high:.0f} points{share}.\nBest start: the "
            f"star on map (a){f', {place}' if place else ''}; lowest returns: dark on map (a)")


def device_distance(shape, devices, km):
    """Returns the distance of each cell to the nearest device, as a layer like those of the sea."""
    north, east = np.indices(shape)
    away = np.min([np.hypot(east - x, north - y) for x, y in devices], axis=0)
    return _DISTANCE, "km", away * km


def lowest_cells(values):
    """Returns a bool array [H, W]: whether a cell is in the twentieth with the lowest values."""
    known = values[np.isfinite(values)]
    return values < np.quantile(known, _LOWEST) if len(known) else np.zeros(values.shape, bool)


def sea_words(name):
    """Returns the display name of a sea layer."""
    return {"warmth": "temperature"}.get(name, name.replace("_", " "))


def unit_text(units):
    """Returns the display name of a unit."""
    return {"degC": "°C", "degF": "°F"}.get(units, units)


def draw_map(axis, field, km, colours, unit, lowest=0.0):
    """Draws a map with north at the top. Cells without a value, such as land, are hatched.

    km: side of a cell [km]
    lowest: the cells with the lowest values, this fraction of all, have one colour
    """
    height, width = field.shape
    axis.set_facecolor("0.82")
    axis.patch.set(hatch="////", edgecolor="0.65", linewidth=0.0)
    known = field[np.isfinite(field)]
    low, high = np.quantile(known, (lowest, 1.0)) if len(known) else (0.0, 1.0)
    image = axis.imshow(field, origin="lower", cmap=colours, vmin=low, vmax=high,
                        extent=(0, width * km, 0, height * km))
    bar = axis.figure.colorbar(image, cax=axis.inset_axes([1.03, 0.0, 0.05, 1.0]),
                               extend="min" if lowest > 0.0 else "neither")
    bar.ax.set_title(unit, fontsize=9.5)
    axis.set_xlabel("east [km]")


def draw_places(axis, text, km, best=None):
    """Marks the ports, and the devices at the start of the episode, if the file contains them.
    Marks the cell `best` [east, north] with a star, unless it is None."""
    for key, words, marker in (("ports", "port", "o"), ("devices", "device", "D")):
        if cells := text.get(key):
            x, y = zip(*(((east + 0.5) * km, (north + 0.5) * km) for east, north in cells))
            axis.scatter(x, y, s=46, facecolor="white", edgecolor="black", linewidth=1.6,
                         label=words, zorder=3, marker=marker)
    if best:
        axis.scatter(*((place + 0.5) * km for place in best), s=130, marker="*", zorder=4,
                     facecolor="#f0e442", edgecolor="black", label="best start")


def draw_relation(axis, values, layer, result, letter):
    """Plots the return against the value of a layer: a dot for each cell, and a line through the
    medians of ten groups of cells with similar values of the layer."""
    name, units, field = layer
    known = np.isfinite(values) & np.isfinite(field)
    x, y = field[known], values[known]
    low = lowest_cells(values)
    axis.scatter(x, y, s=9, color="#0072b2", alpha=0.35, linewidth=0, label="a cell")
    axis.scatter(field[known & low], values[known & low], s=12, color=_LOW_COLOUR, linewidth=0,
                 label="a cell of the lowest twentieth")
    if len(x) >= FEWEST_CELLS and np.ptp(x) > 0.0:
        parts = np.array_split(np.argsort(x, kind="stable"), 10)
        axis.plot([np.median(x[part]) for part in parts], [np.median(y[part]) for part in parts],
                  color="#d55e00", linewidth=2, marker="o", markersize=4,
                  label="median of 1/10 of the cells")
    words = sea_words(name)
    axis.set_xlabel(f"{words} [{unit_text(units)}]")
    rest = compare(np.where(low, np.nan, values), field)["spearman_rho"]
    said = (f"Return and {_SHORT.get(words, words)}: {signed(result['spearman_rho'])}\n"
            f"without the lowest twentieth: {signed(rest)}"
            if result["spearman_rho"] is not None else
            f"{result['cells']} cells:\ntoo few or too alike to compare")
    axis.set_title(f"({letter}) {said}", fontsize=11, loc="left")
    axis.xaxis.set_major_locator(ticker.MaxNLocator(5))
    axis.yaxis.set_major_locator(ticker.MaxNLocator(7, steps=[1, 2, 5, 10]))
    axis.grid(alpha=0.3)


def draw(text, values, layers, results, path):
    """Draws the maps side by side. If there are layers of the sea, a second row has a chart below
    each map. Below a map of the sea, the chart shows the return against the layer's value. Below
    the map of returns, it shows the return against the distance to the nearest device; this chart
    is missing if there are no devices."""
    km = text["cell_size_m"] / 1000.0
    height, width = values.shape
    tall = min(1.6, max(0.5, height / width))
    columns = 1 + len(layers)
    column_in = _COLUMN if layers else 2.0 * _COLUMN
    heights = [column_in * tall, _RELATION] if layers else [column_in * tall]
    width_in = _GAP * (columns + 0.6) + column_in * columns
    near = device_relation(values, text)
    found = textwrap.wrap(headline([*zip(layers, results), *([near] if near else [])]),
                          int(width_in / _LETTER)) or [""]
    top = _TOP + _LINE * (len(found) - 1)
    height_in = top + sum(heights) + _GAP * (len(heights) - 1) + _BOTTOM
    figure, axes = pyplot.subplots(len(heights), columns, squeeze=False,
                                   figsize=(width_in, height_in), height_ratios=heights)
    figure.subplots_adjust(
        left=0.8 * _GAP / width_in, right=1.0 - 0.8 * _GAP / width_in, wspace=_GAP / column_in,
        top=1.0 - top / height_in, bottom=_BOTTOM / height_in,
        hspace=_GAP / (sum(heights) / len(heights)))
    draw_map(axes[0][0], values, km, _VALUE_COLOURS, "points", _LOWEST)
    letters = iter("abcdefghijklmnopqrstuvwxyz")
    axes[0][0].set_title(f"({next(letters)}) Return from each start", fontsize=11,
                         loc="left")
    draw_places(axes[0][0], text, km, best_cell(values))
    axes[0][0].set_ylabel("north [km]")
    for column, (layer, result) in enumerate(zip(layers, results), start=1):
        name, units, field = layer
        draw_map(axes[0][column], np.where(np.isfinite(values), field, np.nan), km,
                 _SEA_COLOURS.get(name, "cividis"), unit_text(units))
        words = sea_words(name)
        axes[0][column].set_title(f"({next(letters)}) {words[:1].upper()}{words[1:]} of the sea",
                                  fontsize=11, loc="left")
        draw_places(axes[0][column], text, km)
    if layers:
        draw_relations(axes[1], values, near, list(zip(layers, results)), letters)
    draw_key(figure, axes)
    episodes = (f"Episode {text['episode']}" if text["episodes"] == 1
                else f"Mean of {text['episodes']} episodes")
    figure.suptitle("\n".join(found), fontsize=13, weight="bold", x=0.02, y=0.99, ha="left")
    said = verdict(values, text)
    figure.text(0.02, 1.0 - (0.1 + _LINE * len(found)) / height_in, "\n".join([
        *([said] if said else []),
        f"{episodes} of {text['policy']} on {text['scenario']}"]),
        fontsize=10.5, color="0.25", va="top")
    with open_atomically(path, "wb") as file:
        figure.savefig(file, dpi=150, format="png")
    pyplot.close(figure)


def headline(relations):
    """Returns the sentence above the figure, which states the rank correlations of the return.
    Empty if no correlation is defined.

    relations: [(layer, result of compare)]
    """
    pairs = [(sea_words(name), result["spearman_rho"]) for (name, _, _), result in relations]
    said = {"falls": [], "rises": [], "has no steady trend": []}
    for words, rho in sorted((pair for pair in pairs if pair[1] is not None),
                             key=lambda pair: -abs(pair[1])):
        trend = "has no steady trend" if abs(rho) < _WEAK else "falls" if rho < 0.0 else "rises"
        known = any(said.values())
        said[trend].append(f"{words} ({'' if known else 'rank correlation '}{signed(rho)})")
    none = said.pop("has no steady trend")
    text = " and ".join(f"{trend} with {' and '.join(names)}" for trend, names in said.items()
                        if names)
    if none:
        text += f"{', but ' if text else ''}has no steady trend with {' or '.join(none)}"
    return f"The return {text}" if text else ""


def device_relation(values, text):
    """Returns the layer of device_distance and its similarity to the returns (compare); None
    without devices."""
    if not (devices := text.get("devices")):
        return None
    away = device_distance(values.shape, devices, text["cell_size_m"] / 1000.0)
    return away, compare(values, away[2])


def draw_relations(axes, values, near, seas, letters):
    """Draws the second row: the return against the distance to a device and against each sea layer.

    near: result of device_relation
    seas: [(layer, result of compare)]
    """
    if near:
        draw_relation(axes[0], values, *near, next(letters))
    else:
        axes[0].axis("off")
    for axis, (layer, result) in zip(axes[1:], seas):
        draw_relation(axis, values, layer, result, next(letters))
    axes[0 if near else 1].set_ylabel("return [points]")


def draw_key(figure, axes):
    """Draws one legend of all symbols at the lower edge."""
    signs = {}
    for axis in axes.flat:
        signs.update((label, handle) for handle, label in zip(*axis.get_legend_handles_labels()))
    signs["land, rocks or unknown"] = patches.Patch(facecolor="0.82", edgecolor="0.65", hatch="////")
    figure.legend(signs.values(), signs.keys(), loc="lower center", frameon=False, fontsize=10.5,
                  ncols=4, columnspacing=1.5)


def make(values_file, output):
    """Writes <output>.png and <output>.json. Returns a list with a summary line for each sea layer.
    Raises ValuesError."""
    text, values, layers = read(values_file)
    results = [compare(values, field) for _, _, field in layers]
    draw(text, values, layers, results, f"{output}.png")
    report = {key: text[key] for key in ("scenario", "scenario_hash", "policy", "farm_seed",
                                         "episode", "episodes", "what")}
    report["note"] = NOTE
    report["seas"] = [{"name": name, "units": units, **result}
                      for (name, units, _), result in zip(layers, results)]
    with open_atomically(f"{output}.json") as file:
        file.write(json.dumps(report, indent=1) + "\n")
    return [f"{sea_words(name)}: rank correlation (Spearman) {signed(result['spearman_rho'])}, similarity of the "
            f"maps (SSIM) {signed(result['ssim'])}, of the inverted map {signed(result['ssim_turned'])}, "
            f"over {result['cells']} cells"
            for (name, _, _), result in zip(layers, results)]
