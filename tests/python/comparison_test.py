"""Comparison with AvaFrame: terrains, results from maps, wedge factor and apparent friction."""

import math
import struct
from pathlib import Path

import numpy as np
import pytest

from reproduction.studies import grounds, results, wedge
from thawslide import ReportError
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
    terrain = dem(-2.5 * np.arange(400))
    thickness, speed, final = np.full((3, *terrain.values.shape), np.nan)
    thickness[18:23, 96:201] = 2.0
    thickness[20, 201:210] = 0.4  # thinner than the threshold of the area reached
    speed[18:23, 96:201] = 10.0
    speed[20, 150], speed[20, 205] = 30.0, 99.0
    final[18:23, 190:201] = 3.0
    maps = (Map(terrain.grid, each) for each in (thickness, speed, final))
    found = results.numbers(results.Outcome("X", *maps, 0.0, 1.0), terrain, square(502.5))
    assert (found.area, found.max_speed, found.max_thickness) == (25.0 * 5 * 105, 30.0, 2.0)
    # From the top of the release, x = 485, its first row at y = 85, to the farthest corner of the area reached.
    assert found.travel == pytest.approx(math.hypot(1_000.0 - 485.0, 110.0 - 85.0))
    assert found.reach_angle == pytest.approx(math.degrees(math.atan2(0.5 * (1_000.0 - 485.0), found.travel)))
    assert found.centre_displacement == pytest.approx(975.0 - 502.5, abs=1e-9)


def test_coarser_map_covers_the_cells_of_the_terrain_in_blocks() -> None:
    terrain = Map(Grid(2.5, 2.5, 5.0, 5.0, 7, 5), np.zeros((5, 7)))
    coarse = Map(Grid(15.0, 5.0, 10.0, 10.0, 2, 3), np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]))
    placed = results.on_grid(coarse, terrain).values
    assert np.isnan(placed[:, [0, 1, 6]]).all()
    np.testing.assert_array_equal(placed[:, 2:6], np.repeat(np.repeat(coarse.values, 2, axis=0), 2, axis=1)[:5])
    same = Map(Grid(7.5, 2.5, 5.0, 5.0, 2, 2), np.array([[1.0, 2.0], [3.0, 4.0]]))
    assert results.on_grid(same, terrain).values[:2, 1:3].tolist() == [[1.0, 2.0], [3.0, 4.0]]


GRID = Grid(-200.0, -200.0, 5.0, 5.0, 81, 81)
X, Y = np.meshgrid(GRID.x, GRID.y)


def turned(direction: float) -> tuple[np.ndarray, np.ndarray]:
    """Return distances along a horizontal direction [degrees] and across it, on the grid."""
    c, s = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    return c * X + s * Y, -s * X + c * Y


def one_particle(x: float, y: float, direction: float, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points, velocities (their horizontal part) and masses of a single particle."""
    c, s = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    return np.array([[x, y, 0.0]]), np.array([[speed * c, speed * s, 0.0]]), np.array([7.0])


@pytest.mark.parametrize("direction", [0.0, 22.5, 45.0, 130.0])
@pytest.mark.parametrize("motion", [0.0, 60.0, 90.0])
def test_wedge_factor_on_a_plane_depends_on_the_angle_to_the_fall_line(direction: float, motion: float) -> None:
    along, _ = turned(direction)
    slope = 0.7
    ground = wedge.derivatives(Map(GRID, -slope * along))
    load, wedged = wedge.rates(ground, *one_particle(3.0, 4.0, direction + motion, 2.0))
    s = slope * math.cos(math.radians(motion))
    assert wedged / load == pytest.approx(math.sqrt((1.0 + slope**2) / (1.0 + s**2)), rel=1e-12)
    # Weight across the ground times the speed along it is weight times the horizontal speed.
    assert load == pytest.approx(7.0 * 9.81 * 2.0, rel=1e-12)


@pytest.mark.parametrize("opening", [60.0, 90.0, 120.0])
@pytest.mark.parametrize("slope", [0.0, 20.0, 35.0])
@pytest.mark.parametrize("direction", [0.0, 30.0, 90.0])
def test_wedge_factor_in_a_v_channel_is_exact(opening: float, slope: float, direction: float) -> None:
    along, across = turned(direction)
    half, fall = math.radians(0.5 * opening), math.radians(slope)
    # Walls of a channel that falls: half the opening is measured across the thalweg.
    height = -math.tan(fall) * along + np.abs(across) / (math.tan(half) * math.cos(fall))
    ground = wedge.derivatives(Map(GRID, height))
    place = (30.0 * -math.sin(math.radians(direction)), 30.0 * math.cos(math.radians(direction)))
    load, wedged = wedge.rates(ground, *one_particle(*place, direction, 10.0))
    assert wedged / load == pytest.approx(1.0 / math.sin(half), rel=1e-9)


def test_curved_terrain_adds_the_centrifugal_force_and_bumps_cancel() -> None:
    radius, speed = 1_000.0, 20.0
    ground = wedge.derivatives(Map(GRID, radius - np.sqrt(radius**2 - X**2)))
    x = 100.0
    cosine = math.sqrt(1.0 - (x / radius) ** 2)
    load, wedged = wedge.rates(ground, *one_particle(x, 0.0, 0.0, speed * cosine))
    assert load == pytest.approx(7.0 * speed * (9.81 * cosine + speed**2 / radius), rel=1e-4)
    assert wedged == pytest.approx(load, rel=1e-12)
    # Bumps along the motion, an integer number of waves below evenly spaced particles.
    ground = wedge.derivatives(Map(GRID, 0.2 * np.sin(2.0 * math.pi * X / 40.0)))
    x = np.arange(-80.0, 80.0, 5.0)
    points = np.column_stack([x, np.zeros_like(x), np.zeros_like(x)])
    velocity = np.column_stack([np.full_like(x, 40.0), np.zeros_like(x), np.zeros_like(x)])
    load, wedged = wedge.rates(ground, points, velocity, np.ones_like(x))
    assert load == pytest.approx(len(x) * 9.81 * 40.0, rel=1e-3) and wedged == pytest.approx(load, rel=1e-12)


class FakeSnapshot(dict[str, np.ndarray]):
    """Points and fields at one time."""

    def __init__(self, time: float, points: np.ndarray, fields: dict[str, np.ndarray]) -> None:
        super().__init__(fields)
        self.time, self.points = time, points


class FakeRun:
    """A particle that slides down a plane of slope 0.5 with friction 0.3: a snapshot each second, two rows."""

    def __init__(self) -> None:
        self.snapshot_files = list(range(5))
        time = np.arange(0.0, 4.01, 0.5)
        self.speed = 3.0  # m/s, horizontal
        lost = 0.3 * 7.0 * 9.81 * self.speed * time
        self.series = {
            "time_s": time, "friction_work_J": 0.9 * lost, "contact_loss_J": 0.1 * lost, "plastic_J": 0.2 * lost,
            "viscous_J": 0.05 * lost,
        }  # fmt: skip

    def snapshot(self, index: int, fields: tuple[str, ...]) -> FakeSnapshot:
        """Return the particle at a whole second."""
        points, velocity, mass = one_particle(self.speed * index, 0.0, 0.0, self.speed)
        return FakeSnapshot(float(index), points, {"velocity": velocity, "mass": mass})


def test_apparent_friction_is_the_energy_lost_over_the_load_path() -> None:
    found = wedge.intervals(FakeRun(), Map(GRID, -0.5 * X), 0.2, 2.0)  # type: ignore[arg-type]
    assert [(each.start, each.end) for each in found] == [(0.0, 2.0), (2.0, 4.0)]
    for each in found:
        assert each.wedge == pytest.approx(1.0, abs=1e-12)
        assert each.ground == pytest.approx(0.3 / 0.2, rel=1e-12)
        assert each.inside == pytest.approx(0.25 * 0.3 / 0.2, rel=1e-12)
