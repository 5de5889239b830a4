"""The Frank slide with SHALTOP and Thawslide: runs, and numbers of their deposits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reproduction.studies.results import without_gaps
from reproduction.study import Job, Place
from thawslide.errors import ReportError
from thawslide.maps import Grid, Map, read_map
from thawslide.relief import slopes
from thawslide.run_folder import Numbers, Run

CASE = Path(__file__).resolve().parent / "cases" / "frank.toml"
QUICK = ("grid.cell=40", "grid.max=[4000,4000,2320]", "time.end=1", "time.output_interval=1")
ANGLES = (10, 15, 20, 25)  # degrees, of SHALTOP's runs
STUDIED = 15  # degrees: the angle of the runs that isolate causes
EDGE = 1.0  # m, vertical: minimum thickness of the deposit and of the area passed


@dataclass(frozen=True)
class Variant:
    """Changes of a run to frank.toml."""

    name: str
    words: str
    changes: tuple[str, ...] = ()


BASE = Variant("base", "internal friction 35 degrees")
FLUID = Variant("fluid", "internal friction 5 degrees", ("material.grains.friction_angle=5",))
FINE = (
    Variant("14", "cells of 14 m", ("grid.cell=14", "grid.max=[4016.0, 4016.0, 2320.0]")),
    Variant("10", "cells of 10 m", ("grid.cell=10",)),
)
# For the studied angle only.
CAUSES = (
    Variant("alike", "internal friction 15 degrees", ("material.grains.friction_angle=15",)),
    Variant("stiff", "Young's modulus 400 MPa", ("material.grains.youngs_modulus=4e8",)),
    *(
        Variant(f"{body.name}-on-{cells.name}", f"{body.words}, {cells.words}", (*body.changes, *cells.changes))
        for body, cells in ((BASE, FINE[0]), (FLUID, FINE[0]), (BASE, FINE[1]))
    ),
)


@dataclass(frozen=True)
class Deposit:
    """A deposit, and peak values; all maps are on SHALTOP's grid."""

    final: Map  # vertical thickness at the end [m]
    highest: Map  # maximum vertical thickness [m]
    speed: Map  # maximum depth-averaged speed [m/s]


@dataclass(frozen=True)
class Figures:
    """The numbers of a deposit."""

    x: float  # of the centroid [m]
    y: float
    area: float  # of the deposit [km2]
    passed: float  # area passed, deposit included [km2]
    farthest: float  # maximum x of the deposit [m]
    travel: float  # horizontal, from the top of the pile to the farthest point of the deposit [m]
    drop: float  # between the two [m]
    speed: float  # maximum over the area with a thickness of EDGE or more [m/s]
    high_speed: float  # 95th percentile over the area passed [m/s]
    usual_speed: float  # median of the same [m/s]
    thickness: float  # maximum of the deposit [m]
    volume: float  # of the deposit and of thinner areas [million m3]

    @property
    def reach_angle(self) -> float:
        """Angle of the line between the top of the pile and the farthest point [degrees]."""
        return math.degrees(math.atan2(self.drop, self.travel))


def jobs(place: Place) -> list[Job]:
    """Return all runs."""
    pairs = [(variant, angle) for variant in (BASE, FLUID) for angle in ANGLES]
    pairs += [(variant, STUDIED) for variant in CAUSES]
    return [job(variant, angle, place.data / "frank", QUICK if place.is_quick else ()) for variant, angle in pairs]


def job(variant: Variant, angle: int, data: Path, extra: tuple[str, ...] = ()) -> Job:
    """Return the run of a variant with an angle of friction along the ground."""
    changes = (
        f"terrain.file={data / 'Frankslide_topography.asc'}",
        f'body.slide.thickness={{ raster = "{data / "Frankslide_pile.asc"}" }}',
        f"basal.friction_angle={angle}",
        *variant.changes,
        *extra,
    )
    return Job(f"{variant.name}-{angle}", variant.words, changes, str(CASE))


def read_grid(path: Path) -> Map:
    """Read an ESRI ASCII grid with square cells and its lower left corner given."""
    lines = path.read_text().splitlines()
    head = {line.split()[0].lower(): float(line.split()[1]) for line in lines[:6]}
    cell = head["cellsize"]
    grid = Grid(
        head["xllcorner"] + 0.5 * cell,
        head["yllcorner"] + 0.5 * cell,
        cell,
        cell,
        int(head["ncols"]),
        int(head["nrows"]),
    )
    return Map(grid, np.loadtxt(lines[6:])[::-1], "m")


def on_grid(field: Map, grid: Grid) -> Map:
    """Return a map on another grid of the same cells, 0 outside the map; the cells must coincide."""
    column, row = (field.grid.x0 - grid.x0) / grid.cell_x, (field.grid.y0 - grid.y0) / grid.cell_y
    if field.grid.cell_x != grid.cell_x or abs(column - round(column)) > 1e-6 or abs(row - round(row)) > 1e-6:
        raise ReportError(f"the cells of a map ({field.grid}) differ from those of SHALTOP ({grid})")
    values = np.zeros((grid.rows, grid.columns))
    rows, columns = (
        round(row) + np.arange(field.grid.rows)[:, None],
        round(column) + np.arange(field.grid.columns)[None, :],
    )
    inside = (rows >= 0) & (rows < grid.rows) & (columns >= 0) & (columns < grid.columns)
    rows, columns = np.broadcast_arrays(rows, columns)
    values[rows[inside], columns[inside]] = without_gaps(field)[inside]
    return Map(grid, values, field.unit)


def read_shaltop(data: Path, angle: int, terrain: Map) -> Deposit:
    """Read SHALTOP's results; its maximum thickness is converted from normal to vertical."""
    folder = data / "shaltop"
    final, highest, speed = (
        read_map(folder / f"delta{angle}_{kind}.tif") for kind in ("hfinal_vertical", "hmax_normal", "umax")
    )
    steepness = np.hypot(*slopes(terrain.values, terrain.grid.cell_x, terrain.grid.cell_y))
    return Deposit(final, Map(highest.grid, highest.values * np.sqrt(1.0 + steepness**2), "m"), speed)


def read_run(folder: Path, grid: Grid) -> Deposit:
    """Read a run of Thawslide."""
    maps = Run(folder).folder / "maps"
    return Deposit(
        *(on_grid(read_map(maps / f"{name}.tif"), grid) for name in ("final_thickness", "max_thickness", "max_speed"))
    )


def figures(deposit: Deposit, terrain: Map, pile: Map) -> Figures:
    """Return the numbers of a deposit on a terrain; `pile` is the thickness released."""
    x, y = np.meshgrid(terrain.grid.x, terrain.grid.y)
    final = deposit.final.values
    lies, was = final > EDGE, deposit.highest.values > EDGE
    weights = np.where(lies, final, 0.0)
    top = np.unravel_index(np.where(pile.values > 0.0, terrain.values + pile.values, -np.inf).argmax(), x.shape)
    apart = np.where(lies, np.hypot(x - x[top], y - y[top]), -np.inf)
    far = np.unravel_index(apart.argmax(), x.shape)
    cell = terrain.grid.cell_area
    return Figures(
        x=float((weights * x).sum() / weights.sum()),
        y=float((weights * y).sum() / weights.sum()),
        area=float(lies.sum()) * cell / 1e6,
        passed=float(was.sum()) * cell / 1e6,
        farthest=float(x[lies].max()),
        travel=float(apart[far]),
        drop=float(terrain.values[top] + pile.values[top] - terrain.values[far]),
        speed=float(deposit.speed.values[was].max()),
        high_speed=float(np.quantile(deposit.speed.values[was], 0.95)),
        usual_speed=float(np.median(deposit.speed.values[was])),
        thickness=float(final.max()),
        volume=float(final.sum()) * cell / 1e6,
    )


@dataclass(frozen=True)
class Difference:
    """Difference between two deposits."""

    overlap: float  # area of both over area of either
    thickness: float  # root mean square difference over the area of either [m]
    moved: float  # volume at a different location, over the volume


def difference(one: Deposit, other: Deposit) -> Difference:
    """Return the difference of two deposits."""
    a, b = one.final.values, other.final.values
    both, either = (a > EDGE) & (b > EDGE), (a > EDGE) | (b > EDGE)
    return Difference(
        overlap=float(both.sum()) / float(either.sum()),
        thickness=float(np.sqrt(np.mean((a - b)[either] ** 2))),
        moved=float(np.abs(a - b).sum() / (a.sum() + b.sum())),
    )


def volume_along(thickness: Map) -> Numbers:
    """Return the section area [m2] of a deposit across each column of the grid, from west to east."""
    section: Numbers = thickness.values.sum(axis=0) * thickness.grid.cell_y
    return section
