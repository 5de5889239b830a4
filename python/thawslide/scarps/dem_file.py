"""DEM of a release: a north-up raster of elevations in projected metres."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import rasterio
from numpy.typing import NDArray
from rasterio.crs import CRS
from rasterio.errors import CRSError, RasterioError

from thawslide.arrays import Numbers
from thawslide.errors import ReportError, quoted

Mask = NDArray[np.bool_]

_METRES = ("", "m", "metre", "metres", "meter", "meters")


@dataclass(frozen=True)
class Dem:
    """Elevations [m] at the centres of cells, shape (rows, columns), rows from north to south; nan: no data."""

    path: Path
    heights: Numbers
    transform: Any  # affine.Affine: from column and row to coordinates
    crs: CRS | None

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
    """Read a DEM (GeoTIFF or ESRI ASCII grid); `crs` is the coordinate system of a file without one."""
    if not path.is_file():
        raise ReportError(f"{path}: no such file. Correct the path of the DEM.")
    try:
        with rasterio.open(path) as file:
            heights = file.read(1, masked=True).astype(np.float64).filled(np.nan)
            transform, system, unit, bands = file.transform, file.crs, file.units[0], file.count
            driver = file.driver
    except RasterioError as error:
        raise ReportError(f"{path}: cannot be read as a GeoTIFF or ESRI ASCII grid ({error}). Convert it.") from error
    if driver not in ("GTiff", "AAIGrid"):
        raise ReportError(f"{path}: unknown format (found {driver}; allowed GeoTIFF, ESRI ASCII grid). Convert it.")
    if bands > 2 or min(heights.shape) < 3:
        shape = f"{bands} bands of {heights.shape[1]} x {heights.shape[0]} cells"
        raise ReportError(f"{path}: not a DEM (found {shape}; allowed 1 band, at least 3 x 3 cells). Correct the path.")
    if transform.b or transform.d or transform.a <= 0.0 or transform.e >= 0.0:
        raise ReportError(f"{path}: the raster is not north-up. Resample it, e.g. with gdalwarp.")
    if (unit or "").strip().lower() not in _METRES:
        raise ReportError(f"{path}: elevations are not in metres (found {quoted(unit)}). Convert them.")
    dem = Dem(path, np.where(np.isfinite(heights), heights, np.nan), transform, _system_of(path, system, crs))
    if not np.isfinite(dem.heights).any():
        raise ReportError(f"{path}: no cell has data. Correct the path of the DEM.")
    return dem


def _system_of(path: Path, found: CRS | None, given: str | None) -> CRS | None:
    if given is not None:
        try:
            stated = CRS.from_user_input(given)
        except CRSError as error:
            raise ReportError(
                f"--crs: unknown coordinate system (found {quoted(given)}). Use e.g. EPSG:31287."
            ) from error
        if found is not None and found != stated:
            raise ReportError(f"--crs: {path} already has the coordinate system {found.to_string()}. Omit --crs.")
        found = stated
    if found is not None and (not found.is_projected or abs(found.linear_units_factor[1] - 1.0) > 1e-9):
        raise ReportError(
            f"{path}: the coordinate system {found.to_string()} is not in projected metres. Reproject the DEM, "
            "e.g. to UTM."
        )
    return found
