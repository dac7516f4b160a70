# SPDX-License-Identifier: BSD-3-Clause
"""Building blocks of a self-contained HTML page, rendered from templates/blocks.html."""
import base64
import mimetypes
import pathlib

import jinja2
import markupsafe

_BLOCKS = jinja2.Environment(
    loader=jinja2.FileSystemLoader(pathlib.Path(__file__).resolve().parent / "templates"),
    autoescape=True, undefined=jinja2.StrictUndefined).get_template("blocks.html").module


def _render(block, *values):
    """Returns a block of the template as text, which the caller may join with other HTML."""
    return str(getattr(_BLOCKS, block)(*values))


def _joined(blocks):
    return markupsafe.Markup("".join(blocks))


def escape(value):
    """Returns a value as text that is escaped for HTML."""
    return str(markupsafe.escape(value))


def percent(share, digits=0):
    """Returns a share as text, for example "98 %". More digits are written if a share below 1 would
    be "100 %" or a share above 0 would be "0 %"."""
    text = f"{100.0 * share:.{digits}f}"
    while (share < 1.0 and float(text) == 100.0) or (share > 0.0 and float(text) == 0.0):
        digits += 1
        text = f"{100.0 * share:.{digits}f}"
    return f"{text} %"


def embed(path):
    """Returns the content of a file as a data: URL."""
    kind = mimetypes.guess_type(str(path))[0] or "application/octet-stream"
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"


def section(title, *parts):
    return _render("section", title, _joined(parts))


def tiles(pairs):
    """Returns tiles, each with a large value and a small label. pairs: [(value, label)]"""
    return _render("tiles", pairs)


def players(shown):
    """Returns tiles of runs and references. shown: [(label, large number, small lines, is_run)]"""
    return _render("players", shown)


def curves(window, charts, style, scripts, notes=()):
    """Returns charts that scripts in the page draw.

    window: number of training episodes in each mean
    charts: dicts with the keys id and title
    style, scripts: trusted CSS and JavaScript, which are not escaped
    notes: sentences above the charts
    """
    return _render("curves", window, charts, style, scripts, list(notes))


def table(head, rows):
    """Returns a table, which scrolls horizontally if it is too wide. head: titles of the columns"""
    return _render("table", head, rows)


def markdown_table(text):
    """Converts the Markdown table in a text. An empty title of a column becomes "learner"."""
    rows = [[cell.strip().strip("*") for cell in line.strip().strip("|").split("|")]
            for line in text.splitlines() if line.startswith("|")]
    return table([cell or "learner" for cell in rows[0]], rows[2:])


def picture(path, caption, full=False):
    """Returns a picture. full: True shows the picture in its original size, and it scrolls
    horizontally if it is too wide"""
    return _render("picture", embed(path), caption, full)


def video(path, caption):
    """Returns a video element; for an animated gif, a picture."""
    if path.suffix == ".gif":
        return picture(path, caption)
    return _render("video", embed(path), caption)


def details(title, text):
    return _render("details", title, text)


def page(title, *sections):
    return _render("page", title, _joined(sections))
