"""Small cases for sweeps, and files of maps."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest
import rasterio

Capture = pytest.CaptureFixture[str]
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / folder) for folder in ("api", "cli")]

from slope_case import write_slope_case  # noqa: E402
from terrain_files import write_geojson, write_raster  # noqa: E402

from thawslide.arrays import Numbers  # noqa: E402


@pytest.fixture
def with_program(monkeypatch: pytest.MonkeyPatch) -> None:
    program = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    if not program.is_file():
        pytest.skip(f"program not found: {program}. Build it, or set THAWSLIDE_BINARY.")
    monkeypatch.setenv("THAWSLIDE_PROGRAM", str(program))


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Return the case file of a block that slides down a slope, 0.5 s in 100 steps."""
    return write_slope_case(tmp_path / "slope", end=0.5, cell=10.0, friction="lubricated")


CELL, NO_DATA = 10.0, -9999.0


def write(path: Path, values: Numbers, west: float = 0.0, north: float = 1000.0, cell: float = CELL) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    known, south = np.where(np.isnan(values), NO_DATA, values), north - cell * len(values)
    return write_raster(path, known, west, south, cell, "EPSG:32608", NO_DATA)


def write_box(path: Path, west: float, east: float, south: float, north: float) -> Path:
    """Write a rectangle as GeoJSON."""
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return write_geojson(path, "Polygon", [ring], crs="EPSG:32608")


def read(path: Path) -> Numbers:
    with rasterio.open(path) as file:
        return np.ma.filled(file.read(1, masked=True), np.nan)


COLUMNS, ROWS, NORTH = 24, 16, 6_500_160.0


@pytest.fixture
def plane(tmp_path: Path) -> Path:
    """Return the folder of a 3D case: a body on an inclined plane, 0.5 s in 50 steps."""
    folder = tmp_path / "plane"
    folder.mkdir()
    x = (np.arange(COLUMNS) + 0.5) * CELL
    write(folder / "dem.tif", np.tile(200.0 - 0.6 * x, (ROWS, 1)), 400_000.0, NORTH)
    thickness = np.zeros((ROWS, COLUMNS))
    thickness[5:11, 4:9] = 20.0
    write(folder / "thickness.tif", thickness, 400_000.0, NORTH)
    (folder / "case.toml").write_text(
        """case = { dimension = 3 }
time = { end = 0.5, step = 0.01, output_interval = 0.5, history_interval = 0.1 }
grid = { cell = 10.0, min = [400010.0, 6500010.0, 0.0], max = [400230.0, 6500150.0, 260.0] }
terrain = { type = "dem", file = "dem.tif" }
material.rock = { law = "mohr_coulomb", youngs_modulus = 1.0e7, poisson_ratio = 0.2, friction_angle = 35.0, \
cohesion = 1.0e5 }
basal = { friction_angle = 10.0 }
maps = { cell = 10.0 }

[body.slide]
material = "rock"
shape = "release"
thickness = { raster = "thickness.tif" }
velocity = [5.0, 0.0, -3.0]
temperature = -1.0
porosity = 0.3
"""
    )
    return folder
