"""The page cases/lamplugh-columns/force.md: a release in two parts, fitted to the force record, beside null models."""

from __future__ import annotations

import sys
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from scipy.stats import qmc

from reproduction.engine import Task
from reproduction.point_masses import Friction, Motion, move, smooth_profile
from reproduction.study import ROOT, Job, Place, Study
from reproduction.tables import markdown, rewrapped, text_of
from thawslide.arrays import Numbers
from thawslide.figures.force_record import Comparison, Curves, compared, filtered, force_record, record_curves
from thawslide.figures.style import without_title
from thawslide.force_record import ForceRecord, extreme_times, read_force_record
from thawslide.run_folder import Run
from thawslide.scores.force import best_alignment, times_in_record
from thawslide.scores.forecast import read_forecast
from thawslide.targets import Band
from thawslide.text_files import MEGABYTE, finite_number, read_table

CASE = ROOT / "cases" / "lamplugh-columns"
BAND = Band(10.0, 200.0)  # s: periods of the record
SWEEP = "force-sweep"
FIT = "two-parts.toml"
PAGE = "cases/lamplugh-columns/force.md"
WEAK_BODY = ("material.rock_ice.friction_angle=30", "material.rock_ice.residual_friction_angle=30")
JOBS = (
    Job("case", "one part, the case: base of 30 degrees, cells of 10 m"),
    Job("fit", "two parts, fitted, cells of 20 m", (), FIT),
    Job("fit-14", "cells of 14 m", ("grid.cell=14", "time.step=0.014"), FIT),
    Job("fit-10", "cells of 10 m", ("grid.cell=10", "time.step=0.01"), FIT),
    Job("at-once", "both parts at once", ("body.upper.release_time=0",), FIT),
    Job("later", "the upper part 3 s later", ("body.upper.release_time=LATER",), FIT),
    Job("weak-base", "base and body of 30 degrees", ("basal.friction_angle=30", *WEAK_BODY), FIT),
    Job("glacier", "glacier as in the case, 0.105", ("substrate.glacier.friction_coefficient=0.105",), FIT),
)  # fmt: skip
POINTS, SAMPLES, STEP, END = 24, 256, 0.05, 160.0  # of the null models; s
ONSET, NEAR = -1.0, 10.0  # s: start of the record's force; time before it that is near
GLACIER_X = 2190.0  # m: start of the glacier


@dataclass(frozen=True)
class Null:
    """A null model: words, kept lower fraction of the release, fraction that leaves first, whether it is a chain."""

    words: str
    kept: float = 1.0
    first: float = 1.0
    chained: bool = False


NULLS = (
    Null("points, whole release"),
    Null("chain, whole release", chained=True),
    Null("points, lower half of the release", kept=0.5),
    Null("chain, lower half of the release", kept=0.5, chained=True),
    Null("points, lower 0.3 first", first=0.3),
    Null("chain, lower 0.3 first", first=0.3, chained=True),
)


@dataclass(frozen=True)
class Fit:
    """Agreement with the record: correlation, shift [s], times of extremes [s] and largest vertical force [N]."""

    correlation: float
    shift: float
    times: dict[str, float]
    force: float


@cache
def record() -> ForceRecord:
    """Return the record of the case."""
    return read_force_record(CASE / "lamplugh_force.csv", BAND, "U.S. Geological Survey, lsforce")


def fit_of(found: Comparison) -> Fit:
    """Return the agreement of a force with the record, at the shift of best correlation."""
    shift, correlation = best_alignment(found)
    force = float(np.max(np.abs(found.run.up)))
    return Fit(correlation, shift, times_in_record(found, shift), force)


def fit_of_motion(motion: Motion, sample: int) -> Fit:
    """Return the agreement of one sample of a null model, whose mass is not known."""
    at = np.arange(-60.0, END, BAND.shortest / 40.0)
    up, along = (filtered(motion.time, part[sample], at, BAND) for part in (motion.up, motion.along))
    return fit_of(Comparison(Curves(at, up, along, None), record_curves(record()), {}, 0.0, 0.0, True))


def columns_of(file: Path, names: tuple[str, ...]) -> list[Numbers]:
    """Return columns of a profile."""
    table = read_table(file, names, (), MEGABYTE)
    return [np.array([finite_number(row[name], f"{file}:{line}") for line, row in table.rows]) for name in names]


@cache
def null_fit(null: Null, samples: int = SAMPLES) -> tuple[Fit, str]:
    """Return the best of a Latin hypercube of samples, and its parameters in words.

    Friction falls from 0.05 to 1.2 to 0.05 to 0.5 over 10 to 316 m of slip, and is 0 to 0.15 on the glacier. The other
    part leaves after 4 to 20 s.
    """
    x, terrain, surface = columns_of(
        CASE / "lamplugh_profile.csv", ("distance_m", "terrain_elevation_m", "surface_elevation_m")
    )
    slope = (terrain[-1] - terrain[-2]) / (x[-1] - x[-2])
    beyond = x[-1] + np.arange(1, 400) * (x[-1] - x[-2]) * 10.0  # points do not reach the end of the profile
    surface = np.concatenate((surface, terrain[-1] + slope * (beyond - x[-1])))
    terrain = np.concatenate((terrain, terrain[-1] + slope * (beyond - x[-1])))
    x = np.concatenate((x, beyond))
    share = np.cumsum(surface - terrain) / np.sum(surface - terrain)
    order = (np.arange(POINTS) + 0.5) / POINTS
    start_x = np.interp(order, share, x)[order > 1.0 - null.kept]
    is_first = (np.arange(len(start_x)) + 0.5) / len(start_x) > 1.0 - null.first
    part = qmc.LatinHypercube(5, seed=1).random(samples)
    later = 0.05 + 0.45 * part[:, :1]
    length = 10.0 ** (1.0 + 1.5 * part[:, 2:3])
    friction = Friction(later + 0.7 * part[:, 1:2], later, length, 0.15 * part[:, 3:4], GLACIER_X)
    starts = np.where(is_first, 0.0, 4.0 + 16.0 * part[:, 4:5])
    motion = move(smooth_profile(x, terrain), start_x, starts, friction, END, STEP, null.chained)
    fits = [fit_of_motion(motion, sample) for sample in range(samples)]
    best = int(np.nanargmax([fit.correlation for fit in fits]))
    words = (
        f"{friction.first[best, 0]:.2f} to {later[best, 0]:.2f} over {length[best, 0]:.0f} m, glacier "
        f"{friction.glacier[best, 0]:.3f}" + (f", {starts[best].max():.1f} s later" if null.first < 1.0 else "")
    )
    return fits[best], words


def cells_of(words: str, fit: Fit, *more: str) -> list[str]:
    """Return a row of a table."""
    times = [f"{fit.times[name]:.1f}" if np.isfinite(fit.times[name]) else "none" for name in TIMES]
    return [words, f"{fit.correlation:.2f}", f"{-fit.shift:.1f}" if fit.shift else "", *times, *more]


TIMES = ("dip", "upward", "downward", "along")
HEADER = [
    "",
    "correlation",
    "start (s)",
    "dip (s)",
    "last upward (s)",
    "largest downward (s)",
    "largest horizontal (s)",
]


def jobs(place: Place) -> list[Job]:
    """Return all runs."""
    later = f"{release_time() + 3.0:g}"
    found = [
        Job(each.key, each.words, tuple(key.replace("LATER", later) for key in each.sets), each.case) for each in JOBS
    ]
    quick = ("time.end=24", "grid.cell=20", "time.step=0.02") if place.is_quick else ()
    return [Job(each.key, each.words, (*each.sets, "time.output_interval=20", *quick), each.case) for each in found]


def release_time() -> float:
    """Return the time of release of the upper part in the fitted case [s]."""
    text = (CASE / FIT).read_text(encoding="utf-8")
    return float(tomllib.loads(text)["body"]["upper"]["release_time"])


def sweep_task(place: Place) -> list[Task]:
    """Return the sweep from which the fitted case was chosen."""
    if place.is_quick:
        return []
    results, file = place.runs / SWEEP, Path(__file__).parent / "cases" / f"lamplugh-{SWEEP}.toml"
    words = [sys.executable, "-m", "thawslide.sweeps.command", str(file), "--output", str(results), "--workers", "1"]
    names = ("case.toml", "force-lower-0.2.toml", "force-lower-0.3.toml", "lamplugh_profile.csv")
    inputs = (file, *(CASE / name for name in names))
    environment = {"THAWSLIDE_BINARY": str(place.program)}
    return [Task(SWEEP, tuple(words), results, place.version, inputs, 90.0, False, environment)]


def run_rows(place: Place) -> list[list[str]]:
    """Return the table of runs; a runout after which the slide still moves is a lower limit."""
    rows = [[*HEADER, "peak of the mean velocity (m/s)", "runout (km)", "largest vertical force (TN)"]]
    own = extreme_times((curves := record_curves(record())).time, curves.up, curves.along)
    rows.append(cells_of("record", Fit(1.0, -ONSET, own, 0.0), "", "", f"{1e-12 * np.max(np.abs(curves.up)):.2f}"))
    for job in JOBS:
        run = Run(place.runs / job.key)
        fit, speed = fit_of(compared(run, record())), run.series["mean_velocity_m_s"]
        moves = "> " if speed[-1] > 1.0 else ""
        runout = f"{moves}{1e-3 * run.series['runout_m'][-1]:.1f}"
        rows.append(cells_of(job.words, fit, f"{np.max(speed):.0f}", runout, f"{1e-12 * fit.force:.2f}"))
    return rows


def null_rows(samples: int) -> list[list[str]]:
    """Return the table of null models."""
    rows = [[*HEADER, "friction coefficient"]]
    for null in NULLS:
        fit, words = null_fit(null, samples)
        rows.append(cells_of(null.words, fit, words))
    return rows


def sweep_row(place: Place) -> str:
    """Return the correlations of the members of the sweep in words."""
    if place.is_quick:
        return ""
    forecast = read_forecast(place.runs / SWEEP)
    fits = [fit_of(compared(Run(folder, skip_damaged=True), record())) for folder in forecast.run_folders]
    found, start = np.array([(fit.correlation, -fit.shift) for fit in fits if np.isfinite(fit.correlation)]).T
    low, middle, high = np.quantile(found, (0.05, 0.5, 0.95))
    is_near = start > ONSET - NEAR
    return (
        f"Of {len(found)} members that moved, 5 % have a correlation below {low:.2f}, half below {middle:.2f}, and 5 % "
        f"above {high:.2f}. Of the {np.count_nonzero(is_near)} members that start at most {NEAR:g} s before the "
        f"record, the highest is {np.max(found[is_near]):.2f}."
    )


def write(place: Place) -> None:
    """Write the page and its figure from existing runs."""
    figure = place.page("cases/lamplugh-columns/figures/force_two_parts.png")
    without_title(force_record(Run(place.runs / "fit"))).savefig(figure, dpi=150)
    parts = {
        "runs": markdown(run_rows(place)),
        "nulls": markdown(null_rows(8 if place.is_quick else SAMPLES)),
        "sweep": sweep_row(place),
    }
    place.page(PAGE).write_text(rewrapped(text_of("lamplugh-force.md", parts)), encoding="utf-8")


STUDY = Study("lamplugh-force", (PAGE,), 25.0, write, (sweep_task, jobs), cases=CASE, tolerates_failures=True)
