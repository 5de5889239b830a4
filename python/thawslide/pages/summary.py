"""Two-page summary of a run for non-experts, as HTML and as PDF."""

from __future__ import annotations

import html
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.figures.area import Area, whole_figure
from thawslide.figures.class_maps import (
    Classes,
    arrival_classes,
    class_map_height,
    draw_class_map,
    probability_classes,
    thickness_classes,
)
from thawslide.figures.map_panel import covered_box
from thawslide.figures.section_results import draw_section_arrival, draw_section_extent
from thawslide.figures.site import Site, make_site
from thawslide.figures.style import BLUE, NOTE, RED, common_style, disable_formulas, styled, wrapped
from thawslide.maps import on_map, read_map
from thawslide.messages import LANGUAGES, Messages
from thawslide.pages.client_text import ClientText, client_text
from thawslide.pages.logo import logo_html, logo_of
from thawslide.pages.markup import drawn_data, figure_part, items, page_frame, table
from thawslide.pages.results import map_note
from thawslide.run_folder import Run

NAMES = ("summary.html", "summary.pdf")
_WIDTH, _HEIGHT, _MARGIN = 8.27, 11.69, 0.75  # inches: A4
_INSIDE = _WIDTH - 2 * _MARGIN
_LOGO = (1.5, 0.6)  # inches, largest
_CHARACTERS = 14.5  # of a text of 9.5 points in one inch
_HIGHEST, _BETWEEN = 3.9, 0.3  # inches, of the maps of the second page, and between them
_MOST_ROWS = 12  # of arrivals on paper, to leave space for the map


@dataclass(frozen=True)
class Panel:
    """A map or section: heading, caption, its height in a width and a maximum height [inches], and the drawing."""

    heading: str
    caption: str
    height: Callable[[float, float], float]
    draw: Callable[[Area], None]

    @styled
    def figure(self) -> Figure:
        """Return the panel as a figure for the page in HTML."""
        area = whole_figure(_INSIDE, self.height(_INSIDE, _INSIDE))
        self.draw(area)
        return area.figure


@dataclass(frozen=True)
class Summary:
    """Texts, and the panels of the first and of the second page."""

    title: str
    say: Messages
    context: str
    members: int  # of a forecast; 0: a single run
    text: ClientText
    first: Panel
    second: list[Panel]
    run: Run

    @property
    def limits(self) -> list[str]:
        """The limits, those of probabilities first."""
        if not self.members:
            return self.text.limits
        of_runs = [sentence for sentence in self.text.limits if sentence != self.say("limit_scenario")]
        return [self.say("limit_probability"), *of_runs]

    @property
    def subtitle(self) -> str:
        """The kind of the summary, its date and the program."""
        kind = self.say("summary_forecast", count=self.members) if self.members else self.say("summary")
        return f"{kind}, {self.text.computed}"

    @property
    def head(self) -> tuple[str, ...]:
        """The heading of the table of arrivals."""
        return tuple(self.say(name) for name in ("place", "place_arrival", "place_thickness"))


def make_summary(
    run: Run,
    output: Path | None = None,
    dpi: int = 150,
    language: str = LANGUAGES[0],
    context: str = "",
    members: int = 0,
    probability: Path | None = None,
) -> tuple[Path, Path]:
    """Write summary.html and summary.pdf into `output` (default: the run folder); return their paths.

    `context`: a sentence on the run in a forecast of so many `members`. `probability`: its map of being reached.
    """
    say = Messages(language)
    page, document = ((output or run.folder) / name for name in NAMES)
    try:
        first, *second = _map_panels(run, say, probability) if on_map(run) else _section_panels(run, say)
        summary = Summary(
            run.title, say, context, members, client_text(run, say, "warning_in_report"), first, second, run
        )
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


def _map_panels(run: Run, say: Messages, probability: Path | None) -> list[Panel]:
    """Return the maps of a run, that of the probability first."""
    reached = covered_box(read_map(probability)) if probability else None
    site = make_site(run, () if reached is None else (reached,))
    note = map_note(site, say)
    found = []
    if probability:
        words = f"{say('probability_caption')} {note}"
        found.append(_map_panel(site, probability_classes(site, probability, say), "head_probability", words, say))
    found.append(_map_panel(site, thickness_classes(site, say), "head_area", note, say))
    found.append(_map_panel(site, arrival_classes(site, say), "head_arrival", say("arrival_caption"), say))
    return found


def _map_panel(site: Site, classes: Classes, heading: str, caption: str, say: Messages) -> Panel:
    return Panel(
        say(heading),
        caption,
        lambda width, highest: class_map_height(site, classes, width, highest),
        lambda area: draw_class_map(area, site, classes, say),
    )


def _section_panels(run: Run, say: Messages) -> list[Panel]:
    """Return the extent of a section, and the arrival of its front."""
    return [
        Panel(
            say("head_section"), say("section_caption"), lambda width, highest: min(0.75 * width, highest),
            lambda area: draw_section_extent(area, run, say),
        ),
        Panel(
            say("head_arrival"), say("front_caption"), lambda width, highest: min(0.45 * width, highest),
            lambda area: draw_section_arrival(area, run, say),
        ),
    ]  # fmt: skip


def _page(summary: Summary, dpi: int) -> str:
    say, text = summary.say, summary.text
    title = html.escape(summary.title)
    numbers = ((each.name, each.value, each.spread, each.meaning) for each in text.numbers)
    parts = [
        *logo_html(summary.run),
        f"<h1>{title}</h1>",
        f'<p class="where">{html.escape(summary.subtitle)}</p>',
        *(f'<p class="note">{html.escape(alert)}</p>' for alert in text.alerts),
        f"<h2>{html.escape(say('head_scenario'))}</h2>",
        f"<p>{html.escape(_scenario(summary))}</p>",
        f"<h2>{html.escape(say('head_numbers'))}</h2>",
        table(numbers, "numbers"),
        f"<p><small>{html.escape(text.ranges)}</small></p>",
        *_shown(summary.first, dpi, ""),
        *_shown(summary.second[0], dpi, ' style="break-before: page"'),
        *(part for panel in summary.second[1:] for part in _shown(panel, dpi, "")),
    ]
    if text.arrivals:
        parts.append(table(text.arrivals, "runs wide", summary.head))
    parts += [f"<h2>{html.escape(say('head_assumptions'))}</h2>", items(text.assumptions)]
    parts += [f"<h2>{html.escape(say('head_limits'))}</h2>", items(summary.limits)]
    origins = "<br>".join(html.escape(line) for line in text.origin)
    parts.append(f'<p class="where" style="overflow-wrap: anywhere"><small>{origins}</small></p>')
    return page_frame(title, "\n".join(parts), is_self_contained=True, language=say.language)


def _shown(panel: Panel, dpi: int, style: str) -> list[str]:
    heading = html.escape(panel.heading)
    return [f"<h2{style}>{heading}</h2>", figure_part(panel.heading, drawn_data(panel.figure(), dpi), panel.caption)]


def _scenario(summary: Summary) -> str:
    return " ".join([*summary.text.scenario, summary.context]).rstrip()


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

    def text(
        self,
        words: str,
        size: float = 9.5,
        *,
        after: float = 0.1,
        indent: float = 0.0,
        width: float = _INSIDE,
        **style: Any,
    ) -> None:
        """Write a paragraph, wrapped to a width and to that of the page."""
        lines = wrapped(words, _CHARACTERS * 9.5 / size * min(width, _INSIDE - indent))
        self.figure.text(
            (_MARGIN + indent) / _WIDTH, 1 - self.top / _HEIGHT, "\n".join(lines), size=size, va="top",
            linespacing=1.35, **style,
        )  # fmt: skip
        self.top += len(lines) * size * 1.5 / 72 + after

    def heading(self, words: str) -> None:
        """Write a heading with space above it."""
        self.top += 0.12
        self.text(words, 12, after=0.08, weight="bold")

    def panels(self, panels: list[Panel], highest: float) -> None:
        """Draw panels next to each other with their captions, at most so high."""
        width = (_INSIDE - (len(panels) - 1) * _BETWEEN) / len(panels)
        tallest = max(panel.height(width, highest) for panel in panels)
        start = self.top
        ends = []
        for number, panel in enumerate(panels):
            left = number * (width + _BETWEEN)
            self.top = start
            if number or len(panels) > 1:
                self.text(panel.heading, 10, after=0.04, indent=left, width=width, weight="bold")
            panel.draw(Area(self.figure, _MARGIN + left, self.top, width, panel.height(width, highest)))
            self.top += tallest + 0.05
            self.text(panel.caption, 7.5, after=0.05, indent=left, width=width, color=NOTE)
            ends.append(self.top)
        self.top = max(ends)

    def list(self, sentences: Sequence[str]) -> None:
        """Write sentences as a list."""
        for sentence in sentences:
            top = self.top
            self.text("•", 9, after=0.0)
            self.top = top
            self.text(sentence, 9, after=0.03, indent=0.15)


def _first_sheet(summary: Summary) -> _Sheet:
    sheet, say, text = _Sheet(), summary.say, summary.text
    logo = logo_of(summary.run)
    if logo is not None:
        width = min(_LOGO[0], _LOGO[1] * logo.width / logo.height)
        height = width * logo.height / logo.width
        area = (1 - (_MARGIN + width) / _WIDTH, 1 - (_MARGIN + height) / _HEIGHT, width / _WIDTH, height / _HEIGHT)
        axes = sheet.figure.add_axes(area)
        axes.imshow(np.asarray(logo), interpolation="antialiased")
        axes.set_axis_off()
    sheet.text(summary.title, 16, after=0.02, width=_INSIDE - (0.0 if logo is None else _LOGO[0]), weight="bold")
    sheet.text(summary.subtitle, 10, color=NOTE)
    for alert in text.alerts:
        sheet.text(alert, color=RED, weight="bold")
    sheet.heading(say("head_scenario"))
    sheet.text(_scenario(summary))
    sheet.heading(say("head_numbers"))
    for number in text.numbers:
        top = sheet.top
        sheet.text(number.value, 12, after=0.0, weight="bold", color=BLUE)
        sheet.top = top + 0.02
        spread = f" ({number.spread})" if number.spread else ""
        sheet.text(f"{number.name}{spread}. {number.meaning}", after=0.07, indent=2.0)
    sheet.text(text.ranges, 8, color=NOTE)
    sheet.heading(summary.first.heading)
    sheet.panels([summary.first], _HEIGHT - _MARGIN - 0.4 - sheet.top)
    return sheet


def _second_sheet(summary: Summary) -> _Sheet:
    sheet, say, text = _Sheet(), summary.say, summary.text
    if len(summary.second) == 1:
        sheet.text(summary.second[0].heading, 12, after=0.08, weight="bold")
    rows = _rows_on_paper(text.arrivals, say)
    sheet.panels(summary.second, _HIGHEST if len(rows) < _MOST_ROWS // 2 else _HIGHEST - 1.0)
    for number, row in enumerate([summary.head, *rows] if rows else []):
        top = sheet.top
        for column, cell in enumerate(row):
            sheet.top = top
            weight = "bold" if number == 0 else "normal"
            sheet.text(cell, 9, after=0.03, indent=2.2 * column, weight=weight)
    sheet.heading(say("head_assumptions"))
    sheet.list(text.assumptions)
    sheet.heading(say("head_limits"))
    sheet.list(summary.limits)
    sheet.top += 0.1
    for line in text.origin:
        sheet.text(line, 7, after=0.0, color=NOTE)
    return sheet


def _rows_on_paper(rows: list[tuple[str, str, str]], say: Messages) -> list[tuple[str, ...]]:
    """Return the rows of arrivals that fit on the page; the last one then counts the others."""
    if len(rows) <= _MOST_ROWS:
        return [*rows]
    shown = rows[: _MOST_ROWS - 1]
    return [*shown, (say("more_places", count=len(rows) - len(shown), file=NAMES[0]), "", "")]
