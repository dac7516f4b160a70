# SPDX-License-Identifier: BSD-3-Clause
"""V_π next to the sea (Fig. 10): heat maps on the same cells, with their similarity."""
import json
import os
import pathlib

import matplotlib

matplotlib.use("Agg")
import numpy as np  # noqa: E402
from matplotlib import pyplot  # noqa: E402
from scipy import ndimage, stats  # noqa: E402
from skimage.metrics import structural_similarity  # noqa: E402

MOST_WINDOW = 7  # cells on a side, as in scikit-image
FEWEST_CELLS = 10

NOTE = ("Spearman's rho is of the ranks over the cells where both are known; neighbouring cells "
        "are alike, so no significance is given. SSIM is the mean structural similarity (Wang et "
        "al. 2004) of both maps scaled to [0, 1], over those cells, the others filled with the "
        "nearest known value; the second one is of the map turned over, for a sea that falls "
        "where V_π rises. Both say how alike two maps are, not that one causes the other.")


class ValuesError(Exception):
    """Reason why a file or a request is invalid, in one line."""


def read(path):
    """Reads V_π [H, W] from the south, NaN where undefined, and the layers of the sea."""
    try:
        text = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        values = np.array(text["values"], dtype=float)
        layers = [(layer["name"], layer["units"], np.array(layer["values"], dtype=float))
                  for layer in text["seas"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ValuesError(f"{path}: got no values of aquafarm_evaluate: {error}") from error
    if values.ndim != 2 or any(layer[2].shape != values.shape for layer in layers):
        raise ValuesError(f"{path}: got maps of different sizes, expected them all alike")
    return text, values, layers


def filled(field, known):
    """The field with unknown values replaced by the nearest known ones."""
    nearest = ndimage.distance_transform_edt(~known, return_distances=False, return_indices=True)
    return field[tuple(nearest)]


def scaled(field, known):
    low, high = field[known].min(), field[known].max()
    return (filled(field, known) - low) / (high - low)


def compare(values, field):
    """Similarity of two maps over the cells where both are known.

    Measures are None if undefined: too few cells, or a constant map.
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


def said(number):
    return "-" if number is None else f"{number:+.2f}"


def draw(text, values, layers, results, path):
    """Draws the maps side by side, north up, land in grey."""
    maps = [("$V_\\pi$", "points", values, "magma", "")]
    maps += [(name, units, field, "viridis",
              f"rho {said(result['spearman_rho'])}, SSIM {said(result['ssim'])} "
              f"(turned {said(result['ssim_turned'])})")
             for (name, units, field), result in zip(layers, results)]
    km = text["cell_size_m"] / 1000.0
    height, width = values.shape
    figure, axes = pyplot.subplots(1, len(maps), figsize=(4.6 * len(maps), 4.4), squeeze=False,
                                   constrained_layout=True)
    for axis, (name, units, field, colours, words) in zip(axes[0], maps):
        axis.set_facecolor("0.6")
        image = axis.imshow(field, origin="lower", cmap=colours,
                            extent=(0, width * km, 0, height * km))
        figure.colorbar(image, ax=axis, shrink=0.8, label=units)
        axis.set_title(name)
        axis.set_xlabel(f"east [km]\n{words}")
    axes[0][0].set_ylabel("north [km]")
    episodes = (f"episode {text['episode']}" if text["episodes"] == 1
                else f"mean of {text['episodes']} episodes")
    figure.suptitle(f"{text['scenario']}: what starting in a cell pays, and the sea ({episodes})")
    temporary = f"{path}.part"
    figure.savefig(temporary, dpi=110, format="png")
    pyplot.close(figure)
    os.replace(temporary, path)


def make(values_file, output):
    """Writes <output>.png and <output>.json. @returns the summary as readable lines"""
    text, values, layers = read(values_file)
    results = [compare(values, field) for _, _, field in layers]
    draw(text, values, layers, results, f"{output}.png")
    report = {key: text[key] for key in ("scenario", "scenario_hash", "policy", "farm_seed",
                                         "episode", "episodes", "what")}
    report["note"] = NOTE
    report["seas"] = [{"name": name, "units": units, **result}
                      for (name, units, _), result in zip(layers, results)]
    temporary = f"{output}.json.part"
    pathlib.Path(temporary).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    os.replace(temporary, f"{output}.json")
    return [f"{name}: Spearman {said(result['spearman_rho'])}, SSIM {said(result['ssim'])}, "
            f"turned over {said(result['ssim_turned'])}, over {result['cells']} cells"
            for (name, _, _), result in zip(layers, results)]
