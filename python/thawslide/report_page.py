"""Plot the figures of a run and write their page."""

from __future__ import annotations

import html
import os
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
from thawslide.mobility import mobility_of
from thawslide.number_text import exact_text, quantity_text
from thawslide.pages.events import events_part
from thawslide.pages.facts import facts_of, inputs_of
from thawslide.pages.map_view import map_view
from thawslide.pages.markup import details, figure_part, file_data, page_frame, table
from thawslide.pages.notes import ending_note, result_warnings, resume_notes
from thawslide.pages.section_view import section_view
from thawslide.pages.view import scripts
from thawslide.run_folder import Run
from thawslide.targets import KINDS
from thawslide.time_reference import time_note

VIEW = "interactive view"  # its name among the missing figures


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
) -> Report:
    """Write figures/NAME.png and report.html into `output` (default: the run folder).

    Without `names` these are the figures that suit the run. With `names`, the page keeps the other figures in the
    folder. The page lists figures without data or with damaged files; these are an error if `names` requests them.
    """
    output = output or run.folder
    _ = run.history, run.facts, run.targets  # required by every page: errors precede the figures
    report = Report(output / "report.html")
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
        page = _page(run, report, _view(run, report, is_required=not names))
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


def _view(run: Run, report: Report, is_required: bool) -> str:
    """Return the interactive view, "" without its data; damaged data are a fault only if the view is required."""
    try:
        return (map_view(run) if on_map(run) else section_view(run)).markup()
    except ReportError as error:
        report.missing[VIEW] = str(error)
        if is_required and not isinstance(error, NotInRunError):
            report.faults.append(VIEW)
    except (ValueError, ArithmeticError, MemoryError) as error:
        report.missing[VIEW] = f"{run.folder}: cannot be plotted ({error}). Check the values of the run."
    return ""


def _page(run: Run, report: Report, view: str) -> str:
    title = html.escape(run.title)
    parts = [
        f"<h1>{title}</h1>",
        f'<p class="where">Run folder: {html.escape(run.folder.resolve().name)}</p>',
        *(f'<p class="note">{html.escape(note)}</p>' for note in _notes(run, report) if note),
        "<h2>Key numbers</h2>",
        table(((row.words, row.value, row.remark) for row in key_numbers(run)), "numbers"),
    ]
    if found := balances(run):
        rows = ((each.words, each.verdict, f"maximum residual {each.percentage}") for each in found)
        parts += ["<h2>Balances</h2>", table(rows, "numbers")]
    if run.targets:
        tables = "\n".join(_target_tables(run))
        parts.append(details("Reported values", f"{tables}\n{_times(run)}"))
    if view:
        parts += ['<h2 id="interactive">Interactive view</h2>', view]
    events = events_part({"this run": mobility_of(run)}) if run.dimension == 3 else ""
    if events:
        parts += ['<h2 id="published-events">Published events</h2>', events]
    figures = report.figures | report.kept
    shown = [name for name in FIGURES if name in figures]
    parts += [_figure(run, name, figures[name]) for name in shown]
    if maps := _map_files(run, report.page.parent):
        parts += [f'<h2 id="maps">Map files</h2>\n{maps}']
    if report.missing:
        reasons = ((_heading(name), reason) for name, reason in report.missing.items())
        parts += ["<h2>Missing figures</h2>", table(reasons, "facts")]
    if inputs := inputs_of(run.facts):
        parts += ['<h2 id="inputs">Input files</h2>', inputs]
    parts += ["<h2>Run information</h2>", *facts_of(run.facts)]
    links = [("interactive", "Interactive view")] if view else []
    links += [(name, _heading(name)) for name in shown]
    anchors = " · ".join(f'<a href="#{name}">{html.escape(words)}</a>' for name, words in links)
    parts.insert(2, f"<nav>{anchors}</nav>")
    if view or events:
        parts.append(scripts())
    return page_frame(title, "\n".join(parts), is_self_contained=True)


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


def _figure(run: Run, name: str, path: Path) -> str:
    """Return a figure with its heading; a note if it was plotted before the last row of the history."""
    caption = FIGURES[name].caption_of(run)
    if path.stat().st_mtime < (run.folder / "history.csv").stat().st_mtime:
        caption += " Plotted before the last change of history.csv."
    part = figure_part(_heading(name), file_data(path), caption, path.suffix == ".mp4")
    return f'<h2 id="{name}">{html.escape(_heading(name))}</h2>\n{part}'


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
            tables.append((f"<h3>{heading}</h3>\n" if kind else "") + table(rows, "facts", head))
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
        return maps.about(name)
    except ReportError:
        return "damaged", ""


_REPORTED_DIGITS = 6  # more than of computed values: reported values remain as published
