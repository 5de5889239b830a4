"""HTML of pages: frame, tables, and images as part of the page, which then loads nothing."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Iterable, Sequence
from io import BytesIO
from itertools import zip_longest
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from thawslide.errors import printable
from thawslide.figures.style import save_figure

_TYPES = {".png": "image/png", ".mp4": "video/mp4"}
# Browsers then refuse to load anything that is not part of the page.
_SELF_CONTAINED = (
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data:; media-src data:\">"
)


def page_frame(title: str, body: str, is_self_contained: bool = False, language: str = "en") -> str:
    """Return a whole HTML page in the style of all reports; title and body are HTML already.

    Control characters become "?": a name or value of a case must not reverse the text around it.
    """
    start, before, between, within, after = re.split("LANGUAGE|TITLE|POLICY|BODY", _FRAME)  # not in title or body
    policy = _SELF_CONTAINED if is_self_contained else ""
    return printable(f"{start}{language}{before}{title}{between}{policy}{within}{body}{after}")


def table(rows: Iterable[Sequence[object]], style: str, head: Sequence[str] = ()) -> str:
    """Return a table; the first cell of each row is its heading.

    Cells of the style "wide" have the name of their column: on a narrow screen, each row is a list of names and values.
    """
    lines = []
    if head:
        lines.append("<tr>" + "".join(f'<th scope="col">{html.escape(cell)}</th>' for cell in head) + "</tr>")
    names = [f' data-column="{html.escape(name)}"' for name in head[1:]] if "wide" in style else []
    for first, *rest in rows:
        cells = "".join(
            f"<td{name}>{html.escape(str(cell))}</td>" for cell, name in zip_longest(rest, names, fillvalue="")
        )
        lines.append(f'<tr><th scope="row">{html.escape(str(first))}</th>{cells}</tr>')
    return f'<table class="{style}">\n' + "\n".join(lines) + "\n</table>"


def details(heading: str, inside: str, name: str = "") -> str:
    """Return a part of the page that opens on a click; `inside` is HTML. With a name it is a main part of the page."""
    of_page = f' id="{name}" class="part"' if name else ""
    return f"<details{of_page}><summary>{html.escape(heading)}</summary>\n{inside}\n</details>"


def items(sentences: Iterable[str]) -> str:
    """Return sentences as a list."""
    lines = "\n".join(f"<li>{html.escape(sentence)}</li>" for sentence in sentences)
    return f"<ul>\n{lines}\n</ul>"


def figure_part(heading: str, data: str, caption: str, is_video: bool = False) -> str:
    """Return an image or video as a figure with its caption; `data` is its data address."""
    words = html.escape(heading)
    if is_video:
        shown = f'<video controls loop muted src="{data}" aria-label="{words}"></video>'
    else:
        shown = f'<img src="{data}" alt="{words}">'
    return f"<figure>{shown}\n<figcaption>{html.escape(caption)}</figcaption></figure>"


def file_data(path: Path) -> str:
    """Return an image or video file as a data address."""
    return data_address(path.read_bytes(), _TYPES[path.suffix])


def drawn_data(figure: Figure, dpi: int) -> str:
    """Return a figure as the data address of an image."""
    image = BytesIO()
    save_figure(figure, image, format="png", dpi=dpi)
    return data_address(image.getvalue(), _TYPES[".png"])


def data_address(data: bytes, kind: str) -> str:
    """Return bytes as a data address of a media type."""
    return f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"


def json_part(name: str, value: Any) -> str:
    """Return a value as a JSON element of the page, which scripts find by its name."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>'


_FRAME = """<!doctype html>
<html lang="LANGUAGE">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>TITLE</title>
POLICY
<style>
@media screen { :root { color-scheme: light dark; } }
:root { --text: #1f2328; --back: #fff; --quiet: #59636e; --line: #d8dee4; --note: #fff6e0; --link: #0a5fb4;
  --value: #0072b2; }
@media screen and (prefers-color-scheme: dark) {
  :root { --text: #e6e9ec; --back: #15191e; --quiet: #a9b2bb; --line: #3a424b; --note: #3a2f12; --link: #7cbcff;
    --value: #74bdf0; }
  img, video, #view, #events { background: #fff; border-radius: 4px; }
}
body { font: 1rem/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: var(--text); background: var(--back);
  max-width: 1080px; margin: 2rem auto; padding: 0 1.25rem; }
h1 { font-size: 1.8rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .7rem; padding-bottom: .3rem; border-bottom: 1px solid var(--line); }
.where, .times, figcaption, td:last-child:not(:nth-child(2)) { color: var(--quiet); }
.where { margin: .3rem 0 0; }
.logo { float: right; max-width: 9rem; max-height: 3.6rem; margin-left: 1rem; }
nav { margin: .8rem 0; font-size: .9rem; }
a { color: var(--link); text-decoration: none; }
a:hover { text-decoration: underline; }
.note { background: var(--note); border-left: 4px solid #e69f00; padding: .6rem .9rem; margin: 1rem 0;
  overflow-wrap: anywhere; }
table { border-collapse: collapse; font-size: .93rem; }
th, td { text-align: left; padding: .32rem 1.4rem .32rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 500; }
.facts th, .facts td { overflow-wrap: anywhere; }
.facts th { min-width: 13rem; }
.facts td { min-width: 8rem; }
.runs td { color: inherit !important; font-variant-numeric: tabular-nums; }
.numbers td:nth-child(2) { font-weight: 600; font-variant-numeric: tabular-nums; white-space: nowrap; }
details { margin: .8rem 0; }
summary { cursor: pointer; color: var(--link); margin-bottom: .4rem; }
.part { border-top: 1px solid var(--line); margin: 1rem 0 0; padding-top: .6rem; }
.part > summary { font-size: 1.2rem; font-weight: 600; }
.results { display: grid; grid-template-columns: 11fr 9fr; gap: 0 2rem; }
.results h2 { font-size: 1rem; margin: .8rem 0 .3rem; }
.results p, .results ul { margin: .3rem 0; font-size: .88rem; line-height: 1.4; }
.results ul { padding-left: 1.1rem; }
.plain { margin: 0; }
.plain div { border-bottom: 1px solid var(--line); padding: .2rem 0; }
.plain dt { float: right; color: var(--quiet); font-size: .88rem; }
.plain .value { font-size: 1.2rem; font-weight: 600; color: var(--value); font-variant-numeric: tabular-nums; }
.plain dd { margin: 0; font-size: .84rem; color: var(--quiet); }
.plain .range { color: var(--text); }
figure { margin: 0; }
img, video { max-width: 100%; height: auto; display: block; }
figcaption { font-size: .88rem; margin-top: .3rem; }
.controls { display: flex; flex-wrap: wrap; align-items: center; gap: .5rem 1rem; font-size: .93rem; margin: .4rem 0; }
.controls input[type=range] { flex: 1 1 14rem; }
.controls output { min-width: 7rem; font-variant-numeric: tabular-nums; }
.controls button, .controls select { font: inherit; padding: .15rem .6rem; }
@media screen and (max-width: 700px) {
  body { margin: 1rem auto; }
  .results { grid-template-columns: minmax(0, 1fr); }
  table { overflow-wrap: anywhere; }
  th, td { padding-right: .7rem; }
  :is(.numbers, .facts, .wide) {
    display: block;
    tbody { display: block; }
    tr { display: flex; flex-wrap: wrap; gap: 0 1rem; padding: .32rem 0; border-bottom: 1px solid var(--line); }
    th, td { padding: 0; border: 0; min-width: 0; }
  }
  .numbers td:nth-child(2) { margin-left: auto; }
  .numbers td:nth-child(3) { flex: 1 0 100%; }
  .wide {
    tr:has([scope=col]), &:not(.members) td:empty { display: none; }
    th { flex: 1 0 100%; }
    td::before { content: attr(data-column) " "; color: var(--quiet); }
  }
  .members {
    th { flex: 1 1 calc(100% - 6rem); }
    th + td { display: none; }
    th + td + td { flex: 0 0 5rem; text-align: right; }
    th + td + td::before { content: none; }
  }
  .numbers td:nth-child(3):empty { display: none; }
}
@page { margin: 12mm; }
@media print {
  nav, .controls, .part:not([open]) { display: none; }
  :root { font-size: 12.5px; }
  body { margin: 0; }
  h1, h2, h3, summary { break-after: avoid; }
  tr:first-child { break-after: avoid; }
  figure, tr, .note, #view, #events { break-inside: avoid; }
  img { max-height: 235mm; width: auto; }
  h2:has(+ figure > video), figure:has(video) { display: none; }
}
</style>
</head>
<body>
BODY
</body>
</html>
"""
