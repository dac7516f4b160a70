# SPDX-License-Identifier: BSD-3-Clause
"""Style of the benchmark's figures: headlines, names of lines, colours."""
import textwrap

import matplotlib

matplotlib.use("Agg")  # needs no display
import numpy as np  # noqa: E402
from matplotlib import colors, pyplot as plt  # noqa: E402

_DPI = 150
_LETTERS = 78  # max length of a line of a headline
_NOTE = {"fontsize": 9.5, "color": "0.35"}
_NOTE_LETTERS = 14  # max length of a line of a note, per inch of the figure's width
_COLUMNS = 3  # max number of small charts in a row
_NAME_PT = 15.0  # height of a name [pt]
# Max distance along x between line ends with names in one column [fraction of the axes' width].
_NEAR = 0.15
# Max y of the name of a line that ends inside the axes [fraction of the axes' height].
_INSIDE = 0.78
_TEXT = 4.5  # min contrast ratio of names on white (WCAG 2.1, success criterion 1.4.3)
plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False,
                     "axes.titlelocation": "left"})


def save(figure, path, dpi=_DPI):
    """Writes a figure as PNG and closes it."""
    figure.savefig(path, dpi=dpi, bbox_inches="tight")
    plt.close(figure)


def explain(figure, finding, note):
    """Writes the finding above a figure, in bold, and the note below it."""
    figure.suptitle("\n".join(wrap_evenly(finding)), fontsize=12.5, weight="bold", x=0.01,
                    ha="left")
    width = max(_LETTERS, int(_NOTE_LETTERS * figure.get_figwidth()))
    figure.supxlabel("\n".join(textwrap.wrap(note, width)), x=0.01, ha="left", **_NOTE)


def wrap_evenly(text):
    """Wraps a text into as few lines as possible, of about the same length."""
    width, lines = _LETTERS, textwrap.wrap(text, _LETTERS, break_on_hyphens=False)
    while len(lines) > 1:
        width -= 1
        narrower = textwrap.wrap(text, width, break_on_hyphens=False)
        if len(narrower) > len(lines):
            break
        lines = narrower
    return lines


def label_axes(axes, title, ylabel, xlabel="episode"):
    """Writes the title and the names of the axes, and draws a faint grid."""
    axes.set_title(title)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    if xlabel == "episode":
        axes.xaxis.set_major_formatter(lambda value, _: number(value))
    axes.grid(alpha=0.3)


def chart_grid(count, ylabel=""):
    """Creates `count` charts by episode with one scale, up to _COLUMNS in a row. The lowest charts
    have the name of the x axis, and the left ones that of the y axis. Returns (figure, charts)."""
    columns = min(_COLUMNS, count)
    rows = -(-count // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(max(3.1 * columns, 6.2), 1.2 + 2.5 * rows),
                                squeeze=False, sharex=True, sharey=True, layout="constrained")
    for i, axes in enumerate(grid.flat):
        label_axes(axes, "", ylabel if i % columns == 0 else "")
        axes.tick_params(labelbottom=True, labelleft=i % columns == 0)
        if i + columns < count:
            axes.set_xlabel("")
        if i >= count:
            axes.axis("off")
    return figure, list(grid.flat)[:count]


def number(value, digits=0):
    """Formats a number with thousands separators and a minus sign: "−1,571"."""
    return f"{value:,.{digits}f}".replace("-", "−")


def joined(words):
    """Returns a list of words as text: "A, B and C"."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


def spread(places, gap, low=0.0, high=1.0):
    """Moves places apart to distances of at least `gap`, with the least sum of squared movements.
    Then moves them into [low, high]. If they do not fit, they begin at `low` and exceed `high`.
    Expects and returns the places in ascending order."""
    groups = []  # (position of the first place, number of places) of places that touch each other
    for i, place in enumerate(places):
        groups.append((place - i * gap, 1))
        while len(groups) > 1 and groups[-2][0] >= groups[-1][0]:
            (first, n), (second, m) = groups[-2:]
            groups[-2:] = [((n * first + m * second) / (n + m), n + m)]
    moved = [start for start, count in groups for _ in range(count)]
    room = high - gap * (len(places) - 1)
    return [min(max(start, low), max(room, low)) + i * gap for i, start in enumerate(moved)]


def name_ends(axes, ends):
    """Writes the name of each line to the right of the line's end, and connects name and end. The
    names of lines that end at the right border of the axes do not overlap each other. Neither do
    the names of lines that end further left.

    ends: the line ends, as curves.End
    """
    axes.margins(x=0.0)
    axes.set_ylim(axes.get_ylim())  # fixes the limits
    ends = sorted(ends, key=lambda end: end.y)
    axes.figure.draw_without_rendering()  # sets the size of the axes
    to_axes = axes.transData + axes.transAxes.inverted()
    height_pt = 72.0 * axes.get_window_extent().height / axes.figure.dpi
    at = {end: [float(value) for value in to_axes.transform(end[:2])] for end in ends}
    gap = _NAME_PT / height_pt
    places = {}
    for is_inside, high in ((True, _INSIDE), (False, 1.0 + 0.3 * gap)):
        group = [end for end in ends if (at[end][0] < 1.0 - _NEAR) == is_inside]
        places.update(zip(group, spread([at[end][1] for end in group], gap, high=high)))
    for end, place in places.items():
        # A name stands to the right of all line ends that are up to _NEAR to the right of its own.
        right = max(length for length, _ in at.values() if length <= at[end][0] + _NEAR)
        axes.annotate(end.name, end[:2], xytext=(min(right, 1.0) + 0.04, place), va="center",
                      textcoords=axes.transAxes, color=legible(end.colour), fontsize=10,
                      annotation_clip=False,
                      bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
                      arrowprops={"arrowstyle": "-", "color": end.colour, "linewidth": 0.8,
                                  "relpos": (0.0, 0.5), "shrinkA": 1.0, "shrinkB": 0.0})
    if axes.get_subplotspec() and not axes.get_subplotspec().is_last_col():
        for text in axes.texts:  # no chart is to the right, so no space has to be reserved
            text.set_in_layout(False)


def line_style(one):
    """Returns matplotlib's options for the line of a contestant."""
    return {"color": one.colour, "linestyle": one.linestyle}


def legible(colour):
    """Returns a colour, darkened until it is legible on white."""
    rgb = np.array(colors.to_rgb(colour))
    while True:
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        if 1.05 / (float(linear @ (0.2126, 0.7152, 0.0722)) + 0.05) >= _TEXT:
            return tuple(rgb)
        rgb = 0.95 * rgb


def shade(axes, x, low, high, colour):
    """Shades the area between low and high. Its thin edges stay visible where areas overlap."""
    axes.fill_between(x, low, high, facecolor=(*colors.to_rgb(colour), 0.16),
                      edgecolor=(*colors.to_rgb(colour), 0.45), linewidth=0.5)
