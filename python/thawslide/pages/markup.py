"""HTML of pages: frame, tables, and images as part of the page, which then loads nothing."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Iterable, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from thawslide.figures.style import save_figure

_TYPES = {".png": "image/png", ".mp4": "video/mp4"}
# Browsers then refuse to load anything that is not part of the page.
_SELF_CONTAINED = (
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data:; media-src data:\">"
)


def page_frame(title: str, body: str, is_self_contained: bool = False) -> str:
    """Return a whole HTML page in the style of all reports; title and body are HTML already."""
    before, between, within, after = re.split("TITLE|POLICY|BODY", _FRAME)  # one step: a title can contain "BODY"
    return f"{before}{title}{between}{_SELF_CONTAINED if is_self_contained else ''}{within}{body}{after}"


def table(rows: Iterable[Sequence[object]], style: str, head: Sequence[str] = ()) -> str:
    """Return a table; the first cell of each row is its heading."""
    lines = []
    if head:
        lines.append("<tr>" + "".join(f'<th scope="col">{html.escape(cell)}</th>' for cell in head) + "</tr>")
    for first, *rest in rows:
        cells = "".join(f"<td>{html.escape(str(cell))}</td>" for cell in rest)
        lines.append(f'<tr><th scope="row">{html.escape(str(first))}</th>{cells}</tr>')
    return f'<table class="{style}">\n' + "\n".join(lines) + "\n</table>"


def details(heading: str, inside: str) -> str:
    """Return a part of the page that opens on a click; `inside` is HTML."""
    return f"<details><summary>{html.escape(heading)}</summary>\n{inside}\n</details>"


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
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>TITLE</title>
POLICY
<style>
body { font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: #1f2328; background: #fff;
  max-width: 1080px; margin: 2.5rem auto; padding: 0 1.25rem; }
h1 { font-size: 1.8rem; line-height: 1.2; margin: 0; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .7rem; padding-bottom: .3rem; border-bottom: 1px solid #d8dee4; }
.where, .times, figcaption, td:last-child:not(:nth-child(2)) { color: #59636e; }
.where { margin: .3rem 0 0; }
nav { margin: .8rem 0; font-size: .9rem; }
a { color: #0a5fb4; text-decoration: none; }
a:hover { text-decoration: underline; }
.note { background: #fff6e0; border-left: 4px solid #e69f00; padding: .6rem .9rem; margin: 1rem 0; }
table { border-collapse: collapse; font-size: .93rem; }
th, td { text-align: left; padding: .32rem 1.4rem .32rem 0; border-bottom: 1px solid #eaeef2; vertical-align: top; }
th { font-weight: 500; }
.facts td { overflow-wrap: anywhere; }
.runs td { color: inherit !important; font-variant-numeric: tabular-nums; }
.numbers td:nth-child(2) { font-weight: 600; font-variant-numeric: tabular-nums; white-space: nowrap; }
details { margin: .8rem 0; }
summary { cursor: pointer; color: #0a5fb4; margin-bottom: .4rem; }
figure { margin: 0; }
img, video { max-width: 100%; height: auto; display: block; }
figcaption { font-size: .88rem; margin-top: .3rem; }
.controls { display: flex; flex-wrap: wrap; align-items: center; gap: .5rem 1rem; font-size: .93rem; margin: .4rem 0; }
.controls input[type=range] { flex: 1 1 14rem; }
.controls output { min-width: 7rem; font-variant-numeric: tabular-nums; }
.controls button, .controls select { font: inherit; padding: .15rem .6rem; }
@media print { nav, .controls { display: none; } figure { break-inside: avoid; } }
</style>
</head>
<body>
BODY
</body>
</html>
"""
