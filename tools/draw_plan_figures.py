#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of docs/plan.md from the results of aquafarm_measure_plan.

  tools/draw_plan_figures.py docs/results/plan_storms.json docs/results/plan_back_test.json docs/images
"""
import json
import sys
import textwrap
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # needs no display
from matplotlib import pyplot as plt  # noqa: E402

DPI = 160
NAMED = 3  # max number of storms that a title names
MARGIN = 5  # max difference of kept and promised chance of a group that is not marked [points]
LETTERS = 82  # max length of a line of a title of the back-test
RIM = 3  # space around chances of 0 and 100 %, so that their marks are whole [points]
# Why the mean promise is below the mean saved value (docs/results/rescue_plans.md).
WHY_LOWER = ("A promise covers all tracks that the bulletin allows. These storms were selected "
             "because they came near,\nwhich a plan does not know in advance.")
KINDS = {"home": "The device comes home", "gales": "Gales reach the device"}


def bins_of(data, key):
    """Returns the bins of promised chances that have 20 cases or more."""
    return [one for one in data[key]["diagram"] if one["count"] >= 20]


def off_by(group):
    """Returns the difference between the kept and the promised chance of a group [points]."""
    return abs(100 * (group["kept"]["mean"] - group["promised"]))


def is_far(group):
    """Returns whether the kept chance of a group differs from the promised one by more than MARGIN
    points."""
    return off_by(group) > MARGIN


def is_missed(group):
    """Returns whether the 95 % interval of a group does not contain the promise."""
    return not group["kept"]["low"] <= group["promised"] <= group["kept"]["high"]


def reliability(data):
    """Returns sentences about how well the promises hold in simulated storms, in lines of LETTERS
    letters."""
    bins = [one for key in KINDS for one in bins_of(data, key)]
    far = [one for one in bins if is_far(one)]
    sides = {"more" if one["kept"]["mean"] > one["promised"] else "less" for one in far}
    most = max(map(off_by, bins))
    points = f"{most:.0f} point{'' if round(most) == 1 else 's'}"
    worst = (f"; in {len(far)} it happens {sides.pop()} often than promised, by up to {points}."
             if len(sides) == 1 else f", at worst {points} off.")
    return textwrap.fill(
        f"Promised chances hold within {MARGIN} points in {len(bins) - len(far)} of {len(bins)} "
        f"groups{worst} The 95 % intervals of {len(bins) - sum(map(is_missed, bins))} groups "
        f"contain the promise ({data['storms']:,} simulated storms).", LETTERS)


def draw_groups(axes, bins, colour, label):
    """Draws the kept chance of groups of promises, with 95 % intervals. Draws nothing without
    groups, because an empty errorbar that is not clipped breaks the layout."""
    if not bins:
        return
    kept = [one["kept"] for one in bins]
    axes.errorbar([100 * one["promised"] for one in bins], [100 * one["mean"] for one in kept],
                  yerr=[[100 * max(0.0, one["mean"] - one["low"]) for one in kept],
                        [100 * max(0.0, one["high"] - one["mean"]) for one in kept]],
                  fmt="o", color=colour, markersize=6, capsize=3, label=label, clip_on=False,
                  zorder=3)


def draw_reliability(data, path):
    """Draws kept against promised chances, with 95 % intervals, and the numbers of cases."""
    figure, axes = plt.subplots(2, 2, figsize=(9, 6.3), sharex=True, sharey="row",
                                height_ratios=[4, 1], layout="constrained")
    most = max(off_by(group) for key in KINDS for group in bins_of(data, key))
    for one, sizes, (key, title) in zip(*axes, KINDS.items()):
        bins = bins_of(data, key)
        one.plot([0, 100], [0, 100], color="black", linewidth=0.8, label="kept exactly")
        one.fill_between([0, 100], [-MARGIN, 100 - MARGIN], [MARGIN, 100 + MARGIN], color="0.85",
                         label=f"within {MARGIN} points")
        draw_groups(one, [group for group in bins if not is_far(group)], "#0b5394",
                    "group, 95 % interval")
        draw_groups(one, [group for group in bins if is_far(group)], "#d55e00",
                    f"over {MARGIN} points off")
        missed = [group for group in bins if is_missed(group)]
        if missed:
            one.scatter([100 * group["promised"] for group in missed],
                        [100 * group["kept"]["mean"] for group in missed], s=190, facecolor="none",
                        edgecolor="black", linewidth=1.8, zorder=4, label="interval misses the promise")
        for group in bins:
            if is_far(group) and off_by(group) == most:
                is_more = group["kept"]["mean"] > group["promised"]
                one.annotate(f"{most:.0f} points", (100 * group["promised"],
                                                    100 * group["kept"]["mean"]), fontsize=10.5,
                             xytext=(-9, 11) if is_more else (9, -11), textcoords="offset points",
                             ha="right" if is_more else "left", va="center", color="#b04a00")
        one.set_title(f"{title} (n = {sum(b['count'] for b in bins):,})", fontsize=12)
        one.set_xlim(-RIM, 100 + RIM)
        one.set_ylim(-RIM, 100 + RIM)
        one.set_aspect("equal")
        one.grid(alpha=0.3)
        sizes.plot([100 * group["promised"] for group in bins], [group["count"] for group in bins],
                   "o", color="#0b5394", markersize=5)
        sizes.set_yscale("log")
        sizes.set_ylim(10, 20_000)
        sizes.set_yticks([10, 100, 1_000, 10_000], ["10", "100", "1,000", "10,000"])
        sizes.minorticks_off()
        sizes.grid(alpha=0.3)
        sizes.set_xlabel("promised chance [%]", fontsize=11)
    axes[0][0].set_ylabel("share of cases\nin which it happened [%]", fontsize=11)
    axes[1][0].set_ylabel("cases per\ngroup (log)", fontsize=11)
    signs = {label: sign for one in axes[0]
             for sign, label in zip(*one.get_legend_handles_labels())}
    order = sorted(signs, key=lambda label: (label.startswith("interval"), "points off" in label))
    axes[0][0].legend([signs[label] for label in order], order, loc="lower right", fontsize=9)
    for words, x, y in (("more often", 20, 60), ("less often", 80, 30)):
        axes[0][1].text(x, y, f"{words}\nthan promised", ha="center", fontsize=11, color="0.3")
    figure.suptitle(reliability(data), fontsize=12.5, weight="bold", x=0.01, ha="left")
    figure.savefig(path, dpi=DPI)
    plt.close(figure)


def finding(storms):
    """Returns two sentences about the results of the back-test, in lines of LETTERS letters."""
    staked = [s for s in storms if s["at_risk"] > 0.5]  # in others, no plan loses value
    worse = [name_of(s) for s in staked if is_worse(s)]
    but = f" (not in {', '.join(worse)})" if 0 < len(worse) <= NAMED else ""
    share = sum(s["saved"] for s in storms) / sum(s["clairvoyant"] for s in storms)
    mean = mean_of(storms)
    kept = (f" and promises {100 * mean['promised'] / mean['saved']:.0f} % of what it saves"
            if mean["saved"] > 0.0 else "")
    return textwrap.fill(
        f"The plan saves what a clairvoyant saves in {len(staked) - len(worse)} of {len(staked)} "
        f"storms with something at stake{but}. Over all {len(storms)} storms it saves "
        f"{100 * share:.0f} % of the clairvoyant's value{kept}.", LETTERS)


def is_worse(storm):
    """Returns whether the plan saves less than a clairvoyant."""
    return storm["saved"] <= storm["clairvoyant"] - 0.5


def name_of(storm):
    """Returns the name and year of a storm. Archives write "IN-FA", "In-fa" or "In-Fa"; each part of
    a name begins with a capital letter, as in the other pictures."""
    return f"{(storm['name'] or storm['id']).title()} {storm['nearest'][:4]}"


def mean_of(storms):
    """Returns the mean of the values of several storms. The range of the saved value is empty."""
    mean = {key: sum(storm[key] for storm in storms) / len(storms)
            for key in ("at_risk", "promised", "saved", "clairvoyant")}
    return {**mean, "saved_low": mean["saved"], "saved_high": mean["saved"]}


def draw_back_test(data, path):
    """Draws four values for each recorded storm: at stake, saved by the plan, promised by the plan,
    and saved by a clairvoyant. The last row has the means of all storms."""
    storms = sorted(data["storms"], key=lambda storm: -storm["at_risk"])
    figure, axes = plt.subplots(figsize=(9, 0.27 * len(storms) + 2.6), layout="constrained")
    rows = [*storms, mean_of(storms)]
    places = [*range(len(storms), 0, -1), -0.4]
    low = [max(0.0, s["saved"] - s["saved_low"]) for s in rows]
    high = [max(0.0, s["saved_high"] - s["saved"]) for s in rows]
    axes.barh(places, [s["at_risk"] for s in rows], color="0.87",
              label="at stake: lost if no ship leaves")
    axes.plot([s["clairvoyant"] for s in rows], places, "|", color="#d55e00", markersize=17,
              markeredgewidth=3.5, label="saved by a clairvoyant")
    axes.errorbar([s["saved"] for s in rows], places, xerr=[low, high], fmt="o", color="black",
                  markerfacecolor="white", markersize=5, capsize=3,
                  label="saved by the plan (mean, range)")
    axes.plot([s["promised"] for s in rows], places, "x", color="#0072b2", markersize=7,
              markeredgewidth=1.8, label="promised (beyond the bar: a milder storm came)")
    for place, storm in zip(places, rows):
        if storm["at_risk"] <= 0.5:
            axes.text(max(storm["promised"], storm["saved"]) + 6, place, "nothing at stake",
                      va="center", fontsize=10, color="0.35")
        elif storm is not rows[-1] and is_worse(storm):
            axes.text(storm["clairvoyant"] + 4, place, va="center", fontsize=10,
                      s=f"saves {storm['saved']:.0f} of {storm['clairvoyant']:.0f}")
    mean = rows[-1]
    axes.text(mean["at_risk"] + 6, places[-1], va="center", fontsize=10.5,
              s=f"promised {mean['promised']:.1f}, saved {mean['saved']:.1f},\n"
              f"clairvoyant {mean['clairvoyant']:.1f}, at stake {mean['at_risk']:.1f}")
    axes.axhline(0.3, color="0.6", linewidth=0.8)
    axes.set_yticks(places, [*map(name_of, storms), f"mean of {len(storms)}"], fontsize=10.5)
    axes.get_yticklabels()[-1].set_weight("bold")
    axes.set_xlabel("value of devices [units]", fontsize=11)
    why = f"\n{WHY_LOWER}" if mean["promised"] < mean["saved"] else ""
    figure.supxlabel(f"One ship; means of {data['bulletins']} bulletins per storm, issued at least "
                     f"{data['lead_h']:.0f} h before the closest approach.{why}", x=0.01, ha="left",
                     fontsize=10.5, color="0.35")
    axes.set_xlim(-4, None)
    axes.set_ylim(-1.1, len(storms) + 0.7)
    axes.grid(alpha=0.3, axis="x")
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    handles, words = axes.get_legend_handles_labels()
    order = [words.index(word) for word in sorted(words)]
    axes.legend([handles[i] for i in order], [words[i] for i in order], fontsize=10.5, ncol=2,
                loc="lower left", bbox_to_anchor=(-0.15, 1.0), frameon=False, borderpad=0.2)
    figure.suptitle(finding(storms), fontsize=12.5, weight="bold", x=0.01, ha="left")
    figure.savefig(path, dpi=DPI)
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
