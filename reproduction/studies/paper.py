"""The report of `./run paper`: all cases of the paper, its figures and its statements."""

from __future__ import annotations

from reproduction.page import make_page
from reproduction.runs import LAMPLUGH_BLOCKS, all_runs, read_runs, shortened
from reproduction.study import ROOT, Job, Place, Study


def jobs(place: Place) -> list[Job]:
    """Return all runs."""
    blocks = list(LAMPLUGH_BLOCKS)
    return [shortened(job) for job in (*all_runs(), *blocks)] if place.is_quick else [*all_runs(), *blocks]


def write(place: Place) -> None:
    """Write the report next to the runs."""
    page = make_page(read_runs(all_runs(), place.runs), place.runs, place.is_quick, place.report)
    place.report(f"page: {page}")


STUDY = Study(
    "paper",
    ("runs/paper/report.html",),
    60.0,
    write,
    (jobs,),
    cases=ROOT / "cases",
    folder="paper",
    tolerates_failures=True,
)
