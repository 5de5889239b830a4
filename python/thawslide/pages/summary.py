"""Two-page summary of a 3D run for non-experts, as HTML and as PDF."""

from __future__ import annotations

import html
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.figures.class_maps import Classes, arrival_classes, class_map, draw_classes, thickness_classes
from thawslide.figures.site import Site, make_site
from thawslide.figures.style import BLUE, NOTE, common_style, disable_formulas, wrapped
from thawslide.maps import on_map
from thawslide.pages.markup import drawn_data, figure_part, page_frame, table
from thawslide.pages.summary_text import PlainNumber, arrival_rows, limits, origin, plain_numbers, scenario
from thawslide.run_folder import Run

NAMES = ("summary.html", "summary.pdf")
_WIDTH, _HEIGHT, _MARGIN = 8.27, 11.69, 0.75  # inches: A4
_INSIDE = _WIDTH - 2 * _MARGIN
_CHARACTERS = 14.5  # of a text of 9.5 points in one inch
_LEGEND = 0.85  # inches below a map
_MAP_HEADING, _ARRIVAL_HEADING = "Maximum flow thickness", "Time of arrival after the start"
_MOST_ROWS = 12  # of arrivals on paper, to leave space for the map
_TABLE_HEAD = ("place", "arrival after the start", "maximum thickness")


@dataclass(frozen=True)
class Summary:
    """Texts and maps of a summary."""

    title: str
    scenario: list[str]
    numbers: list[PlainNumber]
    arrivals: list[tuple[str, str, str]]
    limits: list[str]
    origin: list[str]
    site: Site
    thickness: Classes
    arrival: Classes


def make_summary(run: Run, output: Path | None = None, dpi: int = 150, context: str = "") -> tuple[Path, Path]:
    """Write summary.html and summary.pdf into `output` (default: the run folder); return their paths.

    `context`: a sentence on the other runs of a forecast.
    """
    if not on_map(run):
        raise ReportError("--brief: only for 3D runs on a DEM, which have maps. Use the report of this run.")
    site = make_site(run)
    summary = Summary(
        run.title,
        [*scenario(run), context] if context else scenario(run),
        plain_numbers(run),
        arrival_rows(run),
        limits(run),
        origin(run),
        site,
        thickness_classes(site),
        arrival_classes(site),
    )
    page, document = ((output or run.folder) / name for name in NAMES)
    try:
        page.parent.mkdir(parents=True, exist_ok=True)
        with atomic_file(page) as temporary:
            temporary.write_text(_page(summary, dpi), encoding="utf-8")
        with atomic_file(document) as temporary:
            _write_pdf(summary, temporary, dpi)
    except OSError as error:
        raise ReportError(
            f"{error.filename or page}: cannot be written ({error.strerror or error}). Select another --output."
        ) from error
    except (ValueError, ArithmeticError, MemoryError) as error:
        raise ReportError(f"{run.folder}: no summary ({error}). Check the values of the run.") from error
    return page, document


def _page(summary: Summary, dpi: int) -> str:
    title = html.escape(summary.title)
    thickness = drawn_data(class_map(summary.site, summary.thickness, _MAP_HEADING), dpi)
    arrival = drawn_data(class_map(summary.site, summary.arrival, _ARRIVAL_HEADING), dpi)
    numbers = ((each.name, each.value, each.meaning) for each in summary.numbers)
    parts = [
        f"<h1>{title}</h1>",
        '<p class="where">Summary of one simulated scenario</p>',
        "<h2>Scenario</h2>",
        f"<p>{html.escape(' '.join(summary.scenario))}</p>",
        "<h2>Key numbers</h2>",
        table(numbers, "numbers"),
        "<h2>Affected area and thickness</h2>",
        figure_part(_MAP_HEADING, thickness, summary.site.scene.note()),
        '<h2 style="break-before: page">Arrival</h2>',
        figure_part(_ARRIVAL_HEADING, arrival, "Time of first arrival, counted from the start of the movement."),
    ]
    if summary.arrivals:
        parts.append(table(summary.arrivals, "runs", _TABLE_HEAD))
    items = "\n".join(f"<li>{html.escape(sentence)}</li>" for sentence in summary.limits)
    parts += ["<h2>Limits of the numbers</h2>", f"<ul>\n{items}\n</ul>"]
    origins = "<br>".join(html.escape(line) for line in summary.origin)
    parts.append(f'<p class="where" style="overflow-wrap: anywhere"><small>{origins}</small></p>')
    return page_frame(title, "\n".join(parts), is_self_contained=True)


def _write_pdf(summary: Summary, path: Path, dpi: int) -> None:
    """Write the two pages; the file has no date, to be the same for the same run."""
    with (
        common_style(),
        PdfPages(path, metadata={"Title": summary.title, "CreationDate": None}) as document,
    ):
        for sheet in (_first_sheet(summary), _second_sheet(summary)):
            disable_formulas(sheet.figure)
            document.savefig(sheet.figure, dpi=dpi)


class _Sheet:
    """A page of paper; texts and maps are placed from the top to the bottom [inches]."""

    def __init__(self) -> None:
        self.figure = Figure(figsize=(_WIDTH, _HEIGHT))
        self.top = _MARGIN

    def text(self, words: str, size: float = 9.5, *, after: float = 0.1, indent: float = 0.0, **style: Any) -> None:
        """Write a paragraph, wrapped to the width of the page."""
        lines = wrapped(words, _CHARACTERS * 9.5 / size * (_INSIDE - indent))
        self.figure.text(
            (_MARGIN + indent) / _WIDTH, 1 - self.top / _HEIGHT, "\n".join(lines), size=size, va="top",
            linespacing=1.35, **style,
        )  # fmt: skip
        self.top += len(lines) * size * 1.5 / 72 + after

    def heading(self, words: str) -> None:
        """Write a heading with space above it."""
        self.top += 0.12
        self.text(words, 12, after=0.08, weight="bold")

    def map(self, site: Site, classes: Classes, heading: str, highest: float) -> None:
        """Draw a map with its legend below, which together have at most a height."""
        width = min(_INSIDE, (highest - _LEGEND) * site.scene.aspect)
        height = width / site.scene.aspect
        axes = self.figure.add_axes(
            (_MARGIN / _WIDTH, 1 - (self.top + height) / _HEIGHT, width / _WIDTH, height / _HEIGHT)
        )
        handles = draw_classes(axes, site, classes)
        self.top += height
        self.figure.legend(
            handles=handles, title=heading, loc="upper left", fontsize=9, title_fontsize=9, alignment="left", ncols=4,
            bbox_to_anchor=((_MARGIN - 0.05) / _WIDTH, 1 - (self.top + 0.02) / _HEIGHT),
        )  # fmt: skip
        self.top += _LEGEND


def _first_sheet(summary: Summary) -> _Sheet:
    sheet = _Sheet()
    sheet.text(summary.title, 16, after=0.02, weight="bold")
    sheet.text("Summary of one simulated scenario", 10, color=NOTE)
    sheet.heading("Scenario")
    sheet.text(" ".join(summary.scenario))
    sheet.heading("Key numbers")
    for number in summary.numbers:
        top = sheet.top
        sheet.text(number.value, 12, after=0.0, weight="bold", color=BLUE)
        sheet.top = top + 0.02
        sheet.text(f"{number.name}. {number.meaning}", after=0.07, indent=1.75)
    sheet.heading("Affected area and thickness")
    sheet.map(summary.site, summary.thickness, _MAP_HEADING, _HEIGHT - _MARGIN - 0.5 - sheet.top)
    sheet.text(summary.site.scene.note(), 7.5, color=NOTE)
    return sheet


def _second_sheet(summary: Summary) -> _Sheet:
    sheet = _Sheet()
    sheet.text("Arrival", 12, after=0.08, weight="bold")
    rows = _rows_on_paper(summary.arrivals)
    reserved = 3.5 + 0.22 * len(rows)  # for the texts below the map
    sheet.map(summary.site, summary.arrival, _ARRIVAL_HEADING, _HEIGHT - _MARGIN - reserved - sheet.top)
    for row in [_TABLE_HEAD, *rows] if rows else []:
        top = sheet.top
        for column, cell in enumerate(row):
            sheet.top = top
            weight = "bold" if row is _TABLE_HEAD else "normal"
            sheet.text(cell, 9, after=0.03, indent=2.2 * column, weight=weight)
    sheet.heading("Limits of the numbers")
    for sentence in summary.limits:
        top = sheet.top
        sheet.text("•", after=0.0)
        sheet.top = top
        sheet.text(sentence, after=0.04, indent=0.15)
    sheet.top += 0.1
    for line in summary.origin:
        sheet.text(line, 7, after=0.0, color=NOTE)
    return sheet


def _rows_on_paper(rows: list[tuple[str, str, str]]) -> list[tuple[str, str, str]]:
    """Return the rows of arrivals that fit on the page; the last one then counts the others."""
    if len(rows) <= _MOST_ROWS:
        return rows
    shown = rows[: _MOST_ROWS - 1]
    return [*shown, (f"{len(rows) - len(shown)} others: {NAMES[0]}", "", "")]
