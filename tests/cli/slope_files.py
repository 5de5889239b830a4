"""A slope as a DEM with a release area, and functions that make cases from them with `thawslide new`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import rasterio
from rasterio.transform import from_origin

if TYPE_CHECKING:
    from conftest import Outcome, Program

WEST, SOUTH, CELL = 412_000.0, 5_160_000.0, 10.0
COLUMNS, ROWS = 90, 60
THICKNESS = 24.0  # m
# A rectangle of 120 m by 100 m on the slope.
WIDTH, DEPTH = 120.0, 100.0

Slope = Callable[..., Path]


def write_slope(
    path: Path, crs: str | None = "EPSG:32632", hole: slice | None = None, degrees: float = 30.0, foot: float = 450.0
) -> Path:
    """Write a slope towards the east, level from its foot on, as far from the west [m].

    `hole`: columns without data in ten rows across the flow path.
    """
    x = CELL * np.arange(COLUMNS)
    heights = np.tile(1000.0 + np.tan(np.radians(degrees)) * np.maximum(0.0, foot - x), (ROWS, 1))
    if hole:
        heights[25:35, hole] = -9999.0
    corner = from_origin(WEST - CELL / 2, SOUTH + (ROWS - 0.5) * CELL, CELL, CELL)
    profile = {"driver": "GTiff", "count": 1, "dtype": "float64", "height": ROWS, "width": COLUMNS}
    with rasterio.open(path, "w", **profile, crs=crs, transform=corner, nodata=-9999.0) as file:
        file.write(heights, 1)
    return path


def write_release(
    path: Path, west: float, south: float, width: float = WIDTH, depth: float = DEPTH, **attributes: float
) -> Path:
    """Write a rectangle with its attributes."""
    east, north = west + width, south + depth
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    feature = {
        "type": "Feature",
        "properties": {"name": "slide", **attributes},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    system = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}
    path.write_text(json.dumps({"type": "FeatureCollection", "crs": system, "features": [feature]}))
    return path


def made(thawslide: Program, folder: Path, dem: Path, release: Path, *words: object) -> Outcome:
    """Create a case folder."""
    return thawslide("new", folder, "--dem", dem, "--release", release, *words)


def without_folder(text: str, tmp_path: Path) -> str:
    """Return a message without the folder of the test."""
    return text.replace(f"{tmp_path}/", "")


def assert_refused(outcome: Outcome, tmp_path: Path, message: str) -> None:
    """Fail unless the command prints exactly this error and writes nothing."""
    assert outcome.returncode == 2, outcome.stderr
    assert without_folder(outcome.stderr, tmp_path) == f"error: {message}\n"
    assert not (tmp_path / "slide").exists()


def write_thickness(path: Path, dem: Path, thickness: float) -> Path:
    """Write a raster with the thickness on as many points of the DEM as the release has cells."""
    with rasterio.open(dem) as file:
        values, profile = np.zeros(file.shape), file.profile
    values[25:35, 20:32] = thickness
    path.parent.mkdir(exist_ok=True)
    with rasterio.open(path, "w", **profile) as file:
        file.write(values, 1)
    return path
