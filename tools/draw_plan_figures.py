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

DPI = 160
KINDS = {"home": "The device comes home", "gales": "Gales reach the device"}


def bins_of(data, key):
    """Returns the bins of promised chances that have 20 cases or more."""
    return [one for one in data[key]["diagram"] if one["count"] >= 20]


def reliability(data):
    """Returns a sentence about how well the promises hold in simulated storms."""
    bins = [one for key in KINDS for one in bins_of(data, key)]
    far = [100 * (one["kept"]["mean"] - one["promised"]) for one in bins]
    close = sum(abs(one) <= 5 for one in far)
    return (f"Promised chances are kept: {close} of {len(bins)} groups of promises within 5 points,\n"
            f"the others {'at most %.0f' % max(map(abs, far))} points off "
            f"({data['storms']:,} simulated storms)")


def draw_reliability(data, path):
    """Draws kept against promised chances, with 95 % intervals."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 5), sharey=True)
    for one, (key, title) in zip(axes, KINDS.items()):
        bins = bins_of(data, key)
        x = [100 * b["promised"] for b in bins]
        y = [100 * b["kept"]["mean"] for b in bins]
        low = [100 * max(0.0, b["kept"]["mean"] - b["kept"]["low"]) for b in bins]
        high = [100 * max(0.0, b["kept"]["high"] - b["kept"]["mean"]) for b in bins]
        one.plot([0, 100], [0, 100], color="black", linewidth=0.8, label="kept exactly")
        one.fill_between([0, 100], [-5, 95], [5, 105], color="0.85", label="within 5 points")
        one.errorbar(x, y, yerr=[low, high], fmt="o", color="#0b5394", markersize=5, capsize=3,
                     label="group of promises,\n95 % interval", clip_on=False, zorder=3)
        sizes = one.inset_axes([0.0, -0.34, 1.0, 0.14], sharex=one)
        sizes.bar(x, [b["count"] for b in bins], width=3.0, color="#0b5394")
        sizes.set_yscale("log")
        sizes.set_ylim(10, 20_000)
        sizes.set_ylabel("cases", fontsize=9.5)
        sizes.tick_params(labelsize=9)
        one.set_title(f"{title} (n = {sum(b['count'] for b in bins):,})", fontsize=11.5)
        one.set_xlabel("promised chance [%]", fontsize=11)
        one.set_xlim(0, 100)
        one.set_ylim(0, 100)
        one.set_aspect("equal")
        one.grid(alpha=0.3)
    axes[0].set_ylabel("share of cases in which it happened [%]", fontsize=11)
    axes[0].legend(loc="upper left", fontsize=10)
    for words, x, y in (("more often\nthan promised", 20, 56), ("less often\nthan promised", 80, 30)):
        axes[1].text(x, y, words, ha="center", fontsize=10, color="0.3")
    figure.suptitle(reliability(data), fontsize=12.5, weight="bold", x=0.07, y=1.0, ha="left")
    figure.savefig(path, dpi=DPI, bbox_inches="tight")
    plt.close(figure)


def finding(storms):
    """Returns a sentence about the results of the back-test."""
    staked = [s for s in storms if s["at_risk"] > 0.5]  # in others, no plan loses value
    as_good = sum(s["saved"] > s["clairvoyant"] - 0.5 for s in staked)
    share = sum(s["saved"] for s in storms) / sum(s["clairvoyant"] for s in storms)
    less = sum(s["promised"] < s["saved"] for s in storms)
    return (f"In {as_good} of {len(staked)} recorded storms with something at stake the plan saves "
            f"what a clairvoyant saves.\nOver all {len(storms)} storms it saves {100 * share:.0f} % of "
            f"the clairvoyant's value; in {less} it saves more than it promised.")


def name_of(storm):
    """Returns the name and year of a storm. One archive writes names in capitals; they are
    converted to title case."""
    name = storm["name"] or storm["id"]
    return f"{name.title() if name.isupper() else name} {storm['nearest'][:4]}"


def draw_back_test(data, path):
    """Draws four values for each recorded storm: at stake, saved by the plan, promised by the plan,
    and saved by a clairvoyant."""
    storms = sorted(data["storms"], key=lambda storm: -storm["at_risk"])
    figure, axes = plt.subplots(figsize=(8.2, 0.27 * len(storms) + 1.2))
    places = range(len(storms), 0, -1)
    low = [max(0.0, s["saved"] - s["saved_low"]) for s in storms]
    high = [max(0.0, s["saved_high"] - s["saved"]) for s in storms]
    axes.barh(places, [s["at_risk"] for s in storms], color="0.87",
              label="at stake: lost if no ship leaves")
    axes.plot([s["clairvoyant"] for s in storms], places, "|", color="#d55e00", markersize=17,
              markeredgewidth=3.5, label="saved by a clairvoyant")
    axes.errorbar([s["saved"] for s in storms], places, xerr=[low, high], fmt="o", color="black",
                  markerfacecolor="white", markersize=5, capsize=3, label="saved by the plan (mean, range)")
    axes.plot([s["promised"] for s in storms], places, "x", color="#0072b2", markersize=7,
              markeredgewidth=1.8, label="promised (beyond the bar: a milder storm came)")
    for place, storm in zip(places, storms):
        if storm["at_risk"] <= 0.5:
            axes.text(max(storm["promised"], storm["saved"]) + 6, place, "nothing at stake",
                      va="center", fontsize=9, color="0.35")
    axes.set_yticks(list(places), [name_of(s) for s in storms], fontsize=10)
    axes.set_xlabel("value of devices [units]", fontsize=11)
    axes.set_xlim(-4, None)
    axes.set_ylim(0.3, len(storms) + 0.7)
    axes.grid(alpha=0.3, axis="x")
    handles, words = axes.get_legend_handles_labels()
    order = [words.index(word) for word in sorted(words)]
    axes.legend([handles[i] for i in order], [words[i] for i in order], fontsize=10, ncol=2,
                loc="lower left", bbox_to_anchor=(-0.17, 1.0), frameon=False, borderpad=0.2)
    figure.suptitle(finding(storms), fontsize=12, weight="bold", x=-0.05, y=1.05, ha="left")
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
