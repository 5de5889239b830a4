"""Small DEMs, release areas, lines and case texts, as files of a user."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import rasterio

CRS_NAME = "EPSG:31287"
EAST, NORTH = 300000.0, 400000.0  # lower left corner of the models [m]

# A slope as a DEM, with a rectangle of 120 m by 100 m on it as the release.
SLOPE_CRS = "EPSG:32632"
WEST, SOUTH, CELL = 412_000.0, 5_160_000.0, 10.0
COLUMNS, ROWS = 90, 60
WIDTH, DEPTH, THICKNESS = 120.0, 100.0, 24.0  # m

Corners = list[tuple[float, float]]
Height = Callable[[np.ndarray, np.ndarray], np.ndarray]


def toml(text: str) -> str:
    """Return a case file from lines of a table each, [TABLE] KEY = VALUE | KEY = VALUE; indented lines continue it."""
    tables = re.sub(r"\n +", " | ", text.strip()).splitlines()
    return "\n".join(table.replace("] ", "]\n", 1).replace(" | ", "\n") + "\n" for table in tables)


def place(x: float, y: float) -> tuple[float, float]:
    """Return coordinates in the reference system from those relative to the model's corner."""
    return EAST + x, NORTH + y


def write_raster(
    file: Path, values: np.ndarray, west: float, south: float, cell: float, crs: Any, nodata: float
) -> Path:
    """Write a GeoTIFF, whose first row is in the north."""
    rows, columns = values.shape
    shape = {"width": columns, "height": rows, "count": 1, "dtype": "float64"}
    corner = rasterio.Affine(cell, 0.0, west, 0.0, -cell, south + rows * cell)
    with rasterio.open(file, "w", driver="GTiff", **shape, crs=crs, transform=corner, nodata=nodata) as dem:
        dem.write(values, 1)
    return file


def turn_rows(file: Path) -> None:
    """Write the rows of a raster in the other order, which its georeference states."""
    with rasterio.open(file) as raster:
        values, profile = raster.read(1), raster.profile
    there = profile["transform"]
    profile["transform"] = rasterio.Affine(there.a, 0.0, there.c, 0.0, -there.e, there.f + values.shape[0] * there.e)
    with rasterio.open(file, "w", **profile) as raster:
        raster.write(values[::-1], 1)


def write_dem(file: Path, height: Height, columns: int = 80, rows: int = 40, cell: float = 10.0) -> Path:
    """Write a GeoTIFF; heights are of x and y relative to the corner [m], and NaN for missing data."""
    x = (np.arange(columns) + 0.5) * cell
    y = (np.arange(rows)[::-1] + 0.5) * cell  # the file begins in the north
    return write_raster(file, height(*np.meshgrid(x, y)), EAST, NORTH, cell, CRS_NAME, np.nan)


def write_slope(
    file: Path, crs: str | None = SLOPE_CRS, hole: slice | None = None, degrees: float = 30.0, foot: float = 450.0
) -> Path:
    """Write a slope towards the east, level from its foot on, as far from the west [m].

    `hole`: columns without data in ten rows across the flow path.
    """
    x = CELL * np.arange(COLUMNS)
    heights = np.tile(1000.0 + np.tan(np.radians(degrees)) * np.maximum(0.0, foot - x), (ROWS, 1))
    if hole:
        heights[25:35, hole] = -9999.0
    return write_raster(file, heights, WEST - CELL / 2, SOUTH - CELL / 2, CELL, crs, -9999.0)


def write_thickness(file: Path, dem: Path, thickness: float) -> Path:
    """Write a raster with the thickness on as many points of the DEM as the release has cells."""
    with rasterio.open(dem) as source:
        values, profile = np.zeros(source.shape), source.profile
    values[25:35, 20:32] = thickness
    file.parent.mkdir(exist_ok=True)
    with rasterio.open(file, "w", **profile) as raster:
        raster.write(values, 1)
    return file


def write_geojson(
    file: Path, kind: str, coordinates: object, *, crs: str | None = CRS_NAME, **attributes: object
) -> Path:
    """Write one feature in a reference system; without one, in longitude and latitude."""
    return write_features(file, kind, [(coordinates, attributes)], crs)


def write_features(file: Path, kind: str, features: list[tuple[Any, dict[str, Any]]], crs: str | None) -> Path:
    """Write features, given by their coordinates and attributes."""
    system = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:{crs.replace(':', '::')}"}} if crs else None
    content = [
        {"type": "Feature", "properties": attributes, "geometry": {"type": kind, "coordinates": coordinates}}
        for coordinates, attributes in features
    ]
    head = {"type": "FeatureCollection"} | ({"crs": system} if crs else {})
    file.write_text(json.dumps(head | {"features": content}))
    return file


def write_line(file: Path, corners: Corners) -> Path:
    """Write a line; its corners are relative to the models' corner [m]."""
    return write_geojson(file, "LineString", [place(*corner) for corner in corners])


def write_release(file: Path, corners: Corners, **attributes: object) -> Path:
    """Write a polygon with attributes; its corners are relative to the models' corner [m]."""
    ring = [place(*corner) for corner in [*corners, corners[0]]]
    return write_geojson(file, "Polygon", [ring], **attributes)


def write_rectangle(
    file: Path, west: float, south: float, width: float = WIDTH, depth: float = DEPTH, **attributes: float
) -> Path:
    """Write a rectangle on the slope with its attributes."""
    east, north = west + width, south + depth
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return write_geojson(file, "Polygon", [ring], crs=SLOPE_CRS, name="slide", **attributes)
