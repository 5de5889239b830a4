"""Results of the two programs on a terrain, as comparable maps and numbers."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.path import Path as Outline

from reproduction.engine import processor_time
from thawslide.errors import ReportError
from thawslide.maps import Map, read_map
from thawslide.relief import slopes
from thawslide.run_folder import Numbers, Run

GRAVITY = 9.81  # m/s2
AFFECTED = 0.5  # m, vertical: minimum thickness of the area reached


@dataclass(frozen=True)
class Outcome:
    """Results of one program: maps on the DEM's grid, and facts about its run."""

    program: str
    thickness: Map  # maximum, vertical [m]
    speed: Map  # maximum [m/s]
    final_thickness: Map  # vertical [m]
    left_share: float  # fraction of the release that left the DEM
    processor: float  # time on one core [s]

    @property
    def short_name(self) -> str:
        """Name of the program without its version, and what differs in this run."""
        name, *words = self.program.split(", ", 1)
        return ", ".join([name.split()[0], *words])


def without_gaps(field: Map) -> Numbers:
    """Return the values of a map, 0 in cells that the slide did not reach."""
    return np.nan_to_num(field.values, nan=0.0)


def read_avaframe(folder: Path, terrain: Map, name: str = "avaframe", words: str = "") -> Outcome:
    """Read AvaFrame's results; its thickness is converted from normal to vertical."""
    facts = json.loads((folder / f"{name}.facts.json").read_text())
    peaks = folder / name / "Outputs" / "com1DFA" / "peakFiles"
    found = {kind: read_map(next(iter(peaks.glob(f"*_{kind}.tif")))) for kind in ("pft", "pfv", "FT")}
    steepness = np.nan_to_num(np.hypot(*slopes(terrain.values, terrain.grid.cell_x, terrain.grid.cell_y)), nan=0.0)
    over_cosine = np.sqrt(1.0 + steepness**2)

    def vertical(kind: str) -> Map:
        return Map(found[kind].grid, without_gaps(found[kind]) * over_cosine, "m")

    return Outcome(
        ", ".join(part for part in (f"AvaFrame {facts['version']}", words) if part),
        vertical("pft"),
        found["pfv"],
        vertical("FT"),
        float(facts["left_share"]),
        processor_time(folder / name),
    )


def on_grid(field: Map, terrain: Map) -> Map:
    """Return a map on the grid of the terrain, whose cells subdivide those of the map; nan outside the map."""
    grid = terrain.grid
    times = round(field.grid.cell_x / grid.cell_x)
    west, _, south, _ = field.grid.box
    column = round((west - grid.box[0]) / grid.cell_x)
    row = round((south - grid.box[2]) / grid.cell_y)
    blocks = np.repeat(np.repeat(field.values, times, axis=0), times, axis=1)
    values = np.full(terrain.values.shape, np.nan)
    part = values[max(row, 0) : row + blocks.shape[0], max(column, 0) : column + blocks.shape[1]]
    part[:] = blocks[max(-row, 0) :, max(-column, 0) :][: part.shape[0], : part.shape[1]]
    return Map(grid, values, field.unit)


def read_thawslide(folder: Path, terrain: Map, name: str = "thawslide", words: str = "") -> Outcome:
    """Read the results of a run of Thawslide, whose maps cover the domain."""
    run = Run(folder / name)
    thickness, speed, final = (
        on_grid(read_map(run.folder / "maps" / f"{name}.tif"), terrain)
        for name in ("max_thickness", "max_speed", "final_thickness")
    )
    return Outcome(
        ", ".join(part for part in (f"Thawslide {run.facts['version']}", words) if part),
        thickness,
        speed,
        final,
        float(run.series["left_mass_kg"][-1] / run.series["mass_kg"][0]),
        processor_time(folder / name),
    )


@dataclass(frozen=True)
class Numbered:
    """The numbers of one outcome that the page shows."""

    travel: float  # horizontal, from the top of the release to the farthest point reached [m]
    reach_angle: float  # of the line between the two [degrees]
    centre_displacement: float  # horizontal, of the centre of the slide, straight from release to deposit [m]
    max_speed: float  # over the area reached [m/s]
    max_thickness: float  # vertical [m]
    area: float  # reached [m2]


def numbers(outcome: Outcome, terrain: Map, corners: list[list[float]]) -> Numbered:
    """Return the numbers of an outcome; `corners` outline the release [m]."""
    x, y = np.meshgrid(terrain.grid.x, terrain.grid.y)
    places = np.column_stack([x.ravel(), y.ravel()])
    source = Outline(np.array(corners)).contains_points(places).reshape(x.shape)
    top = np.unravel_index(np.where(source, terrain.values, -np.inf).argmax(), x.shape)
    thickness, speed, final = (
        without_gaps(each) for each in (outcome.thickness, outcome.speed, outcome.final_thickness)
    )
    if thickness.shape != terrain.values.shape:
        raise ReportError(f"{outcome.program}: maps of {thickness.shape} cells, the DEM has {terrain.values.shape}")
    reached = thickness >= AFFECTED
    apart = np.where(reached, np.hypot(x - x[top], y - y[top]), -np.inf)
    farthest = np.unravel_index(apart.argmax(), x.shape)
    drop = terrain.values[top] - terrain.values[farthest]
    deposit = [float((final * axis).sum() / final.sum()) for axis in (x, y)]
    return Numbered(
        travel=float(apart[farthest]),
        reach_angle=math.degrees(math.atan2(drop, apart[farthest])),
        centre_displacement=math.hypot(deposit[0] - x[source].mean(), deposit[1] - y[source].mean()),
        max_speed=float(speed[reached].max()),
        max_thickness=float(thickness.max()),
        area=float(np.count_nonzero(reached)) * terrain.grid.cell_area,
    )


@dataclass(frozen=True)
class PointMass:
    """Motion of a point mass that slides due east from the centre of the release."""

    travel: float  # horizontal [m]
    max_speed: float  # [m/s]


def point_mass(terrain: Map, corners: list[list[float]], friction: float) -> PointMass:
    """Return the motion of a point mass on the DEM with a coefficient of friction.

    Its energy head E = v2/(2 g) over the horizontal distance x on a profile z(x), with friction on the weight across
    the ground and on the centrifugal force: dE/dx = -z' - friction (1 + 2 E z''/(1 + z'2)).
    """
    east, north = np.array(corners[:-1]).mean(axis=0)
    x = terrain.grid.x
    slopes_at = np.gradient(terrain.at(x, np.full_like(x, north)), x)
    bends_at = np.gradient(slopes_at, x)
    step, head, largest = 0.1, 0.0, 0.0  # m
    for place in np.arange(east, x[-1], step):
        slope, bend = np.interp(place, x, slopes_at), np.interp(place, x, bends_at)
        head += step * (-slope - friction * (1.0 + 2.0 * head * bend / (1.0 + slope**2)))
        largest = max(largest, head)
        if head <= 0.0:
            return PointMass(float(place - east), math.sqrt(2.0 * GRAVITY * largest))
    raise ReportError("the point mass leaves the DEM")
