"""Page that compares runs: key numbers, cases, histories, and maps of the maximum flow thickness."""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from thawslide.atomic_file import atomic_file
from thawslide.balance import balances
from thawslide.errors import NotInRunError, ReportError
from thawslide.figures.run_histories import run_histories
from thawslide.figures.run_maps import run_maps
from thawslide.key_numbers import key_numbers
from thawslide.maps import on_map
from thawslide.mobility import mobility_of
from thawslide.pages.events import events_part
from thawslide.pages.markup import details, drawn_data, figure_part, page_frame, table
from thawslide.pages.notes import ending_note
from thawslide.pages.view import scripts
from thawslide.run_folder import Run

NAME = "comparison.html"
_LONGEST_VALUE = 60  # characters
_NO_VALUE = "–"


def make_comparison(
    runs: Sequence[Run], output: Path | None, dpi: int, progress: Callable[[str], None] = lambda line: None
) -> Path:
    """Write comparison.html into `output` (default: the folder of the first run); return its path."""
    folder = output or runs[0].folder
    named = names_of(runs)
    parts = [
        f"<h1>Comparison of {len(runs)} runs</h1>",
        *(f'<p class="note">{html.escape(note)}</p>' for note in _notes(named)),
        "<h2>Key numbers</h2>",
        table(number_rows(named), "runs wide", ("", *named)),
    ]
    parts += _figure("Histories", _HISTORIES, run_histories, named, dpi, progress)
    if any(on_map(run) for run in runs):
        parts += _figure("Maximum flow thickness", _MAPS, run_maps, named, dpi, progress)
    if events := events_part({name: mobility_of(run) for name, run in named.items()}):
        parts += ["<h2>Published events</h2>", events, scripts()]
    differences = case_rows(named)
    shown = table(differences, "runs wide", ("key or file", *named)) if differences else "<p>None.</p>"
    parts += ["<h2>Differences between the cases</h2>", details(f"{len(differences)} keys and files", shown)]
    path = folder / NAME
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with atomic_file(path) as temporary:
            text = page_frame(f"Comparison: {html.escape(', '.join(named))}", "\n".join(parts), is_self_contained=True)
            temporary.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ReportError(
            f"{error.filename or path}: cannot be written ({error.strerror or error}). Select another --output."
        ) from error
    return path


def names_of(runs: Sequence[Run]) -> dict[str, Run]:
    """Return the runs by the names of their folders, or by their paths if two names are the same."""
    folders = [run.folder.resolve() for run in runs]
    if len(set(folders)) < len(folders):
        twice = next(folder for folder in folders if folders.count(folder) > 1)
        raise ReportError(f"RUN: the same run twice (found {twice}). Specify different runs.")
    names = [folder.name for folder in folders]
    if len(set(names)) < len(names):
        names = [str(folder) for folder in folders]
    return dict(zip(names, runs, strict=True))


def number_rows(runs: Mapping[str, Run]) -> list[list[str]]:
    """Return the key numbers and balances of runs in columns; a time of a value is in brackets."""
    found: dict[str, dict[str, str]] = {}
    for name, run in runs.items():
        for row in key_numbers(run):
            when = f" ({row.remark})" if re.fullmatch(r"at [\d.,−]+ s", row.remark) else ""
            found.setdefault(row.words.removesuffix(f" at {run.last_state}"), {})[name] = row.value + when
        for balance in balances(run):
            words = f"{balance.words} balance"
            found.setdefault(words, {})[name] = f"{balance.verdict}: {balance.percentage.split(' of ')[0]}"
        found.setdefault("Last state", {})[name] = run.last_state
    return [[words, *(values.get(name, _NO_VALUE) for name in runs)] for words, values in found.items()]


def case_rows(runs: Mapping[str, Run]) -> list[list[str]]:
    """Return the keys of the cases with different values, and the input files with different SHA-256.

    Long values are shortened, after the comparison of the whole ones.
    """
    found: dict[str, dict[str, str]] = {}
    for name, run in runs.items():
        for key, value in _flat(run.case):
            found.setdefault(key, {})[name] = _text(value)
        inputs = run.facts.get("inputs")
        for each in inputs if isinstance(inputs, list) else []:
            if isinstance(each, dict) and not str(each.get("path", "")).endswith(".toml"):
                file = str(each.get("copy") or each.get("path", "")).rpartition("/")[2]
                found.setdefault(f"SHA-256 of {file}", {})[name] = str(each.get("sha256", ""))
    rows = [[key, *(values.get(name, _NO_VALUE) for name in runs)] for key, values in found.items()]
    different = [row for row in rows if len(set(row[1:])) > 1]
    return [[key, *(_short(value, _limit(key)) for value in values)] for key, *values in different]


def _flat(values: Mapping[str, Any], before: str = "") -> list[tuple[str, Any]]:
    """Return all keys of nested tables with dots, and their values."""
    found: list[tuple[str, Any]] = []
    for key, value in values.items():
        found += _flat(value, f"{before}{key}.") if isinstance(value, dict) else [(f"{before}{key}", value)]
    return found


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _limit(key: str) -> int:
    return 16 if key.startswith("SHA-256") else _LONGEST_VALUE


def _short(text: str, limit: int) -> str:
    return text if len(text) <= limit else f"{text[:limit]}..."


def _notes(runs: Mapping[str, Run]) -> list[str]:
    notes = [f"{name}: {note}" for name, run in runs.items() if (note := ending_note(run))]
    if len({run.dimension for run in runs.values()}) > 1:
        notes.append("2D and 3D runs: areas and volumes are comparable only if the 2D case has a width.")
    return notes


def _figure(
    heading: str,
    caption: str,
    plot: Callable[[Mapping[str, Run]], Figure],
    runs: Mapping[str, Run],
    dpi: int,
    progress: Callable[[str], None],
) -> list[str]:
    """Return a figure with its heading, or the reason for its absence."""
    try:
        part = figure_part(heading, drawn_data(plot(runs), dpi), caption)
    except NotInRunError as error:
        part = f"<p>Not available: {html.escape(str(error))}</p>"
    except (ValueError, ArithmeticError, MemoryError) as error:
        raise ReportError(f"{heading}: cannot be plotted ({error}). Check the values of the runs.") from error
    progress(heading)
    return [f"<h2>{heading}</h2>", part]


_HISTORIES = (
    "Columns of history.csv. Velocity and displacement are mass-weighted means. Runout distance: front minus initial "
    "rear."
)
_MAPS = "Maxima of every time step on one colour scale. Dashed: release. Hillshade: terrain of the first run."
