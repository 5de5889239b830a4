"""Runs of the two laboratory experiments, and their measured quantities."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from reproduction.study import ROOT, Job, Place
from thawslide.arrays import Numbers
from thawslide.run_folder import Run
from thawslide.snapshot import Snapshot

CASES = Path(__file__).resolve().parent / "cases"
MEASURED = ROOT / "tests" / "cpp" / "verification" / "bar_collapse"

BAR_CELLS = (20.0, 10.0, 5.0, 2.5)  # mm
BAR_STUDIED = 5.0  # mm: cell of the runs that change one parameter
BAR_FRICTION = "material.bars.friction_angle=21.1"  # degrees: asin(tan(19.8 degrees))
BAR_HEIGHT = 0.1  # m
BAR_WINDOW = 0.01  # m, over which surface and failure line are averaged along x
MOVED = 0.001  # m: displacement of moved material
TOE_THICKNESS = 0.0015  # m, of the measured surface at its last point

RADIUS = 10.0  # m
AXIS = 0.02  # m: width of a section at the axis, which must not be 0
ACROSS = (8, 16, 32, 64)  # cells across the radius
ACROSS_STUDIED = 32
ACROSS_FINEST = 128  # with APIC only, for the text
OTHER_ASPECTS = (0.5, 2.0)  # on cells no finer than those
EDGE = 0.01 * RADIUS  # m: thickness at the edge of the deposit
EDGE_WINDOW = 0.05 * RADIUS  # m
TRANSFERS = ("flip", "apic")
FILTERED = ("mechanics.transfer=fmpm", "mechanics.fmpm_interval=0.1")  # FLIP for columns of sand

# Changes to the run on the studied cell, with APIC, by the label of the table.
BAR_CAUSES: dict[str, tuple[str, ...]] = {
    "FLIP (the default)": ("mechanics.transfer=flip",),
    "FLIP, filtered every 0.02 s (FMPM)": ("mechanics.transfer=fmpm", "mechanics.fmpm_interval=0.02"),
    "friction angle of the floor 19.8 degrees": ("basal.friction_angle=19.8",),
    "friction angle 21.1 degrees: stress ratio tan(19.8 degrees) on slip planes": (BAR_FRICTION,),
    "gaps do not close first": ("material.bars.gaps_close_first=false",),
    "tension cut-off 0": ("material.bars.tension_cutoff=0",),
    "viscosity 0.05 ms": ("material.bars.viscosity_time=5e-5",),
    "3 particles per axis": ("body.bars.particles_per_axis=3",),
    "quadratic shape functions": ("mechanics.shape_function=quadratic",),
    "floor a tenth of a cell above a grid line": ("grid.min=[0.0,-0.0405]", "grid.max=[0.8,0.1995]"),
    "no distance check": ("basal.distance_check=false",),
    "bulk modulus / 4": ("material.bars.youngs_modulus=0.21e6",),
    "bulk modulus x 4": ("material.bars.youngs_modulus=3.36e6", "time.step=0.00005"),
    "half the time step": ("time.step=0.00005",),
    "stress-free start": ("mechanics.initial_stress=none",),
}
COLUMN_CAUSES: dict[str, tuple[str, ...]] = {
    "FLIP (the default)": ("mechanics.transfer=flip",),
    "FLIP, filtered every 0.1 s (FMPM)": ("mechanics.transfer=fmpm", "mechanics.fmpm_interval=0.1"),
    "friction angle of the ground 25 degrees": ("basal.friction_angle=25",),
    "friction angle of the ground 36.9 degrees": ("basal.friction_angle=36.93",),
    "friction angle of the sand 31 degrees": ("material.sand.friction_angle=31",),
    "friction angle of the sand 43 degrees": ("material.sand.friction_angle=43",),
    "dilation angle 5 degrees": ("material.sand.dilation_angle=5",),
    "gaps do not close first": ("material.sand.gaps_close_first=false",),
    "viscosity 0.2 ms": ("material.sand.viscosity_time=0.0002",),
    "3 particles per axis": ("body.column.particles_per_axis=3",),
    "quadratic shape functions": ("mechanics.shape_function=quadratic",),
    "ground a tenth of a cell above a grid line": ("grid.min=[0.0,-2.53125]", "grid.max=[50.0,39.96875]"),
    "no distance check": ("basal.distance_check=false",),
    "stiffness x 4": ("material.sand.youngs_modulus=4e7", "time.step=0.000875"),
    "half the time step": ("time.step=0.000875",),
}


def bar_name(cell: float, transfer: str) -> str:
    """Return the name of a run of bars."""
    return f"bars-{transfer}-{cell:g}"


def bars(name: str, cell: float, changes: tuple[str, ...]) -> Job:
    """Return a run of bars on cells of some millimetres."""
    sets = (f"grid.cell={cell * 1e-3:g}", f"time.step={cell * 2e-5:g}", *changes)
    return Job(name, "", _last_of_each(sets), str(CASES / "bars.toml"), cost=50.0 * cell**-3)


def column_name(shape: str, aspect: float, across: int, transfer: str) -> str:
    """Return the name of a run of sand; shape: "cylinder" or "plane"."""
    return f"{shape}-{aspect:g}-{transfer}-{across}"


def column(name: str, shape: str, aspect: float, across: int, changes: tuple[str, ...]) -> Job:
    """Return a run of sand with some cells across the radius or the width."""
    cell = RADIUS / across
    sets = [
        f"grid.cell={cell:g}",
        f"time.step={0.0056 * cell:g}",
        f"time.end={5.0 * max(aspect, 0.64) ** 0.5:g}",
        f"body.column.max=[{RADIUS},{RADIUS * aspect}]",
    ]
    if shape == "cylinder":
        sets.append(f"case.width={{ x = [0.0, 50.0], value = [{AXIS}, {50.0 + AXIS}] }}")
    return Job(name, "", _last_of_each((*sets, *changes)), str(CASES / "sand-column.toml"), cost=1e-4 * across**3)


def _last_of_each(sets: tuple[str, ...]) -> tuple[str, ...]:
    """Return changes in which no key occurs twice."""
    return tuple({change.split("=")[0]: change for change in sets}.values())


def jobs(place: Place) -> list[Job]:
    """Return all runs."""
    apic = "mechanics.transfer=apic"
    found = [
        bars(bar_name(cell, transfer), cell, (f"mechanics.transfer={transfer}",))
        for cell in BAR_CELLS
        for transfer in TRANSFERS
    ]
    found.append(bars("bars-21-2.5", BAR_CELLS[-1], (apic, BAR_FRICTION)))
    for number, changes in enumerate(BAR_CAUSES.values()):
        found.append(bars(f"bars-cause-{number}", BAR_STUDIED, (apic, *changes)))
    for number, changes in enumerate(COLUMN_CAUSES.values()):
        found.append(column(f"cylinder-cause-{number}", "cylinder", 1.0, ACROSS_STUDIED, (apic, *changes)))
    kinds = [("cylinder", 1.0), ("plane", 1.0), *(("cylinder", aspect) for aspect in OTHER_ASPECTS)]
    columns: list[tuple[str, float, int, str, tuple[str, ...]]] = [
        (shape, aspect, across, transfer, (f"mechanics.transfer={transfer}",))
        for across in ACROSS
        for shape, aspect in kinds
        for transfer in TRANSFERS
        if aspect not in OTHER_ASPECTS or across <= ACROSS_STUDIED
    ]
    columns += [("cylinder", 1.0, across, "fmpm", FILTERED) for across in ACROSS]
    columns.append(("cylinder", 1.0, ACROSS_FINEST, "apic", (apic,)))
    for shape, aspect, across, transfer, changes in columns:
        found.append(column(column_name(shape, aspect, across, transfer), shape, aspect, across, changes))
    return [_short(job) for job in found] if place.is_quick else found


def _short(job: Job) -> Job:
    """Return a run on the coarsest cells with a few steps, to test the study."""
    is_bars = job.key.startswith("bars")
    cell, step = (f"{0.02:g}", 4e-4) if is_bars else (f"{RADIUS / ACROSS[0]:g}", 0.007)
    grid = tuple(each for each in job.sets if not each.startswith(("grid.min", "grid.max")))
    return replace(
        job, sets=_last_of_each((*grid, f"grid.cell={cell}", f"time.step={step}", f"time.end={20 * step:g}"))
    )


def read_points(file: Path) -> tuple[Numbers, Numbers]:
    """Return x and height [m] of a measured line."""
    x, height = np.loadtxt(file, delimiter=",", comments="#", skiprows=4).T
    return x, height


def thickness(x: Numbers, share: Numbers, at: Numbers, window: float, size: float) -> Numbers:
    """Return volume per width of windows around positions: particles are `size` wide, the wall is at x = 0."""
    start, end = (np.maximum(at - 0.5 * window, 0.0)[:, None], (at + 0.5 * window)[:, None])
    within = np.minimum(x + 0.5 * size, end) - np.maximum(x - 0.5 * size, start)
    return np.asarray((np.clip(within, 0.0, None) / size * share).sum(axis=1) / (end - start)[:, 0])


@dataclass(frozen=True)
class Bars:
    """The bars after their collapse at the measured positions; lengths in m."""

    cell: float
    surface: Numbers  # at the measured positions
    profile: tuple[Numbers, Numbers]
    failure: Numbers  # at the measured positions
    failure_profile: tuple[Numbers, Numbers]
    toe: float
    dilation: float

    @property
    def surface_error(self) -> Numbers:
        """Computed minus measured surface [mm]."""
        return np.asarray(1e3 * (self.surface - read_points(MEASURED / "surface.csv")[1]))

    @property
    def failure_error(self) -> Numbers:
        """Computed minus measured failure line [mm]."""
        return np.asarray(1e3 * (self.failure - read_points(MEASURED / "failure.csv")[1]))

    def slope(self) -> float:
        """Inclination of the failure line [degrees]."""
        return inclination(read_points(MEASURED / "failure.csv")[0], self.failure)


def inclination(x: Numbers, height: Numbers) -> float:
    """Return the inclination [degrees] of the least-squares line."""
    return float(np.degrees(np.arctan(-np.polyfit(x, height, 1)[0])))


def failure_line(start: Numbers, moved: Numbers, at: Numbers, threshold: float, spacing: float) -> Numbers:
    """Return the height [m] at positions above which rows of particles have moved by more than a threshold [m]."""
    heights = []
    for place in at:
        here = np.abs(start[:, 0] - place) <= 0.5 * BAR_WINDOW
        _, rows = np.unique(np.floor(start[here, 1] / spacing), return_inverse=True)
        mean = np.bincount(rows, weights=moved[here]) / np.bincount(rows)
        height = np.concatenate(([0.0], (np.arange(len(mean)) + 0.5) * spacing))
        displacement = np.concatenate(([0.0], mean))
        above = np.flatnonzero(displacement > threshold)
        if not above.size:
            heights.append(BAR_HEIGHT)
            continue
        k = above[0]
        fraction = (threshold - displacement[k - 1]) / (displacement[k] - displacement[k - 1])
        heights.append(height[k - 1] + fraction * (height[k] - height[k - 1]))
    return np.array(heights)


def read_bars(folder: Path, cell: float, particles: int = 2) -> Bars:
    """Read the result of a run of bars; cell in mm, particles per axis."""
    shot = Snapshot(Run(folder).snapshot_files[-1])
    size = cell * 1e-3 / particles
    volume = shot["mass"] / 2650.0
    x = shot.points[:, 0]
    displacement = shot["displacement"]
    start = (shot.points - displacement)[:, :2]
    moved = np.asarray(np.linalg.norm(displacement, axis=1))
    places, _ = read_points(MEASURED / "surface.csv")
    fine = np.arange(0.0, 0.7, 0.001)
    depth = thickness(x, volume, fine, BAR_WINDOW, size)
    failed, _ = read_points(MEASURED / "failure.csv")
    line = np.arange(0.0, 0.2, 0.005)
    return Bars(
        cell,
        thickness(x, volume, places, BAR_WINDOW, size),
        (fine, depth),
        failure_line(start, moved, failed, MOVED, size),
        (line, failure_line(start, moved, line, MOVED, size)),
        float(fine[depth >= TOE_THICKNESS].max()),
        float(shot["volume"].sum() / volume.sum() - 1.0),
    )


@dataclass(frozen=True)
class Column:
    """A column of sand after its collapse: runouts over the radius, and the thickness [m] over x [m]."""

    bulk: float  # of 95 % of the mass
    runout: float  # of 99.5 %
    edge: float  # up to a thickness of EDGE
    profile: tuple[Numbers, Numbers]
    gained: float  # energy added by transfers and steps, over the potential energy released


def read_column(folder: Path, shape: str, aspect: float, across: int) -> Column:
    """Read the result of a run of sand."""
    run = Run(folder)
    made, released = (
        run.series["numerical_J"] + run.series["mechanical_residual_J"],
        run.series["potential_J"][0] - run.series["potential_J"][-1],
    )
    shot = Snapshot(run.snapshot_files[-1])
    x, mass = shot.points[:, 0], shot["mass"]
    order = np.argsort(x)
    share = np.cumsum(mass[order]) / mass.sum()
    bulk, front = (float(x[order][np.searchsorted(share, part)]) for part in (0.95, 0.995))
    volume = mass / mass.sum() * RADIUS * RADIUS * aspect * (0.5 * RADIUS + AXIS if shape == "cylinder" else 1.0)
    at = np.arange(0.05, 45.0, 0.1)
    depth = thickness(x, volume, at, EDGE_WINDOW, 0.5 * RADIUS / across)
    if shape == "cylinder":
        depth = depth / (0.5 * (np.maximum(at - 0.5 * EDGE_WINDOW, 0.0) + at + 0.5 * EDGE_WINDOW) + AXIS)
    return Column(
        bulk / RADIUS - 1.0,
        front / RADIUS - 1.0,
        float(at[depth >= EDGE].max()) / RADIUS - 1.0,
        (at, depth),
        float(made[-1] / released),
    )


def lube_cylinder(aspect: float) -> float:
    """Return the runout over the radius of cylinders: Lube et al. (2004)."""
    return 1.24 * aspect if aspect < 1.7 else 1.6 * float(np.sqrt(aspect))


def lube_plane(aspect: float) -> float:
    """Return the runout over the width of columns in channels: Lube et al. (2005)."""
    return 1.2 * aspect if aspect < 1.8 else 1.9 * aspect ** (2.0 / 3.0)
