# SPDX-License-Identifier: BSD-3-Clause
"""Draws the returns of greedy episodes as PNG from the data of results.py."""
import numpy as np

from aquafarm_benchmark.style import label_axes, plt, save


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
