"""Runs of the same slide on cells of several sizes: travel distance, reach angle, and their order of convergence."""

import math
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from grounds import ALR, PLANE, Variant, write_ground
from jobs import Job, processor_time
from thawslide.maps import read_map
from thawslide.run_folder import Run

HERE = Path(__file__).resolve().parent
PLANE_CELLS = (40.0, 20.0, 10.0, 5.0, 10.0 / 3.0)  # m
PLANE_THICKNESS = 40.0  # m, of the release, along the normal
ALR_CELLS = (10.0, 6.6, 5.0, 3.3)  # m
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
STEP_PER_CELL = 0.0045  # s/m: three quarters of the limit of the elastic wave


@dataclass(frozen=True)
class Found:
    """The numbers of a run that should not depend on its cell."""

    cell: float  # [m]
    travel: float  # along the path, from the rear of the release to the front with 99.5 % of the mass behind it [m]
    reach_angle: float  # [degrees]
    centre: float  # horizontal, of the centre of mass, straight [m]
    speed: float  # maximum mean speed [m/s]
    end_speed: float  # mean speed at the end [m/s]
    simulated: float  # [s]
    left: float  # fraction of the mass that left the DEM
    particles: int
    processor: float  # [s]


@dataclass(frozen=True)
class Deposit:
    """The numbers of a deposit, from maps."""

    cell: float  # [m]
    covered: float  # area at the end [m2]
    affected: float  # area that was covered at any time [m2]
    thickness: float  # maximum on the map [m]
    width: float  # standard deviation of the mass across the slope [m]
    dilation: float  # relative increase of the volume
    map_cell: float  # [m]


def alr_domain(cell: float) -> tuple[str, str]:
    """Return the changes of the domain of AlR to a whole number of cells: inside the DEM, and high enough."""
    counts = [math.floor(ALR_SIZE[axis] / cell + 1e-9) for axis in (0, 1)] + [math.ceil(ALR_SIZE[2] / cell - 1e-9)]
    high = [low + count * cell for low, count in zip(ALR_LOW, counts, strict=True)]
    return f"grid.min={list(ALR_LOW)}", f"grid.max={[round(value, 6) for value in high]}"


def cells_of(cell: float) -> tuple[str, str]:
    """Return the changes of the cell and the step."""
    return f"grid.cell={cell:.12g}", f"time.step={STEP_PER_CELL * cell:g}"


def plane_job(cell: float, runs: Path, extra: tuple[str, ...] = ()) -> Job:
    """Return a run on the plane."""
    return Job(runs / "plane" / "refined-plane.toml", (*cells_of(cell), *extra), runs / f"plane-{cell:g}")


def alr_job(cell: float, runs: Path, variant: Variant = FILTERED, extra: tuple[str, ...] = ()) -> Job:
    """Return a run of AlR; by default with the default filter of the DEM."""
    changes = (*cells_of(cell), *alr_domain(cell), *variant.changes, *extra)
    return Job(runs / "alr" / "alr.toml", changes, runs / f"{variant.name}-{cell:g}")


def jobs(runs: Path, extra: tuple[str, ...] = ()) -> list[Job]:
    """Return all runs, short ones first."""
    result = [plane_job(cell, runs, extra) for cell in PLANE_CELLS]
    *coarse, finest = ALR_CELLS
    result += [alr_job(cell, runs, variant, extra) for variant in (FILTERED, WIDE, ROUGH) for cell in coarse]
    result += [alr_job(STUDIED, runs, variant, extra) for variant in CAUSES if variant is not WIDE]
    return [*result, *(alr_job(finest, runs, variant, extra) for variant in (FILTERED, WIDE))]


def write_inputs(runs: Path, alr: Path | None) -> None:
    """Write DEMs, releases and case files of the two terrains."""
    for ground, names in ((PLANE, ("refined-plane.toml",)), (ALR, ("alr.toml",))):
        folder = runs / ground.name
        if not (folder / "dem.tif").exists():
            write_ground(ground, folder, alr)
        for name in ("common.toml", *names):
            shutil.copy(HERE / name, folder / name)


def read_found(job: Job) -> Found:
    """Read the numbers of a run."""
    run = Run(job.output)
    first, last = (run.snapshot(place, fields=["mass"]) for place in (0, -1))
    centres = [np.average(each.points[:, :2], axis=0, weights=each["mass"]) for each in (first, last)]
    history = run.history
    return Found(
        cell=float(run.section("grid")["cell"]),
        travel=float(run.facts["travel_distance_m"]),
        reach_angle=float(run.facts["reach_angle_degrees"]),
        centre=float(np.hypot(*(centres[1] - centres[0]))),
        speed=float(history["mean_velocity_m_s"].max()),
        end_speed=float(history["mean_velocity_m_s"][-1]),
        simulated=run.last_time,
        left=float(history["left_mass_kg"][-1] / history["mass_kg"][0]),
        particles=int(run.facts["particles"]),
        processor=processor_time(job.log.with_suffix(".json")),
    )


def read_deposit(job: Job) -> Deposit:
    """Read the deposit of a run on the plane, which falls along x, from its maps."""
    run = Run(job.output)
    thickness = read_map(job.output / "maps" / "final_thickness.tif")
    last = run.snapshot(-1, fields=["mass"])
    y, mass = last.points[:, 1], last["mass"]
    return Deposit(
        cell=float(run.section("grid")["cell"]),
        covered=float(run.facts["covered_area_m2"]),
        affected=float(run.facts["affected_area_m2"]),
        thickness=float(np.nanmax(thickness.values)),
        width=math.sqrt(np.average((y - np.average(y, weights=mass)) ** 2, weights=mass)),
        dilation=float(run.facts["dilation_fraction"]),
        map_cell=float(thickness.grid.cell_x),
    )


def order(coarse: float, middle: float, fine: float, ratio: float = 2.0) -> float:
    """Return the observed order of convergence of a value on three grids; nan if it does not converge monotonically."""
    first, second = middle - coarse, fine - middle
    return math.log(first / second) / math.log(ratio) if first * second > 0.0 else math.nan


def limit(middle: float, fine: float, order: float, ratio: float = 2.0) -> float:
    """Return the Richardson extrapolation to cells of size zero."""
    return fine + (fine - middle) / (ratio**order - 1.0)


def spread(values: list[float]) -> float:
    """Return the range of values over their mean."""
    return (max(values) - min(values)) / (sum(values) / len(values))
