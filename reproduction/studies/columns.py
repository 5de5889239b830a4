"""The page of the Lamplugh case on band columns: members with initial noise, variants and finer cells.

results.txt next to the case contains the text of the page.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from reproduction.lamplugh import figure_deposit
from reproduction.member_figures import members_over_time
from reproduction.members import (
    NOISE,
    Observed,
    member_rows,
    members_table,
    middle_member,
    numbers,
    observed,
    variant_rows,
    variants_table,
    verdict,
)
from reproduction.numerics import (
    cell_rows,
    cells_table,
    numerics_rows,
    numerics_table,
)
from reproduction.sentences import filled
from reproduction.study import ROOT, Job, Place, Study, StudyError
from reproduction.tables import rewrapped, with_marks
from thawslide.figures.band import band
from thawslide.figures.force_record import caption, force_record
from thawslide.figures.snapshots import velocity
from thawslide.figures.style import without_title
from thawslide.run_folder import Run

CASE = ROOT / "cases" / "lamplugh-columns"
BASE = Job("case", "the case")
COMMON = ("time.output_interval=10",)  # except for the case, whose snapshots the figure of speed shows
QUICK = ("grid.cell=20.0", "time.step=0.02", "time.end=1.0")


def members_of(place: Place) -> list[Job]:
    """Return the members; three of them with --quick."""
    return member_rows()[: 3 if place.is_quick else None]


def variants_of(place: Place) -> list[Job]:
    """Return the variants of the finished case; two of them with --quick."""
    folder = place.runs / BASE.key
    if not (folder / "case.toml").is_file():
        raise StudyError(observed(folder).failure)
    return variant_rows(Run(folder).case)[: 2 if place.is_quick else None]


def with_common(place: Place, jobs: list[Job]) -> list[Job]:
    """Return jobs with the settings of all runs."""
    quick = QUICK if place.is_quick else ()
    return [
        replace(job, sets=(*(() if job.key == BASE.key else COMMON), *quick, *job.sets), cost=cost_of(job))
        for job in jobs
    ]


def cost_of(job: Job) -> float:
    """Return the relative run time, by the cell."""
    cells = [float(each.partition("=")[2]) for each in job.sets if each.startswith("grid.cell=")]
    return (10.0 / cells[0]) ** 3 if cells else 1.0


def first_jobs(place: Place) -> list[Job]:
    """Return the case, its members and the runs of numerical parameters.

    With --quick all runs have coarse cells: the table of cells would be empty.
    """
    cells = [] if place.is_quick else cell_rows()
    return with_common(place, [BASE, *members_of(place), *numerics_rows(), *cells])


def variant_jobs(place: Place) -> list[Job]:
    """Return the variants, whose labels compare their values with those of the case."""
    return with_common(place, variants_of(place))


def draw(members: list[Observed], folders: list[Path], place: Place) -> tuple[dict[str, float], str]:
    """Plot the figures; return the numbers of the member nearest to the medians, and the caption of its force."""
    figures = place.page("cases/lamplugh-columns/figures/members.png").parent
    started = [place for place, each in enumerate(members) if not each.failure and each.start == each.start]
    if not started:
        return {"middle_seed": float("nan")}, "No member reached 8 m/s."
    runs = [Run(folders[place]) for place in started]
    members_over_time(runs).savefig(figures / "members.png", dpi=150)
    middle = middle_member(members)
    run = Run(folders[middle])
    without_title(band(run)).savefig(figures / "band.png", dpi=150)
    without_title(force_record(run)).savefig(figures / "force_record.png", dpi=150)
    figure_deposit({"lamplugh": run}).savefig(figures / "deposit.png", dpi=150)
    return {"middle_seed": float(middle + 1)}, caption(run)


def programs(folders: list[Path]) -> str:
    """Return version and commit of the programs of the runs, without repetition."""
    facts = [Run(folder).facts for folder in folders if (folder / "run.json").is_file()]
    made = dict.fromkeys(f"version {each.get('version')}, commit {each.get('commit')}" for each in facts)
    return " and of ".join(made)


def write(place: Place) -> None:
    """Write the page and its figures from existing runs."""
    rows, variants, cells = members_of(place), variants_of(place), cell_rows()
    members = [observed(place.runs / row.key) for row in rows]
    without_title(velocity(Run(place.runs / BASE.key))).savefig(
        place.page("cases/lamplugh-columns/figures/velocity.png"), dpi=150
    )
    numerics = numerics_rows()
    found = {row.key: observed(place.runs / row.key) for row in (BASE, *variants, *numerics, *cells)}
    middle, of_force = draw(members, [place.runs / row.key for row in rows], place)
    words = numbers(members, found) | middle | {"members": float(len(rows)), "noise": NOISE}
    parts = {
        "members": members_table(members),
        "verdict": verdict(members),
        "force": of_force,
        "variants": variants_table([BASE, *variants], found),
        "cells": cells_table(found),
        "numerics": numerics_table(numerics, found[BASE.key], found),
        "program": programs([place.runs / row.key for row in (BASE, *rows, *variants)]),
    }
    text = with_marks(filled((CASE / "results.txt").read_text(encoding="utf-8"), words), parts)
    place.page("cases/lamplugh-columns/results.md").write_text(rewrapped(text), encoding="utf-8")


STUDY = Study(
    "columns",
    ("cases/lamplugh-columns/results.md",),
    60.0,
    write,
    (first_jobs, variant_jobs),
    cases=CASE,
    tolerates_failures=True,
)
