"""Files of a prior check: prior.json, a table as text, and a section of the page."""

from __future__ import annotations

import html
import json
from pathlib import Path
from typing import Any

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.number_text import number_text, volume_text
from thawslide.pages.markup import table
from thawslide.sweeps.folder import PRIOR, PRIOR_FILE
from thawslide.text_files import MEGABYTE, is_file, read_json

_HEAD = ("H/L of", "number", "P5", "P50", "P95")


def write_prior(found: dict[str, Any], folder: Path) -> Path:
    """Write the check of a forecast in a folder; return the file."""
    path = folder / PRIOR / PRIOR_FILE
    try:
        with atomic_file(path) as temporary:
            temporary.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise ReportError(f"{path}: cannot be written ({error.strerror or error}). Select another --output.") from error
    return path


def prior_lines(found: dict[str, Any]) -> list[str]:
    """Return the check as lines of text."""
    rows = [list(_HEAD), *_cells(found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(
            [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        )
        for row in rows
    ]
    return [f"release of {volume_text(found['volume_m3'])}", *lines, *(f"note: {note}" for note in found["notes"])]


def prior_section(folder: Path) -> str:
    """Return the check as a section of the page, "" without one."""
    path = folder / PRIOR / PRIOR_FILE
    if not is_file(path):
        return ""
    try:
        found = read_json(path, 64 * MEGABYTE)
        parts = ["<h2>Prior check</h2>", table(_cells(found), "runs wide", _HEAD)]
        notes = [*found["notes"], _WEIGHTED if found["weights"] else _EQUAL]
        parts += [f"<p><small>{html.escape(note)}.</small></p>" for note in notes]
    except (ReportError, KeyError, TypeError, ValueError):
        return f'<p class="note">{PRIOR_FILE} cannot be read. Repeat thawslide forecast.</p>'
    return "\n".join(parts)


_EQUAL = "All members are equally probable"
_WEIGHTED = "All results are weighted: the rigid blocks of the members have the H/L distribution of the events"


def _cells(found: dict[str, Any]) -> list[list[str]]:
    """Return the rows as text. Quantiles of blocks up to the largest upper limit are upper limits too."""
    limit, events = found.get("limit"), len(found["events"])

    def text(value: float, is_of_blocks: bool) -> str:
        is_limit = is_of_blocks and limit is not None and value <= limit
        return f"≤ {number_text(value, 2)}" if is_limit else number_text(value, 2)

    rows = found["rows"]
    last = len(rows) - 1 if events else len(rows)  # the last row is that of the events
    return [
        [words, f"{count:,}", *(text(value, row < last) for value in values)]
        for row, (words, count, *values) in enumerate(rows)
    ]
