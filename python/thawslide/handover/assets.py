"""Assets in the way of a slide: maximum pressure, thickness and speed at each, with the times of arrival and peak.

An asset is a polygon (a building, a section of a road) or a point (a pylon). Its values are the largest of all map
cells that it touches.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rasterio.features import rasterize
from rasterio.transform import from_origin

from thawslide.arrays import Numbers
from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError, printable
from thawslide.map_files import read_polygons
from thawslide.maps import Grid
from thawslide.run_folder import Run

MAPS = ("max_pressure", "max_thickness", "max_speed", "arrival_time", "max_pressure_time")


@dataclass(frozen=True)
class Asset:
    """Values of one asset; nan where the slide does not reach it."""

    name: str
    max_pressure_kpa: float  # dynamic pressure [kPa]
    max_pressure_time_s: float  # when it occurs [s]
    arrival_time_s: float  # when the slide arrives first [s]
    max_thickness_m: float  # vertical [m]
    max_speed_m_s: float  # averaged over depth [m/s]

    @property
    def is_hit(self) -> bool:
        """Whether the slide reaches the asset."""
        return math.isfinite(self.arrival_time_s)


def assets_hit(run: Run, polygons: Path | None = None, points: Sequence[tuple[str, float, float]] = ()) -> list[Asset]:
    """Return the values of assets in a 3D run on a DEM, polygons first, in the order given.

    polygons: file of polygons (GeoPackage, GeoJSON, Shapefile, KML); without the attribute `name`, the name is
    "polygon 1". points: name, x and y [m] in the coordinate reference system of the run. NotInRunError without maps,
    ReportError for assets outside them.
    """
    maps = {name: run.maps[name].values for name in MAPS}
    pressure = run.maps["max_pressure"]
    found = []
    if polygons is not None:
        rings, names, _ = read_polygons(polygons, pressure.wkt)
        for number, (polygon, given) in enumerate(zip(rings, names, strict=True), start=1):
            name = " ".join(printable(given).split()) or f"polygon {number}"
            found.append(_asset(name, _cells_of_polygon(pressure.grid, polygon, name), maps))
    for name, x, y in points:
        found.append(_asset(name, _cell_of_point(pressure.grid, x, y, name), maps))
    return found


def write_assets(assets: Sequence[Asset], path: Path) -> None:
    """Write a CSV file with one row per asset; a value is empty where the slide does not reach it."""
    with atomic_file(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow([each.name for each in fields(Asset)])
        for asset in assets:
            name, *values = astuple(asset)
            rows.writerow([name, *(repr(value) if math.isfinite(value) else "" for value in values)])


def _cells_of_polygon(grid: Grid, rings: Sequence[Numbers], name: str) -> NDArray[np.bool_]:
    west, east, south, north = grid.box
    shape = {"type": "Polygon", "coordinates": [ring.tolist() for ring in rings]}
    transform = from_origin(west, north, grid.cell_x, grid.cell_y)
    size = (grid.rows, grid.columns)
    touched = rasterize([shape], out_shape=size, transform=transform, all_touched=True, dtype="uint8")
    corners = np.concatenate(list(rings))
    (low_x, low_y), (high_x, high_y) = corners.min(axis=0), corners.max(axis=0)
    if not touched.any() or low_x < west or high_x > east or low_y < south or high_y > north:
        raise ReportError(
            f"{name}: not within the maps of the run (found x = {low_x:.10g} to {high_x:.10g}, y = {low_y:.10g} to "
            f"{high_y:.10g}; allowed {west:.10g} to {east:.10g}, {south:.10g} to {north:.10g}). Correct or omit it."
        )
    return np.asarray(touched[::-1], dtype=bool)


def _cell_of_point(grid: Grid, x: float, y: float, name: str) -> NDArray[np.bool_]:
    west, east, south, north = grid.box
    if not (west <= x < east and south <= y < north):
        raise ReportError(
            f"{name}: outside the maps of the run (found x = {x:.10g}, y = {y:.10g}; allowed x = {west:.10g} to "
            f"{east:.10g}, y = {south:.10g} to {north:.10g}). Correct its coordinates, or omit it."
        )
    cells = np.zeros((grid.rows, grid.columns), dtype=bool)
    cells[int((y - south) // grid.cell_y), int((x - west) // grid.cell_x)] = True
    return cells


def _asset(name: str, cells: NDArray[np.bool_], maps: dict[str, Numbers]) -> Asset:
    pressure = maps["max_pressure"][cells]
    peak = math.nan
    if np.isfinite(pressure).any():
        peak = float(maps["max_pressure_time"][cells][int(np.nanargmax(pressure))])
    arrival = maps["arrival_time"][cells]
    first = float(np.nanmin(arrival)) if np.isfinite(arrival).any() else math.nan
    return Asset(name, 1e-3 * _largest(pressure), peak, first, *(_largest(maps[key][cells]) for key in MAPS[1:3]))


def _largest(values: Numbers) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else math.nan
