"""DEM of a release, and outlines as its cells."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rasterio import Affine
from rasterio.features import rasterize

from thawslide import _core
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.map_files import read_polygons, read_raster

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Dem:
    """Elevations [m] at the centres of cells, shape (rows, columns), rows from north to south; nan: no data."""

    path: Path
    raster: _core.Raster  # as it was read
    heights: Numbers
    transform: Affine  # from column and row to coordinates
    notes: list[str] = field(default_factory=list)  # notes and warnings from reading the DEM and outlines on it

    @property
    def cell_x(self) -> float:
        """Width of a cell [m]."""
        return float(self.transform.a)

    @property
    def cell_y(self) -> float:
        """Height of a cell [m]."""
        return float(-self.transform.e)

    @property
    def cell_area(self) -> float:
        """Area of a cell [m2]."""
        return self.cell_x * self.cell_y

    def offsets(self, x0: float, y0: float) -> tuple[Numbers, Numbers]:
        """Return x - x0, shape (1, columns), and y - y0, shape (rows, 1), of the centres of the cells [m]."""
        rows, columns = self.heights.shape
        x = (self.transform.c - x0) + self.cell_x * (np.arange(columns) + 0.5)
        y = (self.transform.f - y0) - self.cell_y * (np.arange(rows) + 0.5)
        return x[None, :], y[:, None]

    def centre(self, row: int, column: int) -> tuple[float, float]:
        """Return the coordinates of the centre of a cell."""
        return self.transform.c + self.cell_x * (column + 0.5), self.transform.f - self.cell_y * (row + 0.5)

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Return row and column of the cell that contains a point of the DEM."""
        rows, columns = self.heights.shape
        row = min(max(math.floor((self.transform.f - y) / self.cell_y), 0), rows - 1)
        return row, min(max(math.floor((x - self.transform.c) / self.cell_x), 0), columns - 1)

    def require_extent(self, west: float, south: float, east: float, north: float, subject: str) -> None:
        """Raise ReportError if a rectangle is not within the DEM."""
        rows, columns = self.heights.shape
        own_west, own_north = self.transform.c, self.transform.f
        own_east, own_south = own_west + columns * self.cell_x, own_north - rows * self.cell_y
        if west < own_west or south < own_south or east > own_east or north > own_north:
            raise ReportError(
                f"{subject}: outside the DEM {self.path} (found {_extent_text(west, south, east, north)}; allowed "
                f"{_extent_text(own_west, own_south, own_east, own_north)}). Correct the coordinates, or use a "
                "larger DEM."
            )

    def require_data(self, cells: Mask, subject: str) -> None:
        """Raise ReportError if some of the cells have no data."""
        absent = cells & ~np.isfinite(self.heights)
        if absent.any():
            x, y = self.centre(*map(int, np.argwhere(absent)[0]))
            raise ReportError(
                f"{subject}: cells without data in {self.path} (found {np.count_nonzero(absent):,}; the first at "
                f"x = {x:.10g}, y = {y:.10g}). Fill them, or change the outline."
            )

    def cells_within(self, path: Path) -> Mask:
        """Return the cells whose centres are inside the polygons of a file."""
        polygons, _, notes = read_polygons(path, self.raster.crs)
        self.notes.extend(notes)
        corners = np.concatenate([ring for rings in polygons for ring in rings])
        (west, south), (east, north) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        self.require_extent(west, south, east, north, f"--within {path}")
        shapes = [{"type": "Polygon", "coordinates": [ring.tolist() for ring in rings]} for rings in polygons]
        inside = rasterize(shapes, out_shape=self.heights.shape, transform=self.transform, dtype="uint8") > 0
        if not inside.any():
            raise ReportError(f"--within {path}: no centre of a cell of {self.path} is inside. Draw a larger outline.")
        self.require_data(inside, f"--within {path}")
        return np.asarray(inside)

    def height_at(self, x: float, y: float, subject: str) -> float:
        """Return the elevation at a point [m], bilinear between the centres of cells."""
        self.require_extent(x, y, x, y, subject)
        rows, columns = self.heights.shape
        column = min(max((x - self.transform.c) / self.cell_x - 0.5, 0.0), columns - 1.0)
        row = min(max((self.transform.f - y) / self.cell_y - 0.5, 0.0), rows - 1.0)
        left, top = min(int(column), columns - 2), min(int(row), rows - 2)
        right_part, lower_part = column - left, row - top
        weights = np.outer((1.0 - lower_part, lower_part), (1.0 - right_part, right_part))
        heights = self.heights[top : top + 2, left : left + 2]
        height = float(np.sum(heights * weights, where=weights > 0.0))  # cells without data may have no weight
        if not math.isfinite(height):
            raise ReportError(
                f"{subject}: no data in {self.path} at x = {x:.10g}, y = {y:.10g}. Select another point, or "
                "fill the DEM."
            )
        return height


def _extent_text(west: float, south: float, east: float, north: float) -> str:
    if (west, south) == (east, north):
        return f"x = {west:.10g}, y = {south:.10g}"
    return f"x = {west:.10g} to {east:.10g}, y = {south:.10g} to {north:.10g}"


def read_dem(path: Path, crs: str | None = None) -> Dem:
    """Read a DEM (GeoTIFF or ESRI ASCII grid); `crs` replaces the coordinate reference system of its file."""
    raster, notes = read_raster(path, crs or "")
    if min(raster.rows, raster.columns) < 3:
        shape = f"{raster.columns} x {raster.rows}"
        raise ReportError(f"{path}: not a DEM (found {shape} cells; allowed at least 3 x 3). Correct the path.")
    west, north = raster.x - 0.5 * raster.cell_x, raster.y + (raster.rows - 0.5) * raster.cell_y
    transform = Affine(raster.cell_x, 0.0, west, 0.0, -raster.cell_y, north)
    return Dem(path, raster, np.asarray(raster.values)[::-1], transform, notes)
