"""Command `scripts/pages`: makes pages of results again."""

from __future__ import annotations

import argparse
import os
import sys
import time
import traceback
from collections.abc import Sequence
from pathlib import Path

from reproduction.studies import STUDIES
from reproduction.study import ROOT, Place, Study
from thawslide.errors import ReportError

DESCRIPTION = """Performs the missing runs of all studies and writes their pages and figures again.

Finished runs of the same program, case and inputs are reused. A study whose inputs are absent is skipped. The blind
forecast (joffre) is made only if it is named. Exit codes: 0 no study failed, 1 a study failed or a number of a page
differs from its run, 2 wrong usage. The last line names the skipped studies."""


def parser() -> argparse.ArgumentParser:
    """Return the options of the command line."""
    found = argparse.ArgumentParser(
        prog="scripts/pages", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    found.add_argument("--list", action="store_true", help="list the studies with their run time and their pages")
    found.add_argument(
        "--only",
        nargs="+",
        metavar="STUDY[:PART]",
        default=[],
        help="only these studies; PART is a pattern for names of runs, parts or pages, such as refinement:plane-*",
    )
    found.add_argument("--draw-only", action="store_true", help="write the pages from existing runs")
    found.add_argument("--quick", action="store_true", help="test: coarse and short runs, output in runs/quick")
    found.add_argument("--jobs", type=int, default=2, metavar="N", help="simultaneous runs, on one thread each (2)")
    found.add_argument("--correct", action="store_true", help="correct numbers of hand-written pages; review the diff")
    found.add_argument("--data", type=Path, default=Place.data, metavar="DIR", help="terrain and releases")
    found.add_argument("--avaframe", type=Path, metavar="VENV", help="virtual environment of AvaFrame")
    found.add_argument("--output", type=Path, default=ROOT / "runs", metavar="DIR", help="folder of the runs (runs)")
    program = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    found.add_argument("--program", type=Path, default=program, metavar="FILE", help="the program thawslide")
    return found


def selected(names: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return the parts of each selected study, in the order of the studies; ReportError for an unknown study."""
    parts: dict[str, list[str]] = {}
    for name in names or [study.name for study in STUDIES.values() if not study.is_frozen]:
        study, _, part = name.partition(":")
        if study not in STUDIES:
            raise ReportError(f"--only: unknown study (found {study}; allowed: {', '.join(STUDIES)}).")
        parts.setdefault(study, []).extend([part] if part else [])
    return {study: tuple(parts[study]) for study in STUDIES if study in parts}


def place_of(study: Study, given: argparse.Namespace, parts: tuple[str, ...], started: float) -> Place:
    """Return where a study is made."""
    output = given.output.resolve() / ("quick" if given.quick else "")

    def report(line: str) -> None:
        print(f"{time.monotonic() - started:6.0f} s  {study.name}: {line}", flush=True)

    return Place(
        program=given.program.resolve(),
        runs=output / (study.folder or f"pages/{study.name}"),
        pages=output / "written" if given.quick else ROOT,
        data=given.data.resolve(),
        cases=study.cases,
        report=report,
        at_a_time=given.jobs,
        is_quick=given.quick,
        draws_only=given.draw_only,
        corrects=given.correct,
        tolerates_failures=study.tolerates_failures,
        avaframe=given.avaframe.resolve() if given.avaframe else None,
        parts=parts,
    )


def list_studies(given: argparse.Namespace) -> None:
    """Print the studies: name, processor time, pages, and why a study is not made."""
    for study in STUDIES.values():
        absent = study.absent(place_of(study, given, (), 0.0))
        notes = ["frozen: made only if it is named"] if study.is_frozen else []
        notes += [f"skipped: not found: {', '.join(map(str, absent))}"] if absent else []
        print(f"{study.name:13}{study.minutes:5.0f} min  {', '.join(study.pages)}" + "".join(f"  ({x})" for x in notes))


def make(study: Study, place: Place) -> str:
    """Make the pages of a study; return "made", "skipped" or "failed"."""
    if absent := study.absent(place):
        place.report(f"skipped: not found: {', '.join(map(str, absent))}. {study.remedy}".rstrip())
        return "skipped"
    if not place.draws_only:
        place.report(f"about {study.minutes:.0f} min of processor time without existing runs")
    try:
        problems = study.make(place)
    except ReportError as error:
        problems = [f"error: {error}"]
    except Exception as error:  # the other studies continue
        traceback.print_exc()
        problems = [f"error: {type(error).__name__}: {error}"]
    for line in problems:
        place.report(line)
    place.report("failed" if problems else f"wrote {', '.join(study.pages)}")
    return "failed" if problems else "made"


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the selected pages; return the exit code."""
    given = parser().parse_args(arguments)
    started = time.monotonic()
    if given.list:
        list_studies(given)
        return 0
    try:
        chosen = selected(given.only)
        if not given.draw_only and not given.program.is_file():
            raise ReportError(f"program not found: {given.program}. Build it with ./run --setup.")
    except ReportError as error:
        print(f"scripts/pages: error: {error}", file=sys.stderr)
        return 2
    ended: dict[str, list[str]] = {"made": [], "skipped": [], "failed": []}
    try:
        for name, parts in chosen.items():
            study = STUDIES[name]
            ended[make(study, place_of(study, given, parts, started))].append(name)
    except KeyboardInterrupt:
        print("interrupted; the same command continues", file=sys.stderr)
        return 1
    print("; ".join(f"{how}: {', '.join(names)}" for how, names in ended.items() if names))
    return 1 if ended["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
