# SPDX-License-Identifier: BSD-3-Clause
"""Returns of the contestants of a benchmark (interquartile means) with their 95 % intervals."""
import math

from aquafarm_report import page

_ROW = 26  # height of a row [px]
_LEFT, _WIDTH = 170, 640  # of the plot [px]


def by_return(rows):
    """Rows of results.json, the best return first."""
    return sorted(rows, key=lambda row: -row["return_iqm"])


def _interval(row):
    low, high = row["return_interval"]
    return None if low is None or math.isnan(low) else (low, high)


def text(row):
    """Returns "160.2 [157.0, 163.4]"; without an interval the interquartile mean alone."""
    found = _interval(row)
    return f"{row['return_iqm']:.1f}" + (f" [{found[0]:.1f}, {found[1]:.1f}]" if found else "")


def share(row):
    """Share of the optimum in percent; "–" where the optimum is not known."""
    value = row.get("share_of_optimum")
    if value is None or math.isnan(value):
        return "–"
    return "below 0" if value < 0.0 else f"{value:.1%}"


def best_learner(rows):
    """The row of the learner with the best return; references such as clairvoyant do not count."""
    learners = [row for row in rows if row["stability"] is not None]
    return by_return(learners or rows)[0]


def table(rows):
    """One row for each contestant: return, share of the optimum, success, episodes."""
    return page.table(
        ["learner", "return per episode, 95 % interval", "share of the optimum", "success",
         "episodes, distinct"],
        [(row["label"], text(row), share(row), f"{row['success_rate']:.1%}",
          f"{row['evaluation_episodes']}, {row['distinct_episodes'] or '–'}")
         for row in by_return(rows)])


def chart(rows):
    """A dot for each return and a line for its interval, as SVG."""
    rows = by_return(rows)
    ends = [end for row in rows for end in (_interval(row) or ()) + (row["return_iqm"],)]
    low, high = min(ends), max(ends)
    span = (high - low) or 1.0

    def x(value):
        return _LEFT + 10 + (_WIDTH - 20) * (value - low) / span

    parts = []
    for i, row in enumerate(rows):
        y = _ROW * i + _ROW / 2
        found = _interval(row)
        if found:
            parts.append(f'<line x1="{x(found[0]):.1f}" x2="{x(found[1]):.1f}" y1="{y}" y2="{y}" '
                         'stroke="currentColor" stroke-width="3" opacity=".5"/>')
        parts.append(
            f'<text x="{_LEFT - 10}" y="{y + 5}" text-anchor="end">{page.escape(row["label"])}'
            f'</text><circle cx="{x(row["return_iqm"]):.1f}" cy="{y}" r="5" fill="currentColor">'
            f"<title>{page.escape(row['label'])}: {text(row)}</title></circle>")
    height = _ROW * len(rows) + 24
    for value, anchor in ((low, "start"), (high, "end")):
        parts.append(f'<text x="{x(value):.1f}" y="{height - 6}" text-anchor="{anchor}">'
                     f"{value:.1f}</text>")
    return (f'<svg viewBox="0 0 {_LEFT + _WIDTH} {height}" width="{_LEFT + _WIDTH}" role="img" '
            'font-size="14" fill="currentColor" aria-label="return per episode with 95 % '
            f'intervals">{"".join(parts)}</svg>')
