# SPDX-License-Identifier: BSD-3-Clause
"""Shows the returns of a benchmark's contestants: interquartile means with 95 % intervals."""
import math

from aquafarm_benchmark.measures import wilson_interval

from aquafarm_report import blocks

_ROW = 26  # height of a row [px]
_LEFT, _WIDTH = 170, 640  # left margin and width of the plot [px]


def share_text(rate, sample):
    """Returns a rate and its 95 % interval (Wilson) as "98 % [94 %, 99 %]". sample: sample size"""
    low, high = wilson_interval(round(rate * sample), sample)
    return f"{blocks.percent(rate)} [{blocks.percent(low)}, {blocks.percent(high)}]"


def by_return(rows):
    """Sorts rows of results.json, the best return first."""
    return sorted(rows, key=lambda row: -row["return_iqm"])


def _interval(row):
    low, high = row["return_interval"]
    return None if low is None or math.isnan(low) else (low, high)


def text(row):
    """Returns the interquartile mean and its interval as "160.2 [157.0, 163.4]"; without an
    interval only the mean."""
    found = _interval(row)
    return f"{row['return_iqm']:.1f}" + (f" [{found[0]:.1f}, {found[1]:.1f}]" if found else "")


def share(row):
    """Returns the share of the optimum in percent; "below 0" if it is negative; "–" if the optimum
    is unknown."""
    value = row.get("share_of_optimum")
    if value is None or math.isnan(value):
        return "–"
    return "below 0" if value < 0.0 else blocks.percent(value, 1)


def best_learner(rows):
    """Returns the row of the learner with the best return. References such as clairvoyant count
    only if there is no learner."""
    learners = [row for row in rows if row["stability"] is not None]
    return by_return(learners or rows)[0]


def table(rows):
    """Returns a table with a row for each contestant: return, share of the optimum, success,
    episodes."""
    return blocks.table(
        ["learner", "return per episode, 95 % interval", "share of the optimum", "success",
         "episodes, distinct"],
        [(row["label"], text(row), share(row), blocks.percent(row["success_rate"], 1),
          f"{row['evaluation_episodes']}, {row['distinct_episodes'] or '–'}")
         for row in by_return(rows)])


def _scale(rows):
    """Returns the range (low, high) of the chart. The range covers the contestants with a return
    above 0, or all contestants if no return is above 0."""
    shown = [row for row in rows if row["return_iqm"] > 0.0] or rows
    ends = [end for row in shown for end in (_interval(row) or ()) + (row["return_iqm"],)]
    margin = 0.04 * (max(ends) - min(ends)) or 1.0
    return min(ends) - margin, max(ends) + margin


def _ticks(low, high):
    """Returns three to eight round numbers in a range."""
    step = 10.0 ** math.floor(math.log10((high - low) / 3.0))
    step *= next(factor for factor in (5.0, 2.0, 1.0) if (high - low) / (factor * step) >= 3.0)
    return [i * step for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def chart(rows):
    """Returns a chart as SVG: a dot for each return and a line for its interval, with the best
    return at the top.

    An arrow to the left stands for a return below the range of the chart.
    """
    rows = by_return(rows)
    low, high = _scale(rows)
    height = _ROW * len(rows)

    def x(value):
        return _LEFT + _WIDTH * (min(max(value, low), high) - low) / (high - low)

    parts = [f'<line x1="{x(tick):.1f}" x2="{x(tick):.1f}" y1="0" y2="{height}" '
             f'stroke="currentColor" opacity=".18"/><text x="{x(tick):.1f}" y="{height + 17}" '
             f'text-anchor="middle">{tick:,.6g}</text>' for tick in _ticks(low, high)]
    for i, row in enumerate(rows):
        y = _ROW * i + _ROW / 2
        parts.append(f'<text x="{_LEFT - 10}" y="{y + 5}" text-anchor="end">'
                     f'{blocks.escape(row["label"])}</text>')
        if row["return_iqm"] < low:
            parts.append(f'<text x="{_LEFT + 4}" y="{y + 5}">← {row["return_iqm"]:,.1f}</text>')
            continue
        found = _interval(row)
        if found:
            parts.append(f'<line x1="{x(found[0]):.1f}" x2="{x(found[1]):.1f}" y1="{y}" y2="{y}" '
                         'stroke="currentColor" stroke-width="3" opacity=".5"/>')
        parts.append(f'<circle cx="{x(row["return_iqm"]):.1f}" cy="{y}" r="5" fill="currentColor">'
                     f"<title>{blocks.escape(row['label'])}: {text(row)}</title></circle>")
    return (f'<svg viewBox="0 0 {_LEFT + _WIDTH + 30} {height + 40}" '
            f'width="{_LEFT + _WIDTH + 30}" role="img" '
            'font-size="14" fill="currentColor" aria-label="return per episode with 95 % '
            f'intervals">{"".join(parts)}<text x="{_LEFT + _WIDTH / 2}" y="{height + 35}" '
            'text-anchor="middle">return per episode; line: 95 % interval</text></svg>')
