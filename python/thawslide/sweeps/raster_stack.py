"""Rasters of many simulations on one grid, read in windows: memory does not depend on their number."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import rasterio

from thawslide import _core
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.map_files import errors_of, open_raster

MEMORY = 256e6  # bytes of one window of all rasters
_SMALLEST_SIDE, _LARGEST_SIDE = 16, 1024  # cells of a window
_ALIGNED = 1e-3  # of a cell: difference up to which cells of two rasters coincide


@dataclass(frozen=True)
class RasterGrid:
    """Cells of a raster: north-west corner [m], cell sizes [m], rows from north to south, and the CRS as text."""

    west: float
    north: float
    cell_x: float
    cell_y: float
    columns: int
    rows: int
    crs: str

    @property
    def transform(self) -> Any:
        """The affine transformation of rasterio."""
        return rasterio.Affine(self.cell_x, 0.0, self.west, 0.0, -self.cell_y, self.north)


class RasterStack:
    """Rasters whose cells coincide; their extents may differ, and cells outside an extent have no data."""

    def __init__(self, files: Sequence[Path], quantity: _core.Quantity) -> None:
        """Read the grids of all rasters of a quantity; ReportError if the cells do not coincide."""
        self.files, self.quantity = list(files), quantity
        self.notes: list[str] = []
        self._grids = []
        for path in self.files:
            file, notes = open_raster(path, quantity)
            self.notes += notes
            self._grids.append(_grid_of(file.layout))
        first = self._grids[0]
        for path, grid in zip(self.files, self._grids, strict=True):
            _require_coincident(self.files[0], first, path, grid)
        west, north = min(grid.west for grid in self._grids), max(grid.north for grid in self._grids)
        self._offsets = [
            (round((north - grid.north) / first.cell_y), round((grid.west - west) / first.cell_x))
            for grid in self._grids
        ]
        rows = max(offset[0] + grid.rows for offset, grid in zip(self._offsets, self._grids, strict=True))
        columns = max(offset[1] + grid.columns for offset, grid in zip(self._offsets, self._grids, strict=True))
        self.grid = RasterGrid(west, north, first.cell_x, first.cell_y, columns, rows, first.crs)

    def windows(self, memory: float = MEMORY) -> Iterator[tuple[slice, slice]]:
        """Return rows and columns of windows that cover the grid; all rasters of one need at most `memory` bytes."""
        most = math.sqrt(memory / (8.0 * len(self.files)))
        side = 2 ** int(math.log2(min(max(most, _SMALLEST_SIDE), _LARGEST_SIDE)))  # few windows cross tiles of a file
        for row in range(0, self.grid.rows, side):
            for column in range(0, self.grid.columns, side):
                yield (
                    slice(row, min(row + side, self.grid.rows)),
                    slice(column, min(column + side, self.grid.columns)),
                )

    def read(self, window: tuple[slice, slice], missing: float) -> Numbers:
        """Return the values in a window, shape (rasters, rows, columns), with a value for cells without data."""
        rows, columns = window
        values = np.full((len(self.files), rows.stop - rows.start, columns.stop - columns.start), missing)
        for layer, path, grid, (row, column) in zip(values, self.files, self._grids, self._offsets, strict=True):
            top, bottom = max(rows.start, row), min(rows.stop, row + grid.rows)
            left, right = max(columns.start, column), min(columns.stop, column + grid.columns)
            if top >= bottom or left >= right:
                continue
            file, _ = open_raster(path, self.quantity)
            with errors_of(path):  # rows of the file begin in the south
                read = file.read(left - column, row + grid.rows - bottom, right - left, bottom - top)
            part = np.asarray(read)[::-1]
            layer[top - rows.start : bottom - rows.start, left - columns.start : right - columns.start] = np.where(
                np.isnan(part), missing, part
            )
        return values


def _grid_of(layout: _core.Raster) -> RasterGrid:
    west, north = layout.x - 0.5 * layout.cell_x, layout.y + (layout.rows - 0.5) * layout.cell_y
    return RasterGrid(west, north, layout.cell_x, layout.cell_y, layout.columns, layout.rows, layout.crs)


def _require_coincident(first_path: Path, first: RasterGrid, path: Path, grid: RasterGrid) -> None:
    """Raise ReportError unless the cells of two rasters coincide."""
    if not _core.is_same_system(first.crs, grid.crs):
        raise ReportError(f"{path}: its coordinate reference system differs from that of {first_path}. Reproject it.")
    most = max(first.columns, first.rows, grid.columns, grid.rows)
    sizes = max(abs(grid.cell_x / first.cell_x - 1.0), abs(grid.cell_y / first.cell_y - 1.0))
    shifts = ((grid.west - first.west) / first.cell_x, (grid.north - first.north) / first.cell_y)
    if sizes * most > _ALIGNED or any(abs(shift - round(shift)) > _ALIGNED for shift in shifts):
        raise ReportError(
            f"{path}: its cells do not coincide with those of {first_path} (found {grid.cell_x:g} x {grid.cell_y:g} "
            f"from {grid.west:.10g}, {grid.north:.10g}; allowed {first.cell_x:g} x {first.cell_y:g} from "
            f"{first.west:.10g}, {first.north:.10g} plus whole cells). Resample the raster, or set maps.cell."
        )
