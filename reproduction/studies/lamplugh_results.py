"""The page cases/lamplugh/results.md: the Lamplugh case and its variants, with the figures of the case."""

from __future__ import annotations

import shutil
from dataclasses import replace

from reproduction.one_at_a_time import HEADER, outcome, table_row
from reproduction.study import ROOT, Job, Place, Study, StudyError
from thawslide import command_line

CASE = ROOT / "cases" / "lamplugh"
QUICK = ("grid.cell=20.0", "time.end=1.0")
JOBS = (
    Job("case", "the case"),
    Job("no-pressurization", "thermal pressurization off, ice pressure kept", (), "no-pressurization.toml"),
    Job("no-pore-pressure", "all pore pressure off", (), "no-pore-pressure.toml"),
    Job("no-viscosity", "no viscosity", ("material.rock_ice.viscosity_time=0.0",)),
    Job("slope-shear", "initial stress with slope shear", ("mechanics.slope_shear=true",)),
    Job("cohesion-kept", "cohesion kept (0.6 MPa)", ("basal.cohesion_law=constant",)),
    Job("clamp-joint", "excess pressure cancels cohesion", ("basal.clamp=joint",)),
    Job("e-0.35", "band 0.35 m thick from the start", ("band.thickness=0.35",)),
)
FIGURES = ("motion", "velocity", "temperature", "band", "force", "force_record", "energy")

OPENING = """# Lamplugh and its variants

This page compares the case with its variants. `scripts/pages --only lamplugh` generates it, and `./test --full` runs
that command. Runout is the front minus the initial rear. A slide that never starts therefore has a runout of 1,023 m,
its own length. Front travel is the last position of the front minus its first. [Assumptions](assumptions.md) compares
more variants.

"""
REPORTED = (
    "| other models; the runout is observed | 80 | 75 | 40 | before 200 | 5,612 to 5,929 | 10,500 "
    "| 10,500, if the report means this distance | | | |"
)


def jobs(place: Place) -> list[Job]:
    """Return all runs."""
    return [replace(job, sets=(*job.sets, *QUICK)) for job in JOBS] if place.is_quick else list(JOBS)


def command(job: Job) -> str:
    """Return the command of a variant."""
    case = "cases/lamplugh" if job.case == "case.toml" else f"cases/lamplugh/{job.case}"
    return " ".join(["./run", case, *(f"--set {key}" for key in job.sets)])


def write(place: Place) -> None:
    """Write the page and the figures of the case from existing runs."""
    case = place.runs / "case"
    if command_line.main([str(case)]) != 0:
        raise StudyError(f"the figures of {case} were not plotted")
    for name in FIGURES:
        if (figure := case / "figures" / f"{name}.png").is_file():
            shutil.copy(figure, place.page(f"cases/lamplugh/figures/{name}.png"))
    rows = "\n".join([*(table_row(job, outcome(place.runs / job.key)) for job in JOBS), REPORTED])
    commands = "".join(f"- {job.words}: `{command(job)}`\n" for job in JOBS)
    place.page("cases/lamplugh/results.md").write_text(f"{OPENING}{HEADER}{rows}\n\n{commands}", encoding="utf-8")


STUDY = Study("lamplugh", ("cases/lamplugh/results.md",), 8.0, write, (jobs,), cases=CASE, tolerates_failures=True)
