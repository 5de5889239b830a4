"""Plot the figures of a run and write their page."""

from __future__ import annotations

import html
import os
import re
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thawslide.atomic_file import atomic_file
from thawslide.errors import NotInRunError, ReportError
from thawslide.figures import FIGURES
from thawslide.figures.animation import Animation
from thawslide.key_numbers import boiling_note, found_for, key_numbers
from thawslide.maps import Maps, on_map
from thawslide.number_text import exact_text, integer_text, quantity_text
from thawslide.run import Run
from thawslide.run_facts import Ending, last_write_age
from thawslide.targets import KINDS
from thawslide.time_reference import time_note


@dataclass
class Report:
    """Written files: page, figures by name, reasons for missing figures, and names of those with damaged data."""

    page: Path
    figures: dict[str, Path] = field(default_factory=dict)
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

    Without `names` these are the figures that suit the run. The page lists figures without data or with damaged files;
    these are an error if `names` requests them.
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
        with atomic_file(report.page) as temporary:
            temporary.write_text(_page(run, report), encoding="utf-8")
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
                plotted.savefig(temporary, dpi=dpi)
    except (ValueError, ArithmeticError, MemoryError) as error:
        raise ReportError(f"{run.folder}: {name} cannot be plotted ({error}). Check the values of the run.") from error
    return path


def figures_of(run: Run) -> list[str]:
    """Return the names of the figures that suit a run, in the page's order."""
    return [name for name, kind in FIGURES.items() if kind.suits(run)]


def _page(run: Run, report: Report) -> str:
    title = html.escape(run.title)
    damage = (
        f"Not plotted: {', '.join(report.faults)}. Section 'Missing figures' has the reasons." if report.faults else ""
    )
    notes = [
        note
        for note in (
            ending_note(run),
            damage,
            *result_warnings(run),
            boiling_note(run),
            *resume_notes(run),
            *run.warnings,
        )
        if note
    ]
    parts = [
        f"<h1>{title}</h1>",
        f'<p class="where">Run folder: {html.escape(run.folder.resolve().name)}</p>',
        *(f'<p class="note">{html.escape(note)}</p>' for note in notes),
        "<h2>Key numbers</h2>",
        *([_times(run)] if _is_aligned(run) else []),
        _table(((row.words, row.value, row.remark) for row in key_numbers(run)), "numbers"),
    ]
    if run.targets:
        tables = "\n".join(_target_tables(run))
        parts.append(_details("Reported values", tables if _is_aligned(run) else f"{tables}\n{_times(run)}"))
    for name, path in report.figures.items():
        kind = FIGURES[name]
        heading, link = html.escape(kind.heading), f"figures/{path.name}"
        if path.suffix == ".mp4":
            shown_as = f'<video controls loop muted src="{link}" aria-label="{heading}"></video>'
        else:
            shown_as = f'<a href="{link}"><img src="{link}" alt="{heading}"></a>'
        caption = f"<figcaption>{html.escape(kind.caption_of(run))}</figcaption>"
        parts.append(f'<h2 id="{name}">{heading}</h2>\n<figure>{shown_as}\n{caption}</figure>')
    if maps := _map_files(run, report.page.parent):
        parts += [f'<h2 id="maps">Map files</h2>\n{maps}']
    if report.missing:
        reasons = ((FIGURES[name].heading, reason) for name, reason in report.missing.items())
        parts += ["<h2>Missing figures</h2>", _table(reasons, "facts")]
    parts += ["<h2>Run information</h2>", *facts_of(run.facts)]
    links = " · ".join(f'<a href="#{name}">{html.escape(FIGURES[name].heading)}</a>' for name in report.figures)
    parts.insert(2, f"<nav>{links}</nav>")
    return page_frame(title, "\n".join(parts))


def _is_aligned(run: Run) -> bool:
    """Return whether times on the page differ from those of the run; the note then precedes all times."""
    return run.time_reference.shift != 0.0


def _times(run: Run) -> str:
    return f'<p class="times">{html.escape(time_note(run))}</p>'


def _target_tables(run: Run) -> list[str]:
    """Return a table for each kind of reported values, with the values of the run."""
    tables = []
    for kind, (_, heading) in KINDS.items():
        rows = [
            (
                t.words,
                f"{exact_text(t.time)} s",
                quantity_text(t.in_its_unit(t.value), t.unit_words, _REPORTED_DIGITS),
                found_for(run, t),
                t.source,
            )
            for t in run.targets
            if t.kind == kind
        ]
        if rows:
            head = ("quantity", "time", "reported", "this run", "source")
            tables.append((f"<h3>{heading}</h3>\n" if kind else "") + _table(rows, "facts", head))
    return tables


def _map_files(run: Run, page_folder: Path) -> str:
    """Return a table of the map files with their units, "" for a run without maps."""
    if not on_map(run) or not (run.folder / "maps").is_dir():
        return ""
    maps = Maps(run)
    rows = [(f"{name}.tif", *_about(maps, name)) for name in maps.names]
    where = html.escape(Path(os.path.relpath(maps.folder, page_folder)).as_posix())
    return f'<p>Folder: <a href="{where}">{where}</a></p>\n' + _table(rows, "facts")


def _about(maps: Maps, name: str) -> tuple[str, str]:
    """Return description and unit of a map, or that it is damaged."""
    try:
        return maps.about(name)
    except ReportError:
        return "damaged", ""


def page_frame(title: str, body: str) -> str:
    """Return a whole HTML page in the style of all reports; title and body are HTML already."""
    before, between, after = re.split("TITLE|BODY", _FRAME)  # in one step: a title can contain "BODY"
    return f"{before}{title}{between}{body}{after}"


def ending_note(run: Run) -> str:
    """Return a sentence if the run is incomplete or ended early, "" otherwise."""
    message = str(run.facts.get("message") or "")
    command = f"`thawslide resume {shlex.quote(str(run.folder))}`"
    advice = f"To continue from its last checkpoint: {command}."
    if run.ending is Ending.DONE:
        return message[:1].upper() + message[1:]
    if run.ending is Ending.UNKNOWN:
        return "There is no run.json: it is unknown whether this run is complete."
    if run.ending is Ending.KILLED:
        return (
            "This run terminated unexpectedly: its status in run.json is running, but no process holds run.lock. "
            f"{advice} The figures show the results so far."
        )
    if run.ending is Ending.UNDETERMINED:
        return (
            "The status of this run in run.json is running. It cannot be checked, because the file system has no "
            f"locks. The last file was written {_age(last_write_age(run.folder))} before this page. If the run has "
            f"terminated, {command} continues from its last checkpoint. The figures show the results so far."
        )
    words = "was still running when this page was written" if run.ending is Ending.RUNNING else run.ending.value
    note = f"This run is incomplete ({words}){f': {message}' if message else ''}. The figures show the results so far."
    return f"{note} {advice}" if run.ending is Ending.STOPPED else note


def result_warnings(run: Run) -> list[str]:
    """Return the warnings of run.json on the results, for example if the mass is not at rest."""
    return [f"Warning: {warning[:1000]}" for warning in run.facts.get("warnings", [])[:20]]


def resume_notes(run: Run) -> list[str]:
    """Return the damage that parts of a run found when they resumed, for example lost rows."""
    parts = run.facts.get("parts")
    found = [part.get("warnings") for part in parts if isinstance(part, dict)] if isinstance(parts, list) else []
    return [str(text)[:1000] for texts in found if isinstance(texts, list) for text in texts[:100]]


def _age(seconds: float) -> str:
    for unit, length in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{seconds:.0f} s"


def _table(rows: Any, style: str, head: Sequence[str] = ()) -> str:
    """Return a table; the first cell of each row is its heading."""
    lines = []
    if head:
        lines.append("<tr>" + "".join(f'<th scope="col">{html.escape(cell)}</th>' for cell in head) + "</tr>")
    for first, *rest in rows:
        cells = "".join(f"<td>{html.escape(str(cell))}</td>" for cell in rest)
        lines.append(f'<tr><th scope="row">{html.escape(str(first))}</th>{cells}</tr>')
    return f'<table class="{style}">\n' + "\n".join(lines) + "\n</table>"


def _details(heading: str, inside: str) -> str:
    return f"<details><summary>{html.escape(heading)}</summary>\n{inside}\n</details>"


def facts_of(facts: dict[str, Any]) -> list[str]:
    """Return run.json as a table of its single values and one collapsed table for each value with parts."""
    if not facts:
        return ["<p>No run.json: the run was interrupted before it was written.</p>"]
    single = [(_words(key), _value(value)) for key, value in facts.items() if not _has_parts(value)]
    parts = [_table(single, "facts")]
    for key, value in facts.items():
        if isinstance(value, dict) and value:
            rows: Any = [(_words(name), _value(part)) for name, part in value.items()]
        elif _has_parts(value):
            rows = [(number, _value(part)) for number, part in enumerate(value, 1)]
        else:
            continue
        parts.append(_details(_words(key), _table(rows, "facts")))
    return parts


def _has_parts(value: Any) -> bool:
    """Return whether a value has a separate table: a non-empty object, or a list of objects or long texts."""
    if isinstance(value, dict):
        return bool(value)
    return isinstance(value, list) and any(isinstance(part, dict) or len(str(part)) > 40 for part in value)


def _words(key: str) -> str:
    return key.replace("_", " ")


def _value(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    if isinstance(value, float):
        return integer_text(value)
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, dict):
        return ", ".join(f"{_words(key)}: {_value(part)}" for key, part in value.items()) or "none"
    if isinstance(value, list):
        return ", ".join(_value(part) for part in value) or "none"
    return str(value) or "none"


_REPORTED_DIGITS = 6  # more than of computed values: reported values remain as published
_FRAME = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>TITLE</title>
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
.numbers td:nth-child(2) { font-weight: 600; font-variant-numeric: tabular-nums; white-space: nowrap; }
details { margin: .8rem 0; }
summary { cursor: pointer; color: #0a5fb4; margin-bottom: .4rem; }
figure { margin: 0; }
img, video { max-width: 100%; height: auto; display: block; }
figcaption { font-size: .88rem; margin-top: .3rem; }
@media print { nav { display: none; } figure { break-inside: avoid; } }
</style>
</head>
<body>
BODY
</body>
</html>
"""
