"""Plot the figures of a run and write their page: results for a client, then all figures, then the diagnosis."""

from __future__ import annotations

import html
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from thawslide.atomic_file import atomic_file
from thawslide.balance import balance_note, balances
from thawslide.errors import NotInRunError, ReportError
from thawslide.figures import FIGURES
from thawslide.figures.animation import Animation
from thawslide.figures.style import save_figure
from thawslide.key_numbers import boiling_note, found_for, key_numbers
from thawslide.maps import Maps, on_map
from thawslide.messages import LANGUAGES, Messages
from thawslide.mobility import mobility_of
from thawslide.number_text import exact_text, quantity_text, unit_text
from thawslide.pages.events import events_part
from thawslide.pages.facts import facts_of, inputs_of, settings_of
from thawslide.pages.map_view import map_view
from thawslide.pages.markup import details, figure_part, file_data, page_frame, table
from thawslide.pages.notes import ending_note, result_warnings, resume_notes
from thawslide.pages.results import extent, results
from thawslide.pages.section_view import section_view
from thawslide.pages.view import scripts
from thawslide.run_folder import Run
from thawslide.scores.output import REPORT, stored_section
from thawslide.targets import KINDS
from thawslide.time_reference import time_note

VIEW, EXTENT = "interactive view", "extent of the results"  # their names among the missing figures
# Figures of the diagnosis; the others show results.
_OF_DIAGNOSIS = (
    "slide_temperature", "base_temperature", "base_pressure", "temperature", "pore_pressure", "band", "base_along",
    "energy", "entrainment", "water",
)  # fmt: skip


@dataclass
class Report:
    """Written files: page, figures by name, reasons for missing figures, and names of those with damaged data.

    `kept` has the figures of the page that an earlier report plotted.
    """

    page: Path
    figures: dict[str, Path] = field(default_factory=dict)
    kept: dict[str, Path] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)


def make_report(
    run: Run,
    output: Path | None = None,
    names: Sequence[str] | None = None,
    dpi: int = 150,
    progress: Callable[[str], None] = lambda line: None,
    language: str = LANGUAGES[0],
) -> Report:
    """Write figures/NAME.png and report.html into `output` (default: the run folder).

    `language` is that of the results; figures and diagnosis are in English.

    Without `names` these are the figures that suit the run. With `names`, the page keeps the other figures in the
    folder. The page lists figures without data or with damaged files; these are an error if `names` requests them.
    """
    output = output or run.folder
    _ = run.series, run.facts, run.targets  # required by every page: errors precede the figures
    report = Report(output / REPORT)
    if (output / "figures").is_symlink():
        raise ReportError(f"{output / 'figures'}: a link, not a folder. Remove the link.")
    try:
        (output / "figures").mkdir(parents=True, exist_ok=True)
        chosen = list(names or figures_of(run))
        for number, name in enumerate(chosen, 1):
            try:
                report.figures[name] = _write_figure(run, name, output / "figures", dpi, progress)
                progress(f"[{number}/{len(chosen)}] {name}: {report.figures[name]}")
            except ReportError as error:
                if names:
                    raise
                report.missing[name] = str(error)
                if not isinstance(error, NotInRunError):
                    report.faults.append(name)
                progress(f"[{number}/{len(chosen)}] {name}: not available: {error}")
        report.kept = _kept_figures(run, output / "figures", report) if names else {}
        say = Messages(language)
        shown = _part(run, report, EXTENT, not names, lambda: extent(run, say, dpi))
        view = _part(
            run, report, VIEW, not names, lambda: (map_view(run) if on_map(run) else section_view(run)).markup()
        )
        page = _page(run, report, say, shown, view)
        with atomic_file(report.page) as temporary:
            temporary.write_text(page, encoding="utf-8")
    except OSError as error:
        raise ReportError(
            f"{error.filename or output}: cannot be written ({error.strerror or error}). Select another --output."
        ) from error
    return report


def _write_figure(run: Run, name: str, folder: Path, dpi: int, progress: Callable[[str], None]) -> Path:
    """Write one figure into a folder; ReportError if its numbers cannot be plotted."""
    try:
        plotted = FIGURES[name].plot(run)
        path = folder / f"{name}{'.mp4' if isinstance(plotted, Animation) else '.png'}"
        if isinstance(plotted, Animation):
            plotted.write(path, dpi, progress)
        else:
            with atomic_file(path) as temporary:
                save_figure(plotted, temporary, dpi=dpi)
    except (ValueError, ArithmeticError, MemoryError) as error:
        raise ReportError(f"{run.folder}: {name} cannot be plotted ({error}). Check the values of the run.") from error
    return path


def figures_of(run: Run) -> list[str]:
    """Return the names of the figures that suit a run, in the page's order."""
    return [name for name, kind in FIGURES.items() if kind.suits(run)]


def _kept_figures(run: Run, folder: Path, report: Report) -> dict[str, Path]:
    """Return the figures that suit the run, are in the folder, and are not plotted by this report."""
    kept = {}
    for name in figures_of(run):
        for path in (folder / f"{name}.png", folder / f"{name}.mp4"):
            if name not in report.figures and path.is_file() and not path.is_symlink():
                kept[name] = path
    return kept


def _part(run: Run, report: Report, name: str, is_required: bool, make: Callable[[], str]) -> str:
    """Return a part of the page, "" without its data; damaged data are a fault only if the part is required."""
    try:
        return make()
    except ReportError as error:
        report.missing[name] = str(error)
        if is_required and not isinstance(error, NotInRunError):
            report.faults.append(name)
    except (ValueError, ArithmeticError, MemoryError) as error:
        report.missing[name] = f"{run.folder}: cannot be plotted ({error}). Check the values of the run."
    return ""


def _page(run: Run, report: Report, say: Messages, shown: str, view: str) -> str:
    figures = report.figures | report.kept
    of_results = [name for name in FIGURES if name in figures and name not in _OF_DIAGNOSIS]
    events = events_part({"this run": mobility_of(run)}) if run.dimension == 3 else ""
    numbers = [
        "<h2>Key numbers</h2>",
        table(((row.words, row.value, row.remark) for row in key_numbers(run)), "numbers"),
    ]
    if run.targets:
        tables = "\n".join(_target_tables(run))
        numbers.append(details("Reported values", f"{tables}\n{_times(run)}"))
    if view:
        numbers += ['<h2 id="interactive">Interactive view</h2>', view]
    if events:
        numbers += ['<h2 id="published-events">Published events</h2>', events]
    numbers += [_figure(run, name, figures[name]) for name in of_results]
    if maps := _map_files(run, report.page.parent):
        numbers += [f'<h2 id="maps">Map files</h2>\n{maps}']
    links = [("interactive", "Interactive view")] if view else []
    numbers.insert(0, _links([*links, *((_anchor(name), _heading(name)) for name in of_results)]))
    parts = [
        results(run, say, shown),
        stored_section(run.folder),
        details(say("details_numbers"), "\n".join(numbers), "numbers"),
        details(say("details_diagnosis"), "\n".join(_diagnosis(run, report, figures)), "diagnosis"),
    ]
    if view or events:
        parts.append(scripts())
    return page_frame(html.escape(run.title), "\n".join(parts), is_self_contained=True, language=say.language)


def _diagnosis(run: Run, report: Report, figures: dict[str, Path]) -> list[str]:
    """Return notes, balances, figures of base and budgets, missing figures, inputs, settings and facts of the run."""
    of_diagnosis = [name for name in _OF_DIAGNOSIS if name in figures]
    parts = [
        _links([(_anchor(name), _heading(name)) for name in of_diagnosis]),
        *(f'<p class="note">{html.escape(_local(note))}</p>' for note in _notes(run, report) if note),
    ]
    if found := balances(run):
        rows = ((each.words, each.verdict, f"maximum residual {each.percentage}") for each in found)
        parts += ["<h2>Balances</h2>", table(rows, "numbers")]
    parts += [_figure(run, name, figures[name]) for name in of_diagnosis]
    if report.missing:
        reasons = ((_heading(name), _local(reason)) for name, reason in report.missing.items())
        parts += ["<h2>Missing figures</h2>", table(reasons, "facts")]
    if inputs := inputs_of(run.facts):
        parts += ['<h2 id="inputs">Input files</h2>', inputs]
    if settings := settings_of(run):
        parts += ["<h2>Settings</h2>", details("Keys of the case; all others have their defaults", settings)]
    parts += ["<h2>Run information</h2>", *facts_of(run.facts)]
    return parts


def _links(links: list[tuple[str, str]]) -> str:
    anchors = " · ".join(f'<a href="#{name}">{html.escape(words)}</a>' for name, words in links)
    return f"<nav>{anchors}</nav>"


def _local(text: str) -> str:
    """Return a text whose absolute paths are without their folders, which are those of one machine."""
    return re.sub(r"(?<![\w./~-])/(?:[\w.+~-]+/)+", "", text)


def _notes(run: Run, report: Report) -> list[str]:
    names = ", ".join(report.faults)
    damage = f"Not plotted: {names}. Section 'Missing figures' has the reasons." if names else ""
    return [
        ending_note(run),
        damage,
        *result_warnings(run),
        boiling_note(run),
        balance_note(run),
        *resume_notes(run),
        *run.warnings,
    ]


def _heading(name: str) -> str:
    return FIGURES[name].heading if name in FIGURES else name.capitalize()


def _anchor(name: str) -> str:
    """Return the id of a figure's heading, which differs from the ids of the interactive plots."""
    return f"figure-{name}"


def _figure(run: Run, name: str, path: Path) -> str:
    """Return a figure with its heading; a note if it was plotted before the last row of the history."""
    caption = FIGURES[name].caption_of(run)
    if path.stat().st_mtime < (run.folder / "history.csv").stat().st_mtime:
        caption += " Plotted before the last change of history.csv."
    part = figure_part(_heading(name), file_data(path), caption, path.suffix == ".mp4")
    return f'<h2 id="{_anchor(name)}">{html.escape(_heading(name))}</h2>\n{part}'


def _times(run: Run) -> str:
    return f'<p class="times">{html.escape(time_note(run))}</p>'


def _target_tables(run: Run) -> list[str]:
    """Return a table for each kind of reported values, with the values of the run."""
    tables = []
    for kind, (_, heading) in KINDS.items():
        rows = [
            (
                t.words,
                f"{exact_text(round(t.time, 1))} s",
                quantity_text(t.in_its_unit(t.value), t.unit_words, _REPORTED_DIGITS),
                found_for(run, t),
                t.source,
            )
            for t in run.targets
            if t.kind == kind
        ]
        if rows:
            head = ("quantity", "time", "reported", "this run", "source")
            tables.append((f"<h3>{heading}</h3>\n" if kind else "") + table(rows, "facts wide", head))
    return tables


def _map_files(run: Run, page_folder: Path) -> str:
    """Return a table of the map files with their units, "" for a run without maps."""
    if not on_map(run) or not (run.folder / "maps").is_dir():
        return ""
    maps = run.maps
    rows = [(f"{name}.tif", *_about(maps, name)) for name in maps.names]
    where = html.escape(Path(os.path.relpath(maps.folder, page_folder)).as_posix())
    return f'<p>Folder: <a href="{where}">{where}</a></p>\n' + table(rows, "facts")


def _about(maps: Maps, name: str) -> tuple[str, str]:
    """Return description and unit of a map, or that it is damaged."""
    try:
        description, unit = maps.about(name)
    except ReportError:
        return "damaged", ""
    return description, unit_text(unit)


_REPORTED_DIGITS = 6  # more than of computed values: reported values remain as published
