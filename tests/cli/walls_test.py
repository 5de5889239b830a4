"""On level cells, a block keeps its velocity until it reaches a wall, and a block behind a dyke rests."""

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program, datasets, history, sets, snapshot_files

WALLS = ROOT.parent / "shared" / "data" / "faults" / "p05-thin-wall"
FRONT, SPEED = 50.0, 20.0  # m, m/s
CELL = 5.0  # m
EARLY = 0.3 * CELL  # m
HALF_PARTICLE = CELL / 4.0  # m
FOOT = {"thick57.5": 57.5, "thick59": 59.0, "thick61": 61.0, "thin59": 59.0, "thin61": 61.0}  # m
RAMPS = {"ramp20": 20.0, "ramp30": 30.0, "ramp45": 45.0, "ramp60": 60.0, "ramp80": 80.0, "ramp89.99": 89.99}  # degrees
RAMP_FOOT = DYKE_FOOT = 59.0  # m
LEVEL = {"grid__follows_terrain": "false"}
FRICTIONAL = {"contact__between_bodies": "frictional", "contact__friction_angle": 0.0}

pytestmark = pytest.mark.skipif(not WALLS.is_dir(), reason=f"no folder {WALLS}")


def distance_at_loss(thawslide: Program, case: Path, run: Path, foot: float, **words: object) -> float:
    """Return the distance [m] to the foot of a wall at which 1 % of the velocity is lost; negative: beyond it."""
    end = (foot + CELL - FRONT) / SPEED
    thawslide.ok("run", case, "--output", run, *sets(time__end=end, terrain__extend="true", **LEVEL, **words))
    rows = history(run)
    has_changed = np.abs(rows["mean_velocity_m_s"] / SPEED - 1.0) > 0.01
    assert has_changed.any(), "the wall does not act"
    return float(foot - FRONT - SPEED * rows["time_s"][has_changed.argmax()])


@pytest.mark.parametrize("name", FOOT)
def test_velocity_is_constant_until_the_block_reaches_a_wall(thawslide: Program, tmp_path: Path, name: str) -> None:
    ahead = distance_at_loss(thawslide, WALLS / f"alone-{name}.toml", tmp_path / "run", FOOT[name])
    assert -HALF_PARTICLE <= ahead <= EARLY


@pytest.mark.parametrize("name", RAMPS)
def test_velocity_is_constant_until_the_block_reaches_a_ramp(thawslide: Program, tmp_path: Path, name: str) -> None:
    """On a gentle ramp, the block loses 1 % of its velocity only after some distance."""
    case, ramp = WALLS / "alone-ramp80.toml", WALLS / f"{name}.csv"
    ahead = distance_at_loss(thawslide, case, tmp_path / "run", RAMP_FOOT, terrain__file=ramp)
    assert ahead <= HALF_PARTICLE
    assert ahead >= (-HALF_PARTICLE if RAMPS[name] >= 45.0 else -CELL)


def places_and_speeds(thawslide: Program, case: Path, run: Path, **words: object) -> list[tuple[np.ndarray, ...]]:
    """Run a case; return x and the velocity along x of the particles of each body, for each snapshot."""
    thawslide.ok("run", case, "--output", run, *sets(time__output_interval=0.1, **LEVEL, **words))
    found: list[tuple[np.ndarray, ...]] = []
    for file in snapshot_files(run):
        data = datasets(file)
        x, speed = data["VTKHDF/Points"][:, 0], data["VTKHDF/PointData/velocity"][:, 0]
        # The bodies stay on their sides of the dyke.
        is_left = x < 0.5 * (DYKE_FOOT + 61.0)
        found.append((x[is_left], speed[is_left], x[~is_left], speed[~is_left]))
    assert len(found) > 40
    return found


def assert_right_body_rests(states: list[tuple[np.ndarray, ...]]) -> None:
    start = states[0][2]
    assert len(start) > 100
    for _, _, x, speed in states:
        assert x.size == start.size
        assert abs(x.mean() - start.mean()) < 0.005
        assert abs(speed.mean()) < 0.01


def test_block_behind_the_dyke_rests_alone(thawslide: Program, tmp_path: Path) -> None:
    assert_right_body_rests(places_and_speeds(thawslide, WALLS / "right-alone.toml", tmp_path / "run"))


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(FRICTIONAL, id="bodies in contact, cells of 5 m"),
        pytest.param({"grid__cell": 2.0, "time__step": 0.002}, id="bonded bodies, cells as wide as the dyke"),
    ],
)
def test_block_behind_a_dyke_rests_at_an_impact(thawslide: Program, tmp_path: Path, words: dict[str, object]) -> None:
    """On cells of 5 m, bonded bodies act on one another through this dyke of 2 m: docs/theory/contact.md, Bends."""
    states = places_and_speeds(thawslide, WALLS / "case.toml", tmp_path / "run", **words)
    assert_right_body_rests(states)
    reached = max(x.max() for x, _, _, _ in states)
    assert DYKE_FOOT - HALF_PARTICLE < reached < DYKE_FOOT, "the dyke stops the block that hits it"
    assert states[0][1].mean() == pytest.approx(SPEED)
    assert min(speed.mean() for _, speed, _, _ in states) < 0.0, "it rebounds"


def test_a_wall_thinner_than_a_cell_has_a_warning(thawslide: Program) -> None:
    """Bonded bodies push each other through a dyke of 2 m on cells of 5 m, and not on cells of 2 m."""
    warning = "the terrain has a wall thinner than a cell (5 m), 40 m high"
    assert warning in thawslide.ok("check", WALLS / "case.toml", *sets(**LEVEL))
    finer = sets(grid__cell=2, time__step=0.002, **LEVEL)
    assert "a wall thinner" not in thawslide.ok("check", WALLS / "case.toml", *finer)
