"""Wedge factor and apparent friction of the comparison: exact on planes, in V channels and on a circle."""

import math

import numpy as np
import pytest

from reproduction.studies import wedge
from thawslide.maps import Grid, Map

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
    assert load == pytest.approx(len(x) * 9.81 * 40.0, rel=1e-3)
    assert wedged == pytest.approx(load, rel=1e-12)


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
