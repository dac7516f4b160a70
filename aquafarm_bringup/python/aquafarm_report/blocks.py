# SPDX-License-Identifier: BSD-3-Clause
"""Building blocks of a self-contained HTML page, from templates/blocks.html."""
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
    """Text escaped for HTML."""
    return str(markupsafe.escape(value))


def embed(path):
    """A file as a data: address."""
    kind = mimetypes.guess_type(str(path))[0] or "application/octet-stream"
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"


def section(title, *parts):
    return _render("section", title, _joined(parts))


def tiles(pairs):
    """Large numbers with small labels, from pairs (number, label)."""
    return _render("tiles", pairs)


def players(shown):
    """Tiles of runs and references, from (label, large number, small lines, is_run)."""
    return _render("players", shown)


def curves(window, charts, style, scripts, notes=()):
    """Charts for scripts, which must be trusted; each chart has the keys id and title. Notes are
    sentences above them."""
    return _render("curves", window, charts, style, scripts, list(notes))


def table(head, rows):
    """Table of rows of cells; scrolls horizontally if it is too wide."""
    return _render("table", head, rows)


def markdown_table(text):
    """The Markdown table of a text; an empty first head is "learner"."""
    rows = [[cell.strip().strip("*") for cell in line.strip().strip("|").split("|")]
            for line in text.splitlines() if line.startswith("|")]
    return table([cell or "learner" for cell in rows[0]], rows[2:])


def picture(path, caption, full=False):
    """A picture; `full`: at the size of its pixels, scrolling horizontally if it is too wide."""
    return _render("picture", embed(path), caption, full)


def video(path, caption):
    """A video element, or a picture for an animated gif."""
    if path.suffix == ".gif":
        return picture(path, caption)
    return _render("video", embed(path), caption)


def details(title, text):
    return _render("details", title, text)


def page(title, *sections):
    return _render("page", title, _joined(sections))
