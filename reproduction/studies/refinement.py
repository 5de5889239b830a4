"""Runs of the same slide on cells of several sizes: travel distance, reach angle, and their order of convergence."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from reproduction.studies.grounds import ALR, PLANE, Variant, write_case
from reproduction.study import Job, Place
from thawslide.maps import read_map
from thawslide.run_folder import Run

PLANE_CELLS = (40.0, 20.0, 10.0, 5.0)  # m
PLANE_THICKNESS = 40.0  # m, of the release, along the normal
ALR_CELLS = (20.0, 10.0, 6.6, 5.0)  # m
STUDIED = 6.6  # m: the cell of the runs that isolate causes
FILTERED = Variant("alr", "default filter")
ROUGH = Variant("alr-rough", "unfiltered DEM", ("terrain.smooth=0",))
WIDE = Variant("alr-width10", "filter of 10 m", ("terrain.smooth=10",))
CAUSES = (
    WIDE,
    Variant("alr-width13", "filter of 13 m", ("terrain.smooth=13",)),
    Variant("alr-weak", "default filter, internal friction 25 degrees", ("material.grains.friction_angle=25",)),
)
ALR_LOW, ALR_SIZE = (255215.0, 377350.0, 540.0), (2046.0, 4521.0, 2059.2)  # m, of the domain
QUICK = ("time.end=4", "time.output_interval=2", "time.history_interval=0.5")


@dataclass(frozen=True)
class Found:
    """The numbers of a run that should not depend on its cell."""

    cell: float  # [m]
    travel: float  # along the path, from the rear of the release to the front with 99.5 % of the mass behind it [m]
    reach_angle: float  # [degrees]
    centre: float  # horizontal, of the centre of mass, straight [m]
    speed: float  # maximum mean speed [m/s]
    left: float  # fraction of the mass that left the DEM
    deposit: float  # area thicker than maps.area_thickness at the end [m2], on the map cell of the case
    inundated: float  # area ever thicker [m2]


@dataclass(frozen=True)
class Deposit:
    """The numbers of a deposit, from maps."""

    cell: float  # [m]
    covered: float  # area thicker than maps.area_thickness at the end [m2]
    inundated: float  # area ever thicker [m2]
    affected: float  # area ever thicker than maps.arrival_thickness [m2]
    thickness: float  # maximum on the map [m]
    width: float  # standard deviation of the mass across the slope [m]


def alr_domain(cell: float) -> tuple[str, str]:
    """Return the changes of the domain of AlR to a whole number of cells: inside the DEM, and high enough."""
    counts = [math.floor(ALR_SIZE[axis] / cell + 1e-9) for axis in (0, 1)] + [math.ceil(ALR_SIZE[2] / cell - 1e-9)]
    high = [low + count * cell for low, count in zip(ALR_LOW, counts, strict=True)]
    return f"grid.min={list(ALR_LOW)}", f"grid.max={[round(value, 6) for value in high]}"


def plane_job(cell: float, runs: Path) -> Job:
    """Return a run on the plane."""
    case = str(runs / "plane" / "refined-plane.toml")
    return Job(f"plane-{cell:g}", "", (f"grid.cell={cell:g}",), case, cost=cell**-4)


def alr_job(cell: float, runs: Path, variant: Variant = FILTERED) -> Job:
    """Return a run of AlR; by default with the default filter of the DEM."""
    changes = (f"grid.cell={cell:g}", *alr_domain(cell), *variant.changes)
    return Job(f"{variant.name}-{cell:g}", "", changes, str(runs / "alr" / "alr.toml"), cost=cell**-4)


def jobs(place: Place) -> list[Job]:
    """Write the inputs; return all runs."""
    write_inputs(place.runs, place.data / "alr")
    if place.is_quick:
        coarse = [plane_job(cell, place.runs) for cell in (20.0, 10.0)]
        coarse += [alr_job(10.0, place.runs, variant) for variant in (FILTERED, WIDE, ROUGH)]
        return [replace(job, sets=(*job.sets, *QUICK)) for job in coarse]
    found = [plane_job(cell, place.runs) for cell in PLANE_CELLS]
    found += [alr_job(cell, place.runs, variant) for variant in (FILTERED, WIDE) for cell in ALR_CELLS]
    found += [alr_job(cell, place.runs, ROUGH) for cell in ALR_CELLS[:-1]]
    return [*found, *(alr_job(STUDIED, place.runs, variant) for variant in CAUSES if variant is not WIDE)]


def write_inputs(runs: Path, alr: Path) -> None:
    """Write DEMs, releases and case files of the two terrains."""
    write_case(PLANE, "refined-plane", runs, alr)
    write_case(ALR, "alr", runs, alr)


def read_found(folder: Path) -> Found:
    """Read the numbers of a run."""
    run = Run(folder)
    first, last = (run.snapshot(place, fields=["mass"]) for place in (0, -1))
    centres = [np.average(each.points[:, :2], axis=0, weights=each["mass"]) for each in (first, last)]
    history = run.series
    return Found(
        cell=float(run.section("grid")["cell"]),
        travel=float(run.facts["travel_distance_m"]),
        reach_angle=float(run.facts["reach_angle_degrees"]),
        centre=float(np.hypot(*(centres[1] - centres[0]))),
        speed=float(history["mean_velocity_m_s"].max()),
        left=float(history["left_mass_kg"][-1] / history["mass_kg"][0]),
        deposit=float(run.facts["deposit_area_m2"]),
        inundated=float(run.facts["inundated_area_m2"]),
    )


def read_deposit(folder: Path) -> Deposit:
    """Read the deposit of a run on the plane, which falls along x, from its maps."""
    run = Run(folder)
    thickness = read_map(folder / "maps" / "final_thickness.tif")
    last = run.snapshot(-1, fields=["mass"])
    y, mass = last.points[:, 1], last["mass"]
    return Deposit(
        cell=float(run.section("grid")["cell"]),
        covered=float(run.facts["deposit_area_m2"]),
        inundated=float(run.facts["inundated_area_m2"]),
        affected=float(run.facts["affected_area_m2"]),
        thickness=float(np.nanmax(thickness.values)),
        width=math.sqrt(np.average((y - np.average(y, weights=mass)) ** 2, weights=mass)),
    )


def order(coarse: float, middle: float, fine: float, ratio: float = 2.0) -> float:
    """Return the observed order of convergence of a value on three grids; nan if it does not converge monotonically."""
    first, second = middle - coarse, fine - middle
    return math.log(first / second) / math.log(ratio) if first * second > 0.0 else math.nan


def limit(middle: float, fine: float, order: float, ratio: float = 2.0) -> float:
    """Return the Richardson extrapolation to cells of size zero."""
    return fine + (fine - middle) / (math.pow(ratio, order) - 1.0)


def spread(values: list[float]) -> float:
    """Return the range of values over their mean."""
    return (max(values) - min(values)) / (sum(values) / len(values))
