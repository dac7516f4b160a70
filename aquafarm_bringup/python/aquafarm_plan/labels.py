# SPDX-License-Identifier: BSD-3-Clause
"""Places the labels of a map where they cover as little as possible."""
import dataclasses
import math
import unicodedata

# Widths of characters, as fractions of the font size, in a wide bold sans-serif font (DejaVu).
CHAR_WIDTH = 0.7
WIDTHS = {" ": 0.36, "%": 1.0}
_CROSSED = 60.0  # cost if a leader crosses a label
WIDE = ("W", "F")  # East Asian width classes (Unicode) of characters as wide as the font size


def text_width(text, size):
    """Returns the approximate width of a text [px]."""
    return size * sum(1.0 if unicodedata.east_asian_width(c) in WIDE else WIDTHS.get(c, CHAR_WIDTH)
                      for c in text)


def shorten(text, width, size):
    """Cuts a text to a max width [px]. A text that was cut ends with an ellipsis."""
    if text_width(text, size) <= width:
        return text
    while text and text_width(text + "…", size) > width:
        text = text[:-1]
    return text.rstrip() + "…"


@dataclasses.dataclass
class Label:
    """A text next to a point. `place` sets x and y, its lower left corner [px], and the leader."""
    lines: list
    anchor: tuple
    clearance: float  # radius of the symbol at the anchor [px]
    size: float = 13.0
    x: float = 0.0
    y: float = 0.0
    leader: str = ""  # path data of the line from the symbol to the label; empty if they are close
    name: str = ""
    badge: str = ""  # text in a box before the first line
    ship: int = 0  # index of the ship that fetches the device; selects the colour of the badge

    @property
    def width(self):
        return self.indent + max(text_width(line, self.size) for line in self.lines)

    @property
    def indent(self):
        return (0.75 * len(self.badge) + 0.8) * self.size if self.badge else 0.0

    @property
    def is_left(self):
        """Returns whether the label is to the left of its anchor; its text then ends at it."""
        return self.x + self.width < self.anchor[0]

    @property
    def height(self):
        return len(self.lines) * self.size * 1.15


def place(labels, points, width, height):
    """Sets the position of each label to the candidate with the lowest cost. A candidate costs more
    if the label covers symbols, routes, or earlier labels or their leaders, if its leader crosses an
    earlier label, if the label leaves the map, or if it is far from its point.

    @param points (x, y, weight) of what should stay visible: symbols, land, and samples of lines
    @param width, height size of the map [px]
    @returns the labels
    """
    taken, points = [], list(points)
    for label in labels:
        best = min(_candidates(label),
                   key=lambda box: _cost(box, label, taken, points, width, height))
        label.x, label.y = best[0], best[1] + label.height
        label.leader = _leader(best, label)
        if label.leader:
            points += [(x, y, _CROSSED) for x, y in _line_to(best, label)]
        taken.append((*best[:2], best[0] + label.width, best[1] + label.height))
    return labels


def _nearest(box, label):
    """Returns the point of the label that is nearest to its anchor."""
    x, y = label.anchor
    return (min(max(x, box[0]), box[0] + label.width), min(max(y, box[1]), box[1] + label.height))


def _line_to(box, label):
    """Returns points of the line from the anchor to the label, at most 4 px apart, without its
    ends."""
    (x, y), (near_x, near_y) = label.anchor, _nearest(box, label)
    count = int(math.hypot(near_x - x, near_y - y) / 4.0) + 1
    return [(x + (near_x - x) * i / count, y + (near_y - y) * i / count) for i in range(1, count)]


def _leader(box, label):
    """Returns the path data of a line from the edge of the symbol to the nearest point of the
    label; empty if they are close."""
    x, y = label.anchor
    near_x, near_y = _nearest(box, label)
    gap = math.hypot(near_x - x, near_y - y)
    if gap <= label.clearance + 0.8 * label.size:
        return ""
    share = (label.clearance + 1) / gap
    return (f"M{x + share * (near_x - x):.1f} {y + share * (near_y - y):.1f}"
            f"L{near_x:.1f} {near_y:.1f}")


def _candidates(label):
    """Yields (x, y, cost) for each possible position of the label around the anchor. x, y: upper
    left corner of the label. Near positions are cheaper. At equal distance, positions to the right
    are the cheapest and those to the left the most expensive."""
    for ring, distance in enumerate((0, 14, 30, 50, 74)):
        for turn, angle in enumerate((0, -45, 45, 90, -90, 180, -135, 135)):
            dx, dy = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            reach = label.clearance + 3 + distance
            x = label.anchor[0] + dx * reach + (dx - 1) / 2 * label.width
            y = label.anchor[1] + dy * reach + (dy - 1) / 2 * label.height
            yield x, y, 2.0 * ring + 0.2 * turn


def _cost(box, label, taken, points, width, height):
    x0, y0, rank = box
    x1, y1 = x0 + label.width, y0 + label.height
    cost = rank
    if x0 < 2 or y0 < 2 or x1 > width - 2 or y1 > height - 2:
        cost += 1000
    for a0, b0, a1, b1 in taken:
        across, along = min(x1, a1) - max(x0, a0), min(y1, b1) - max(y0, b0)
        if across > -2 and along > -2:
            cost += 2000
    if taken and any(a0 < x < a1 and b0 < y < b1 for x, y in _line_to(box, label)
                     for a0, b0, a1, b1 in taken):
        cost += _CROSSED
    margin = 2
    return cost + sum(weight for x, y, weight in points
                      if x0 - margin < x < x1 + margin and y0 - margin < y < y1 + margin)
