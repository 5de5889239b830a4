"""Maps of members against an observed outline, and their thickness at points."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rasterio import Affine
from rasterio.features import rasterize

from thawslide import _core
from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError, ReportError
from thawslide.map_files import read_polygons
from thawslide.maps import MOST_CELLS
from thawslide.scores.forecast import Forecast
from thawslide.scores.observed import Observation, Outline
from thawslide.sweeps.probability import REACHED, arrival_threshold
from thawslide.sweeps.raster_stack import RasterStack

_EVEN = 0.5 - 1e-12  # probability from which a cell counts


def overlap_areas(forecast: Forecast, outline: Outline, notes: list[str]) -> tuple[Numbers, float]:
    """Return areas [m2] of overlap with the observed outline, shape (1 + members, 3), and the threshold [m].

    The first row is of the cells in which members of at least half of the weight exceed the threshold. Columns: within
    both outlines (hit), within the observed one only (missed), within the simulated one only (false).
    """
    files = _map_files(forecast, outline.is_deposit)
    threshold = outline.threshold if outline.threshold is not None else arrival_threshold(files) or REACHED
    stack = RasterStack(files, _core.Quantity.LENGTH)
    observed, top, left = _cells_within(outline.file, stack, notes)
    hit, simulated = np.zeros(len(files) + 1), np.zeros(len(files) + 1)
    for rows, columns in stack.windows():
        reached = stack.read((rows, columns), 0.0) > threshold
        probable = np.tensordot(forecast.weights, reached, 1) >= _EVEN
        areas = np.concatenate((probable[None], reached))
        seen = observed[rows.start + top : rows.stop + top, columns.start + left : columns.stop + left]
        hit += np.count_nonzero(areas & seen, axis=(1, 2))
        simulated += np.count_nonzero(areas, axis=(1, 2))
    cells = np.stack((hit, np.count_nonzero(observed) - hit, simulated - hit), axis=1)
    return cells * stack.grid.cell_x * stack.grid.cell_y, threshold


def jaccard(areas: Numbers) -> Numbers:
    """Return the Jaccard index of areas of overlap: the area within both outlines over that within either."""
    return np.asarray(areas[:, 0] / areas.sum(axis=1))


def thickness_at(forecast: Forecast, observation: Observation) -> Numbers:
    """Return the thickness [m] of each member in the cell that contains a point; 0 without material."""
    stack = RasterStack(_map_files(forecast, observation.is_deposit), _core.Quantity.LENGTH)
    grid, (x, y) = stack.grid, observation.point
    column, row = math.floor((x - grid.west) / grid.cell_x), math.floor((grid.north - y) / grid.cell_y)
    if not (0 <= column < grid.columns and 0 <= row < grid.rows):
        east, south = grid.west + grid.columns * grid.cell_x, grid.north - grid.rows * grid.cell_y
        raise ReportError(
            f"{observation.words}: outside the maps (found x = {x:.10g}, y = {y:.10g}; allowed {grid.west:.10g} to "
            f"{east:.10g}, {south:.10g} to {grid.north:.10g}). Correct the coordinates."
        )
    return stack.read((slice(row, row + 1), slice(column, column + 1)), 0.0)[:, 0, 0]


def _map_files(forecast: Forecast, is_deposit: bool) -> list[Path]:
    name = "final_thickness.tif" if is_deposit else "max_thickness.tif"
    files = [folder / "maps" / name for folder in forecast.run_folders]
    absent = next((file for file in files if not file.is_file()), None)
    if absent is not None:
        raise NotInRunError(f"no map {absent}. Only 3D runs on a DEM have maps, and --keep none removes them")
    return files


def _cells_within(file: Path, stack: RasterStack, notes: list[str]) -> tuple[NDArray[np.bool_], int, int]:
    """Return the cells whose centre is within polygons, and the rows and columns that precede those of the maps.

    Their grid is extended to the polygons: an area outside the maps is missed.
    """
    grid = stack.grid
    polygons, _, found = read_polygons(file, grid.crs)
    notes += found
    corners = np.concatenate([ring for rings in polygons for ring in rings])
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    left = max(math.ceil((grid.west - west) / grid.cell_x), 0)
    top = max(math.ceil((north - grid.north) / grid.cell_y), 0)
    columns = left + max(math.ceil((east - grid.west) / grid.cell_x), grid.columns)
    rows = top + max(math.ceil((grid.north - south) / grid.cell_y), grid.rows)
    corner = Affine(grid.cell_x, 0.0, grid.west - left * grid.cell_x, 0.0, -grid.cell_y, grid.north + top * grid.cell_y)
    shapes = [{"type": "Polygon", "coordinates": [ring.tolist() for ring in rings]} for rings in polygons]
    is_near = rows * columns <= max(MOST_CELLS, grid.rows * grid.columns)
    inside = (
        rasterize(shapes, (rows, columns), transform=corner, dtype="uint8") > 0 if is_near else np.zeros((1, 1), bool)
    )
    if not inside.any():
        raise ReportError(
            f"{file}: no centre of a map cell is inside, or far from the maps (found corners from {west:.10g}, "
            f"{south:.10g} to {east:.10g}, {north:.10g}). Correct the outline or its coordinate system."
        )
    return np.asarray(inside), top, left
