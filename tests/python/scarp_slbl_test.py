"""Sloping local base level against discrete closed forms, the published iteration, and given depths and volumes."""

from pathlib import Path

import numpy as np
import pytest
from scarp_files import rectangle, write_dem, write_outline

import thawslide
from thawslide.arrays import Numbers
from thawslide.scarps import Slbl

SIZE = 2200.0  # m, of the DEMs; cells of 10 m


def tilted(x: Numbers, y: Numbers) -> Numbers:
    """Return a plane, which has no effect on the depth."""
    return 2000.0 - 0.7 * x + 0.3 * y


def rough(x: Numbers, y: Numbers) -> Numbers:
    noise = np.random.default_rng(5).normal(size=x.shape)
    return 2000.0 - 0.7 * x + 20.0 * np.sin(x / 25.0) * np.cos(y / 30.0) + noise


def depth_in(tmp_path: Path, columns: int, rows: int, surface: Slbl, **dem: object) -> Numbers:
    """Return the depth in an outline of so many cells, shape (rows, columns)."""
    shape = dem.pop("shape", tilted)
    cell_y = float(dem.get("cell_y") or 10.0)  # type: ignore[arg-type]
    path = write_dem(tmp_path / "dem.tif", shape, 10.0, SIZE, **dem)  # type: ignore[arg-type]
    corner = rectangle((0.0, 10.0 * columns), (0.0, cell_y * rows), SIZE)
    release = thawslide.scarp(path, surface, within=write_outline(tmp_path / "within.geojson", corner))
    top, left = round(SIZE / 2 / cell_y) - rows, round(SIZE / 20)
    depth: Numbers = release.thickness[top : top + rows, left : left + columns]
    assert release.volume == pytest.approx(depth.sum() * 10.0 * cell_y)
    return depth


def test_rows_of_cells_and_long_strips_have_closed_forms(tmp_path: Path) -> None:
    # 4 d_i - d_(i-1) - d_(i+1) = 4 C, with d = 0 at the ends, has the solution
    # d_i = 2 C [1 - cosh(k (i - n/2)) / cosh(k n/2)], cosh k = 2.
    depth = depth_in(tmp_path, 19, 1, Slbl(tolerance=1.5))
    k, i = np.arccosh(2.0), np.arange(1, 20)
    assert depth[0] == pytest.approx(3.0 * (1.0 - np.cosh(k * (i - 10.0)) / np.cosh(k * 10.0)), abs=1e-6)
    # 4 C = -(d_(i-1) - 2 d_i + d_(i+1)): d_i = 2 C i (n - i), far from the ends of the strip
    depth, i = depth_in(tmp_path, 9, 101, Slbl(tolerance=0.2)), np.arange(1, 10)
    assert depth[50] == pytest.approx(0.4 * i * (10.0 - i), rel=1e-6)
    # The neighbours along x have the weight 20^2 / (2 (10^2 + 20^2)) = 0.4 each.
    depth = depth_in(tmp_path, 9, 51, Slbl(tolerance=0.2), cell_y=20.0)
    i = np.arange(1, 10)
    assert depth[25] == pytest.approx(0.2 / (2.0 * 0.4) * i * (10.0 - i), rel=1e-6)


def test_rectangle_has_the_depth_of_the_sine_series(tmp_path: Path) -> None:
    rows, columns, tolerance = 12, 17, 0.8
    depth = depth_in(tmp_path, columns, rows, Slbl(tolerance=tolerance))
    modes = [np.sin(np.pi * np.outer(np.arange(1, n + 1), np.arange(1, n + 1)) / (n + 1)) for n in (rows, columns)]
    across, along = (np.cos(np.pi * np.arange(1, n + 1) / (n + 1)) for n in (rows, columns))
    source = modes[0] @ np.full((rows, columns), tolerance) @ modes[1] * 4.0 / ((rows + 1) * (columns + 1))
    exact = modes[0] @ (source / (1.0 - 0.5 * (across[:, None] + along[None, :]))) @ modes[1]
    assert depth == pytest.approx(exact, abs=1e-6)


def test_gully_is_lowered_by_the_tolerance_beyond_its_curvature(tmp_path: Path) -> None:
    # The mean of the neighbours in z = x^2 / 1000 m is 100 m2 / (2 x 1000 m) = 0.05 m above z.
    plane = depth_in(tmp_path, 20, 15, Slbl(tolerance=0.15))
    gully = depth_in(tmp_path, 20, 15, Slbl(tolerance=0.2), shape=lambda x, y: tilted(x, y) + x**2 / 1000.0)
    assert gully == pytest.approx(plane, abs=1e-6)


@pytest.mark.parametrize("tolerance", [0.0, 0.3, 3.0])
def test_rough_slope_has_the_depth_of_the_published_iteration(tmp_path: Path, tolerance: float) -> None:
    depth = depth_in(tmp_path, 14, 11, Slbl(tolerance=tolerance), shape=rough)
    x, y = np.meshgrid(10.0 * (np.arange(220) + 0.5) - 1100.0, 1100.0 - 10.0 * (np.arange(220) + 0.5))
    heights = rough(x, y)[110 - 12 : 110 + 1, 110 - 1 : 110 + 15]
    lowered = heights.copy()
    for _ in range(3000):
        mean = 0.25 * (lowered[1:-1, :-2] + lowered[1:-1, 2:] + lowered[:-2, 1:-1] + lowered[2:, 1:-1])
        lowered[1:-1, 1:-1] = np.minimum(lowered[1:-1, 1:-1], mean - tolerance)
    expected = (heights - lowered)[1:-1, 1:-1]
    assert depth == pytest.approx(np.where(expected >= 0.001, expected, 0.0), abs=2e-6)
    assert tolerance > 1.0 or (depth == 0.0).any()


def test_maximum_depth_and_volume_are_reached(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", rough, 10.0, SIZE)
    within = write_outline(tmp_path / "within.geojson", rectangle((-250.0, 250.0), (-150.0, 150.0), SIZE))
    deep = thawslide.scarp(dem, Slbl(max_depth=60.0), within=within)
    assert deep.max_thickness == pytest.approx(60.0, rel=1e-6)
    large = thawslide.scarp(dem, Slbl(), within=within, volume=4e6)
    assert large.volume == pytest.approx(4e6, rel=1e-3) and isinstance(large.surface, Slbl)
    again = thawslide.scarp(dem, Slbl(tolerance=large.surface.tolerance), within=within)
    assert again.thickness == pytest.approx(large.thickness, abs=1e-5)
