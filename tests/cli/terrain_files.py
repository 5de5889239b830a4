"""Small DEMs, release areas and lines, as files of a user."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import rasterio

CRS_NAME = "EPSG:31287"
EAST, NORTH = 300000.0, 400000.0  # lower left corner of the models [m]

Corners = list[tuple[float, float]]


def place(x: float, y: float) -> tuple[float, float]:
    """Return coordinates in the reference system from those relative to the model's corner."""
    return EAST + x, NORTH + y


def write_dem(
    file: Path,
    height: Callable[[np.ndarray, np.ndarray], np.ndarray],
    columns: int = 80,
    rows: int = 40,
    cell: float = 10.0,
) -> Path:
    """Write a GeoTIFF; heights are of x and y relative to the corner [m], and NaN for missing data."""
    x = (np.arange(columns) + 0.5) * cell
    y = (np.arange(rows)[::-1] + 0.5) * cell  # the file begins in the north
    shape = {"width": columns, "height": rows, "count": 1, "dtype": "float64"}
    there = {
        "crs": CRS_NAME,
        "transform": rasterio.Affine(cell, 0.0, EAST, 0.0, -cell, NORTH + rows * cell),
        "nodata": np.nan,
    }
    with rasterio.open(file, "w", driver="GTiff", **shape, **there) as dem:
        dem.write(height(*np.meshgrid(x, y)), 1)
    return file


def write_geojson(file: Path, kind: str, coordinates: object, **attributes: object) -> Path:
    """Write one feature in the models' reference system."""
    feature = {"type": "Feature", "properties": attributes, "geometry": {"type": kind, "coordinates": coordinates}}
    system = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:{CRS_NAME.replace(':', '::')}"}}
    file.write_text(json.dumps({"type": "FeatureCollection", "crs": system, "features": [feature]}))
    return file


def write_line(file: Path, corners: Corners) -> Path:
    """Write a line; its corners are relative to the models' corner [m]."""
    return write_geojson(file, "LineString", [place(*corner) for corner in corners])


def write_release(file: Path, corners: Corners, **attributes: object) -> Path:
    """Write a polygon with attributes; its corners are relative to the models' corner [m]."""
    ring = [place(*corner) for corner in [*corners, corners[0]]]
    return write_geojson(file, "Polygon", [ring], **attributes)
