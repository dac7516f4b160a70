# SPDX-License-Identifier: BSD-3-Clause
"""Building blocks of a self-contained HTML page."""
import base64
import html
import mimetypes

STYLE = """
:root{color-scheme:light dark;--ink:#12202e;--paper:#f4f7f9;--card:#fff;--rule:#d5dde4;
--accent:#1b4f78}
@media(prefers-color-scheme:dark){:root{--ink:#e6edf3;--paper:#0c1620;--card:#12202e;--rule:#2b3d4f;
--accent:#7fc1e8}.chart{background:#f4f7f9;border-radius:6px}}
*{box-sizing:border-box}body{margin:0 auto;max-width:60rem;padding:1rem;background:var(--paper);
color:var(--ink);font:16px/1.5 system-ui,sans-serif;
overflow-wrap:anywhere}h1{font-size:1.5rem;margin:.2rem 0}
h2{font-size:1.15rem;margin:1.6rem 0 .5rem;color:var(--accent)}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(8.5rem,1fr));gap:.6rem}
.tile{background:var(--card);border:1px solid var(--rule);border-radius:8px;padding:.6rem .8rem}
.tile b{display:block;font-size:1.25rem}.tile span{font-size:.85rem;opacity:.75}
.films{display:grid;grid-template-columns:repeat(auto-fit,minmax(17rem,1fr));gap:.8rem}
figure{margin:0}figcaption{font-size:.9rem;margin:.2rem 0 .6rem}
img,video,svg{max-width:100%;height:auto;display:block;border-radius:6px}
.full img{max-width:none}
.wide{overflow-x:auto}table{border-collapse:collapse;font-size:.9rem}
th,td{padding:.3rem .6rem;border-bottom:1px solid var(--rule);text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left}details{background:var(--card);border:1px solid
var(--rule);border-radius:8px;padding:.5rem .8rem;margin:.5rem 0}summary{cursor:pointer}
pre{overflow-x:auto;font-size:.8rem;line-height:1.35}
"""


def escape(value):
    """Text escaped for HTML."""
    return html.escape(str(value))


def embed(path):
    """A file as a data: address."""
    kind = mimetypes.guess_type(str(path))[0] or "application/octet-stream"
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"


def section(title, *parts):
    return f"<section><h2>{escape(title)}</h2>{''.join(parts)}</section>"


def tiles(pairs):
    """Large numbers with small labels, from pairs (number, label)."""
    return '<div class="tiles">' + "".join(
        f'<div class="tile"><b>{escape(value)}</b><span>{escape(name)}</span></div>'
        for value, name in pairs) + "</div>"


def table(head, rows):
    """Table of rows of cells; scrolls horizontally if it is too wide."""
    def line(tag, cells):
        return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"
    return ('<div class="wide"><table>' + line("th", head) +
            "".join(line("td", row) for row in rows) + "</table></div>")


def markdown_table(text):
    """The Markdown table of a text; an empty first head is "learner"."""
    rows = [[cell.strip().strip("*") for cell in line.strip().strip("|").split("|")]
            for line in text.splitlines() if line.startswith("|")]
    return table([cell or "learner" for cell in rows[0]], rows[2:])


def picture(path, caption, full=False):
    """A picture; `full`: at the size of its pixels, scrolling horizontally if it is too wide."""
    opening = '<figure class="wide full">' if full else "<figure>"
    return (f'{opening}<img src="{embed(path)}" alt="{escape(caption)}">'
            f"<figcaption>{escape(caption)}</figcaption></figure>")


def film(path, caption):
    """A video element, or a picture for an animated gif."""
    if path.suffix == ".gif":
        return picture(path, caption)
    return (f'<figure><video controls muted playsinline preload="metadata" src="{embed(path)}">'
            f"</video><figcaption>{escape(caption)}</figcaption></figure>")


def details(title, text):
    return (f"<details><summary>{escape(title)}</summary><pre>{escape(text)}</pre></details>")


def page(title, *sections):
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>"
            f"<h1>{escape(title)}</h1>{''.join(sections)}</body></html>\n")
