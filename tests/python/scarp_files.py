"""DEMs and outlines of releases."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import rasterio
from terrain_files import write_geojson

from thawslide.arrays import Numbers

WEST, NORTH, CRS = 400_000.0, 6_504_000.0, "EPSG:32608"
Shape = Callable[[Numbers, Numbers], Numbers]
Ring = list[list[float]]


def write_dem(
    path: Path, shape: Shape, cell: float = 10.0, size: float = 1000.0, cell_y: float | None = None,
    crs: str | None = CRS, no_data: tuple[int, int] | None = None, unit: str = "m",
) -> Path:  # fmt: skip
    """Write a square DEM: heights over x and y from its centre [m], and one cell (row, column) without data."""
    cell_y = cell_y or cell
    columns, rows = round(size / cell), round(size / cell_y)
    x = cell * (np.arange(columns) + 0.5) - size / 2
    heights = shape(*np.meshgrid(x, size / 2 - cell_y * (np.arange(rows) + 0.5)))
    if no_data:
        heights[no_data] = -9999.0
    with rasterio.open(
        path, "w", driver="GTiff", dtype="float64", count=1, width=columns, height=rows, nodata=-9999.0, crs=crs,
        transform=rasterio.Affine(cell, 0.0, WEST, 0.0, -cell_y, NORTH),
    ) as file:  # fmt: skip
        file.write(heights, 1)
        file.set_band_unit(1, unit)
    return path


def centre(size: float = 1000.0) -> tuple[float, float]:
    """Return the coordinates of the centre of a DEM."""
    return WEST + size / 2, NORTH - size / 2


def rectangle(x: tuple[float, float], y: tuple[float, float], size: float = 1000.0) -> Ring:
    """Return a rectangle, whose sides are given from the centre of a DEM [m]."""
    x0, y0 = centre(size)
    corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])]
    return [[x0 + east, y0 + north] for east, north in corners]


def write_outline(path: Path, *rings: Ring, crs: str | None = CRS) -> Path:
    """Write a polygon with holes as GeoJSON."""
    return write_geojson(path, "Polygon", list(rings), crs=crs)
