"""Files of a score: score.json, score.csv, score-members.csv, score.md, and a section of the page of a sweep."""

from __future__ import annotations

import html
import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.number_text import area_text, number_text, unit_text
from thawslide.pages.markup import table
from thawslide.scores.ensemble import Distribution, quantiles
from thawslide.scores.maps import jaccard
from thawslide.scores.observed import Observation
from thawslide.scores.score import Score
from thawslide.text_files import MEGABYTE, read_json

JSON, CSV, MEMBERS, PAGE = "score.json", "score.csv", "score-members.csv", "score.md"
FILES = (JSON, CSV, MEMBERS, PAGE)
REPORT = "report.html"  # of a run
BEGIN, END = "<!-- score -->", "<!-- end of the score -->"  # around the section of a page
_NO_EVENTS = Distribution(0, *[math.nan] * 7)
_MEANINGS = (
    "percentile: weight of the members below the observation (below observation minus and plus uncertainty)",
    "CRPS: continuous ranked probability score, E|X - y| - E|X - X'|/2 (Gneiting and Raftery 2007, Eq. 21), in the "
    "unit of the quantity",
    "skill: 1 - CRPS/CRPS of the events; positive if the forecast is better than the events",
)
Table = tuple[list[str], list[list[str]]]  # heading and rows


def write_score(score: Score, output: Path) -> tuple[str, list[Path]]:
    """Write all files of a score; return its tables as text, and the files."""
    rows = [_row(*row) for row in score.rows]
    tables, event = _tables(score, rows), score.observed.event
    what = f"{len(score.forecast.members)} members" if score.forecast.is_sweep else "One run"
    source = f" ({event['source']})" if "source" in event else ""
    opening = (
        f"{what} compared with observations of {event.get('name', 'an event')}{source}, {score.observed.file.name}."
    )
    stored: dict[str, Any] = {"opening": opening, "rows": rows, "tables": tables}
    stored["observed"] = str(score.observed.file.resolve())
    text = "\n\n".join(map(_markdown, tables))
    meanings = dict.fromkeys(f"{each.quantity.words}: {each.quantity.meaning}" for each, _, _ in score.rows)
    stored["notes"] = [*score.notes, *meanings, *_MEANINGS]
    notes = "\n".join(f"- {note}" for note in stored["notes"])
    members = pd.DataFrame({"member": score.forecast.members, **score.columns})
    texts = {
        JSON: json.dumps(stored, indent=1, ensure_ascii=False, allow_nan=False) + "\n",
        CSV: pd.DataFrame(rows).to_csv(index=False, lineterminator="\n"),
        MEMBERS: members.to_csv(index=False, lineterminator="\n"),
        PAGE: f"# Score of {score.forecast.folder.resolve().name}\n\n{opening}\n\n{text}\n\n{notes}\n",
    }
    try:
        output.mkdir(parents=True, exist_ok=True)
        for name, content in texts.items():
            with atomic_file(output / name) as temporary:
                temporary.write_text(content, encoding="utf-8")
    except OSError as error:
        raise ReportError(
            f"{error.filename or output}: cannot be written ({error.strerror or error}). Select another --output."
        ) from error
    return text, [output / name for name in texts]


def stored_section(folder: Path) -> str:
    """Return the section of the score in a folder between its marks; only the marks without a score."""
    section = ""
    if (folder / JSON).is_file():
        try:
            found = read_json(folder / JSON, MEGABYTE)
            parts = ["<h2>Score</h2>", f"<p>{html.escape(found['opening'])}</p>"]
            parts += [table(rows, "runs wide", head) for head, rows in found["tables"]]
            parts += [f"<p><small>{html.escape(note)}.</small></p>" for note in found["notes"]]
            section = "\n".join(parts)
        except (ReportError, KeyError, TypeError, ValueError, AttributeError):
            section = f'<p class="note">{JSON} cannot be read. Repeat thawslide score.</p>'
    return f"{BEGIN}\n{section}\n{END}"


def renew_section(page: Path) -> bool:
    """Replace the section of a page by that of the score in its folder; false if the page has no place for it."""
    text = page.read_text(encoding="utf-8") if page.is_file() else ""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        return False
    with atomic_file(page) as temporary:
        temporary.write_text(before + stored_section(page.parent) + after, encoding="utf-8")
    return True


def _row(observation: Observation, members: Distribution, events: Distribution | None) -> dict[str, Any]:
    """Return a row of score.csv, in the unit of the observation; None for nan."""
    factor, row = observation.factor, {"quantity": observation.name, "words": observation.words}
    numbers = {"observed": observation.value, "uncertainty": observation.uncertainty}
    numbers["difference"] = members.median - observation.value
    others = {"skill": 1.0 - members.crps / events.crps if events and events.crps > 0.0 else math.nan}
    for name, distribution in (("members", members), ("events", events or _NO_EVENTS)):
        for key, value in asdict(distribution).items():
            is_length = key in ("low", "median", "high", "crps")
            (numbers if is_length else others)[f"{name}_{key}"] = value
    scaled = {key: value / factor for key, value in numbers.items()} | others
    finite = {key: value if math.isfinite(value) else None for key, value in scaled.items()}
    return {**row, "unit": observation.unit, **finite, "source": observation.source}


def _tables(score: Score, rows: list[dict[str, Any]]) -> list[Table]:
    is_sweep, weights = score.forecast.is_sweep, score.forecast.weights
    own = ["median (5 to 95 %)", "percentile", "CRPS"] if is_sweep else ["run", "difference"]
    others = ["events: median (5 to 95 %)", "percentile", "CRPS", "skill"]
    tables: list[Table] = []
    if rows:
        tables.append((["quantity", "observed", *own, *others], [_cells(row, is_sweep) for row in rows]))
    if score.overlap is not None:
        what = f"thickness above {score.threshold:g} m"
        areas = [area_text(area) for area in score.overlap]
        index = number_text(float(jaccard(score.overlap[None])[0]), 2)
        lines = [[f"{what}, probability of at least 0.5" if is_sweep else what, index, *areas]]
        if is_sweep:
            spread = _range_text(quantiles(score.columns["outline_jaccard"], weights))
            lines.append(["members: median (5 to 95 %)", spread, "", "", ""])
        tables.append((["outline", "Jaccard index", "hit", "missed", "false"], lines))
    if (found := score.columns.get("force_correlation")) is not None:
        shift = _range_text(quantiles(score.columns["force_shift_s"], weights))
        head = ["force record", "correlation", "time of the run at time 0 of the record (s)"]
        tables.append((head, [["both components", _range_text(quantiles(found, weights)), shift]]))
    return tables


def _cells(row: dict[str, Any], is_sweep: bool) -> list[str]:
    unit = "" if row["unit"] in ("", "-", "1") else f" {unit_text(row['unit'])}"
    uncertainty = f" ± {number_text(row['uncertainty'])}" if row["uncertainty"] else ""
    cells = [row["words"], f"{number_text(row['observed'])}{uncertainty}{unit}"]
    if is_sweep:
        cells += _distribution_cells(row, "members", unit)
    else:
        relative = f" ({number_text(100.0 * row['difference'] / row['observed'], 2)} %)" if row["observed"] else ""
        cells += [f"{number_text(row['members_median'])}{unit}", f"{number_text(row['difference'])}{unit}{relative}"]
    cells += _distribution_cells(row, "events", unit) if row["events_count"] else [""] * 3
    return [*cells, "" if row["skill"] is None else number_text(row["skill"], 2)]


def _distribution_cells(row: dict[str, Any], name: str, unit: str) -> list[str]:
    numbers = [row[f"{name}_{key}"] for key in ("low", "median", "high")]
    at, least, most = (f"{row[f'{name}_percentile{end}']:.0f}" for end in ("", "_low", "_high"))
    ends = f" ({least} to {most})" if row["uncertainty"] else ""
    return [f"{_range_text(numbers)}{unit}", f"{at}{ends}", f"{number_text(row[f'{name}_crps'])}{unit}"]


def _range_text(numbers: Sequence[float]) -> str:
    low, median, high = map(number_text, numbers)
    return median if low == high else f"{median} ({low} to {high})"


def _markdown(found: Table) -> str:
    """Return a table with aligned columns."""
    lines = [[cell.replace("|", r"\|") for cell in line] for line in (found[0], *found[1])]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    texts = ["| " + " | ".join(map(str.ljust, line, widths)) + " |" for line in lines]
    return "\n".join([texts[0], "| " + " | ".join("-" * width for width in widths) + " |", *texts[1:]])
