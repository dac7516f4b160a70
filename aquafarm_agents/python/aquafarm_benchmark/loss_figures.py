# SPDX-License-Identifier: BSD-3-Clause
"""Draws money losses as PNG from the data of results.py.

The functions plot_… draw on given axes.
"""
import numpy as np

from aquafarm_benchmark import losses
from aquafarm_benchmark.style import label_axes, line_style, plt, save


def draw_losses(path, contestants, rows):
    """Draws the exceedance curves of the losses, and next to them the mean loss by kind of
    device."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 4.5), layout="constrained")
    unit = next(row["money"]["currency"] for row in rows if row["money"])
    label_axes(left, "Exceedance of losses", "probability of a larger loss", f"loss x [{unit}]")
    plot_exceedance(left, contestants, rows)
    label_axes(right, "Mean loss by kind of device", f"loss per episode [{unit}]", "")
    plot_loss_by_kind(right, contestants, rows)
    save(figure, path)


def _with_money(contestants, rows):
    by_name = {row["name"]: row["money"] for row in rows}
    return [(one, by_name[one.name]) for one in contestants if by_name.get(one.name)]


def plot_exceedance(axes, contestants, rows):
    """Plots P(loss > x) by x for each contestant, as a step curve from x = 0. A mark on the 5 %
    line shows the CVaR."""
    for one, money in _with_money(contestants, rows):
        x, probability = money["exceedance"]
        axes.step([0.0, *x], [1.0 if x[0] > 0.0 else probability[0], *probability], where="post",
                  label=one.label, **line_style(one))
        axes.plot(money["cvar"], losses.TAIL, marker="v", color=one.colour)
    axes.axhline(losses.TAIL, color="black", linewidth=0.5, linestyle="--")
    axes.set_ylim(-0.02, 1.02)
    axes.legend(loc="best")


def plot_loss_by_kind(axes, contestants, rows):
    """Plots a group of bars for each kind of device, with a bar for each contestant. The lost part
    is stacked on the damaged part."""
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
