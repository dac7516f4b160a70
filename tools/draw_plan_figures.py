#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of docs/plan.md from the results of aquafarm_measure_plan.

  tools/draw_plan_figures.py docs/results/plan_storms.json docs/results/plan_back_test.json docs/images
"""
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # needs no display
from matplotlib import pyplot as plt  # noqa: E402

DPI = 110


def draw_reliability(data, path):
    """Promised against kept chances, with 95 % intervals and the limits of the bars."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.6), sharey=True)
    titles = {"home": "the device comes home", "gales": "gales reach the device"}
    for one, (key, title) in zip(axes, titles.items()):
        bins = [b for b in data[key]["diagram"] if b["count"] >= 20]
        x = [100 * b["promised"] for b in bins]
        y = [100 * b["kept"]["mean"] for b in bins]
        error = [100 * (b["kept"]["mean"] - b["kept"]["low"]) for b in bins]
        one.plot([0, 100], [0, 100], color="black", linewidth=0.8)
        one.fill_between([0, 100], [-5, 95], [5, 105], color="0.88", label="within 5 points")
        one.errorbar(x, y, yerr=error, fmt="o", color="black", markersize=4, capsize=2,
                     label="20 bins, 95 % interval")
        one.set_title(title)
        one.set_xlabel("promised chance [%]")
        one.set_xlim(0, 100)
        one.set_ylim(0, 100)
        one.set_aspect("equal")
        one.grid(alpha=0.3)
    axes[0].set_ylabel("share of cases in which it happened [%]")
    axes[0].legend(loc="upper left", fontsize=8)
    figure.suptitle(f"{data['storms']} simulated storms, {data['members']} members")
    figure.savefig(path, dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def finding(storms):
    """What the back-test found, in a sentence."""
    as_good = sum(s["saved"] > s["clairvoyant"] - 0.5 for s in storms)
    share = sum(s["saved"] for s in storms) / sum(s["clairvoyant"] for s in storms)
    less = sum(s["promised"] < s["saved"] for s in storms)
    return (f"In {as_good} of {len(storms)} recorded storms the plan saves what a clairvoyant saves "
            f"({share:.0%} in all);\nin {less} it saves more than it promised before the storm")


def draw_back_test(data, path):
    """Saved, promised and clairvoyant value of each recorded storm."""
    storms = data["storms"]
    figure, axes = plt.subplots(figsize=(7, 0.24 * len(storms) + 1.2))
    places = range(len(storms), 0, -1)
    low = [max(0.0, s["saved"] - s["saved_low"]) for s in storms]
    high = [max(0.0, s["saved_high"] - s["saved"]) for s in storms]
    axes.barh(places, [s["at_risk"] for s in storms], color="0.9", label="lost if no ship leaves")
    axes.errorbar([s["saved"] for s in storms], places, xerr=[low, high], fmt="o", color="black",
                  markersize=4, capsize=2, label="saved (mean, smallest to largest)")
    axes.plot([s["promised"] for s in storms], places, "x", color="tab:blue", label="promised (before the storm)")
    axes.plot([s["clairvoyant"] for s in storms], places, "|", color="tab:red", markersize=11,
              label="clairvoyant")
    axes.set_yticks(list(places), [f"{s['name'] or s['id']} {s['nearest'][:4]}" for s in storms],
                    fontsize=8)
    axes.set_xlabel("units of value")
    axes.set_ylim(0.3, len(storms) + 0.7)
    axes.grid(alpha=0.3, axis="x")
    axes.legend(fontsize=8, ncol=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))  # above the bars
    figure.suptitle(finding(storms), fontsize=11, y=1.03)
    figure.savefig(path, dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    storms, back_test = (json.loads(Path(name).read_text(encoding="utf-8"))
                         for name in sys.argv[1:3])
    folder = Path(sys.argv[3])
    draw_reliability(storms, folder / "plan_reliability.png")
    draw_back_test(back_test, folder / "plan_back_test.png")


if __name__ == "__main__":
    main()
