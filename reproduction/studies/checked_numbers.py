"""Comparison of the numbers of hand-written pages with the results of runs. page_numbers.toml lists the numbers."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

from reproduction.engine import failure, perform
from reproduction.one_at_a_time import incompleteness
from reproduction.page_measures import Block, Measured, from_table
from reproduction.page_numbers import (
    Declarations,
    Page,
    corrected,
    differences,
    misplaced,
    needed_runs,
    read_declarations,
)
from reproduction.study import ROOT, Job, Place, Study, StudyError

DECLARATIONS = ROOT / "reproduction" / "page_numbers.toml"


def chosen_pages(declared: Declarations, place: Place) -> dict[str, Page]:
    """Return the selected pages by their file; StudyError for a phrase that its page does not contain."""
    pages = {page.file: page for page in declared.pages if place.is_chosen(page.file)}
    if not pages:
        allowed = ", ".join(page.file for page in declared.pages)
        raise StudyError(f"{', '.join(place.parts)}: not in reproduction/page_numbers.toml (allowed: {allowed})")
    wrong = [line for file, page in pages.items() for line in misplaced(page, source_of(file))]
    if wrong:
        raise StudyError("\n".join(wrong))
    return pages


def source_of(file: str) -> str:
    """Return the text of a page."""
    return (ROOT / file).read_text(encoding="utf-8")


def declared_runs(declared: Declarations, pages: dict[str, Page], place: Place) -> dict[str, tuple[str, ...]]:
    """Return the runs that pages need, with the folder of data; report each run whose data are absent."""
    runs = {}
    for name in sorted(needed_runs(declared, pages)):
        words = [word.replace("{data}", str(place.data)).replace("{root}", str(ROOT)) for word in declared.runs[name]]
        files = [Path(word.partition("=")[2] or word) for word in words if str(place.data) in word]
        if absent := [str(file) for file in files if not file.is_file()]:
            place.report(f"{name}: skipped (not found: {', '.join(absent)}). Give the folder of the data with --data.")
        else:
            runs[name] = tuple(words)
    return runs


def job_of(name: str, words: tuple[str, ...], place: Place) -> Job:
    """Return the run of a declaration: a case, `block` and a case, or `new` with a DEM and a release; then settings."""
    subcommand, words = ("block", words[1:]) if words[0] == "block" else ("run", words)
    if words[0] == "new":
        words = (new_case(name, words, place), *words[3:])
    case = words[0] if (ROOT / words[0]).is_file() else str(Path(words[0]) / "case.toml")
    return Job(name, name, words[1:], case, subcommand)


def new_case(name: str, words: tuple[str, ...], place: Place) -> str:
    """Create a case from a DEM and a release; return its folder."""
    folder = place.runs / f"{name}-case"
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    command = [str(place.program), "new", str(folder), "--dem", str(ROOT / words[1]), "--release", str(ROOT / words[2])]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise StudyError(f"{name}: {done.stderr.strip()}")
    return str(folder)


def compare(place: Place) -> list[str]:
    """Perform the missing runs and compare; return the numbers that differ and the runs without results."""
    declared = read_declarations(DECLARATIONS)
    pages = chosen_pages(declared, place)
    runs = declared_runs(declared, pages, place)
    if place.is_quick:  # the first steps of one case
        runs = dict(list(runs.items())[:1])
    if not place.draws_only:
        jobs = [job_of(name, words, place) for name, words in runs.items()]
        jobs = [replace(job, sets=(*job.sets, "time.end=0.1")) for job in jobs] if place.is_quick else jobs
        perform([place.task(job) for job in jobs], place.at_a_time, place.report)
    found: dict[str, Block | Measured] = {}
    problems = []
    for name, words in runs.items():
        is_block = words[0] == "block"
        results = place.runs / (f"{name}.csv" if is_block else name)
        if why := failure(results) or ("" if is_block else incompleteness(results)):
            problems.append(f"{name}: no results, because the run did not finish ({why})")
        else:
            found[name] = Block(results) if is_block else Measured(results)

    def table(page: str, column: str, *keys: str) -> float:
        return from_table(source_of(page), column, *keys)

    absent = declared.runs.keys() - found.keys()
    compared, wrong = 0, []
    for file, page in pages.items():
        names = {**declared.texts, "table": table, **found}
        lines, number = differences(page, source_of(file), names, absent)
        wrong += lines
        compared += number
        if place.corrects and lines:
            new_source, new_declarations = corrected(source_of(file), DECLARATIONS.read_text(encoding="utf-8"), lines)
            (ROOT / file).write_text(new_source, encoding="utf-8")
            DECLARATIONS.write_text(new_declarations, encoding="utf-8")
    place.report(f"{compared} numbers compared, {len(wrong)} differ")
    return problems + ([] if place.is_quick else [str(each) for each in wrong])


STUDY = Study("numbers", ("README.md and other hand-written pages (compared; --correct)",), 60.0, compare)
