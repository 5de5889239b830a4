"""Comparison with AvaFrame: terrains, and results from maps."""

import math
import struct
from pathlib import Path

import numpy as np
import pytest

from reproduction.studies import avaframe, grounds, results
from thawslide.errors import ReportError
from thawslide.maps import Grid, Map, read_map

SLOPE = math.tan(math.radians(30.0))


def test_terrains_have_the_specified_values_without_a_kink(tmp_path: Path) -> None:
    slope = np.diff(grounds.plane_profile(np.arange(0.0, 2_600.0, 0.5))) / 0.5
    assert (slope[:1_699], slope[2_300:]) == (pytest.approx(-SLOPE, abs=1e-9), pytest.approx(0.0, abs=1e-9))
    assert np.abs(np.diff(slope)).max() == pytest.approx(SLOPE * 0.5 / 300.0, rel=1e-6)
    for ground, place, height in [
        (grounds.PLANE, (400_302.5, 400_502.5), SLOPE * (1_000.0 - 302.5)),
        (grounds.BOWL, (400_302.5, 400_902.5), (597.5**2 + 2.5**2) / 2_000.0),
    ]:
        grounds.write_ground(ground, tmp_path / ground.name, tmp_path)
        terrain = read_map(tmp_path / ground.name / "dem.tif")
        assert terrain.at(*(np.array([each]) for each in place))[0] == pytest.approx(height, abs=1e-9)
        assert "EPSG:31287" in terrain.crs


def shapefile(kind: int, parts: list[int], points: list[tuple[float, float]]) -> bytes:
    """Return a shapefile of one shape; the reader looks at nothing but that."""
    content = struct.pack("<i4d2i", kind, 0, 0, 0, 0, len(parts), len(points)) + struct.pack(f"<{len(parts)}i", *parts)
    return bytes(108) + content + b"".join(struct.pack("<2d", *point) for point in points)


def test_first_ring_of_a_shapefile_is_read(tmp_path: Path) -> None:
    outer, hole = [(0.0, 0.0), (0.0, 9.0), (9.0, 0.0), (0.0, 0.0)], [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (1.0, 1.0)]
    file = tmp_path / "release.shp"
    file.write_bytes(shapefile(5, [0], outer))
    assert grounds.first_polygon(file) == [list(point) for point in outer]
    file.write_bytes(shapefile(5, [0, 4], outer + hole))
    assert grounds.first_polygon(file) == [list(point) for point in outer]
    file.write_bytes(shapefile(3, [0], outer))
    with pytest.raises(ReportError, match="of kind 3; a polygon is required"):
        grounds.first_polygon(file)


def dem(profile: np.ndarray) -> Map:
    """Return a DEM of 5 m whose sections along x are all this profile [m]."""
    return Map(Grid(0.0, 0.0, 5.0, 5.0, len(profile), 41), np.tile(profile, (41, 1)))


def square(x: float) -> list[list[float]]:
    return [[x - 19.0, 81.0], [x + 19.0, 81.0], [x + 19.0, 119.0], [x - 19.0, 119.0], [x - 19.0, 81.0]]


def test_point_mass_follows_the_energy_line_and_must_stop() -> None:
    x = 5.0 * np.arange(400)
    friction = 0.3
    # On a V of slopes 0.5, its single bend dissipates energy too: the fraction exp(-2 friction turn) remains.
    found = results.point_mass(dem(0.5 * np.abs(x - 1_000.0)), square(500.0), friction)
    head = (0.5 - friction) * 500.0
    assert found.max_speed == pytest.approx(math.sqrt(2.0 * 9.81 * head), rel=0.02)
    left = head * math.exp(-2.0 * friction * 2.0 * math.atan(0.5))
    assert found.travel == pytest.approx(500.0 + left / (0.5 + friction), rel=0.02)
    with pytest.raises(ReportError, match="the point mass leaves the DEM"):
        results.point_mass(dem(-0.5 * x), square(500.0), 0.3)


def test_numbers_of_a_known_outcome_are_exact() -> None:
    x = 5.0 * np.arange(400)
    terrain = dem(-0.5 * x)
    thickness, final = np.full(terrain.values.shape, np.nan), np.full(terrain.values.shape, np.nan)
    speed = np.full(terrain.values.shape, np.nan)
    thickness[18:23, 96:201] = 2.0
    thickness[20, 201:210] = 0.4  # thinner than the threshold of the area reached
    speed[18:23, 96:201] = 10.0
    speed[20, 150], speed[20, 205] = 30.0, 99.0
    final[18:23, 190:201] = 3.0
    maps = (Map(terrain.grid, each) for each in (thickness, speed, final))
    outcome = results.Outcome("X", *maps, 0.0, 1.0)
    found = results.numbers(outcome, terrain, square(502.5))
    assert (found.area, found.max_speed) == (25.0 * 5 * 105, 30.0)
    assert found.max_thickness == 2.0
    # From the top of the release, x = 485, its first row at y = 85, to the farthest corner of the area reached.
    assert found.travel == pytest.approx(math.hypot(1_000.0 - 485.0, 110.0 - 85.0))
    assert found.reach_angle == pytest.approx(math.degrees(math.atan2(0.5 * (1_000.0 - 485.0), found.travel)))
    assert found.centre_displacement == pytest.approx(975.0 - 502.5, abs=1e-9)


def test_coarser_map_covers_the_cells_of_the_terrain_in_blocks() -> None:
    terrain = Map(Grid(2.5, 2.5, 5.0, 5.0, 7, 5), np.zeros((5, 7)))
    coarse = Map(Grid(15.0, 5.0, 10.0, 10.0, 2, 3), np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]))
    placed = results.on_grid(coarse, terrain).values
    assert np.isnan(placed[:, :2]).all() and np.isnan(placed[:, 6]).all()
    assert placed[:, 2:6].tolist() == [
        [1.0, 1.0, 2.0, 2.0], [1.0, 1.0, 2.0, 2.0], [3.0, 3.0, 4.0, 4.0], [3.0, 3.0, 4.0, 4.0], [5.0, 5.0, 6.0, 6.0],
    ]  # fmt: skip
    same = Map(Grid(7.5, 2.5, 5.0, 5.0, 2, 2), np.array([[1.0, 2.0], [3.0, 4.0]]))
    assert results.on_grid(same, terrain).values[:2, 1:3].tolist() == [[1.0, 2.0], [3.0, 4.0]]


def test_the_maps_of_a_figure_have_one_scale() -> None:
    grid = Grid(0.0, 0.0, 10.0, 10.0, 40, 30)
    terrain = Map(grid, np.add.outer(np.linspace(0.0, 100.0, 30), np.zeros(40)), "EPSG:31287")
    thickness = [np.zeros((30, 40)), np.zeros((30, 40))]
    thickness[0][5:20, 5:20], thickness[1][5:20, 10:25] = 3.0, 8.0
    found = [
        results.Outcome(name, Map(grid, values), Map(grid, 2.0 * values), Map(grid, values), 0.0, 1.0)
        for name, values in zip(("A 1", "B 2, no viscosity"), thickness, strict=True)
    ]
    corners = [[50.0, 50.0], [90.0, 50.0], [90.0, 90.0], [50.0, 50.0]]
    for field, factor in (("thickness", 1.0), ("speed", 2.0)):
        figure = avaframe.comparison_figure(grounds.PLANE, terrain, corners, found, field, "words")
        maps = [axes for axes in figure.axes if len(axes.images) > 1]
        assert [axes.get_title(loc="left") for axes in maps] == ["(a) A", "(b) B, no viscosity"]
        for axes, values in zip(maps, thickness, strict=True):
            shown = axes.images[-1].get_array()
            np.testing.assert_array_equal(~np.ma.getmaskarray(shown), values > 0.0)
            np.testing.assert_allclose(shown[values > 0.0], factor * values[values > 0.0])
        assert maps[0].images[-1].norm is maps[1].images[-1].norm
