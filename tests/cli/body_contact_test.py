"""Two bodies that meet, and two that separate: start of their contact, and conserved momentum."""

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program, datasets, sets, snapshot_files

DATA = ROOT.parent / "shared" / "data" / "faults" / "p09-two-bodies-meet"
CELL = 5.0  # m
SPACING = CELL / 2.0  # m, of particles
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason=f"no folder {DATA}")
FRICTIONAL = {"contact__between_bodies": "frictional", "contact__friction_angle": 0.0}


def motions(run: Path) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Return for each snapshot the gap between the two bodies, their velocities along x and their masses."""
    found = []
    for file in snapshot_files(run):
        data = datasets(file)
        body, mass = data["VTKHDF/PointData/body"], data["VTKHDF/PointData/mass"]
        speed, place = (data["VTKHDF/PointData/velocity"][:, 0], data["VTKHDF/Points"][:, 0])
        masses = np.array([mass[body == number].sum() for number in (0, 1)])
        speeds = np.array([np.average(speed[body == number], weights=mass[body == number]) for number in (0, 1)])
        found.append((place[body == 1].min() - place[body == 0].max() - SPACING, speeds, masses))
    return found


def run_case(thawslide: Program, case: Path, run: Path, **words: object) -> list[tuple[float, np.ndarray, np.ndarray]]:
    thawslide.ok("run", case, "--output", run, *sets(time__output_interval=0.1, **words))
    return motions(run)


@pytest.mark.parametrize("name", ["case", "meet-mc"])
def test_bodies_meet_once_the_gap_is_closed(thawslide: Program, tmp_path: Path, name: str) -> None:
    states = run_case(thawslide, DATA / f"{name}.toml", tmp_path / "run", **FRICTIONAL)
    momentum = (states[0][1] * states[0][2]).sum()
    have_met = False
    for gap, speeds, masses in states:
        assert (speeds * masses).sum() == pytest.approx(momentum, rel=1e-9)
        have_met = have_met or gap < SPACING
        assert have_met or abs(speeds[1]) < 1e-6
    assert states[-1][1][1] > 3.0


@pytest.mark.parametrize("name", ["apart", "apart-mc"])
def test_bodies_separate_without_drag(thawslide: Program, tmp_path: Path, name: str) -> None:
    for _, speeds, _ in run_case(thawslide, DATA / f"{name}.toml", tmp_path / "run", **FRICTIONAL):
        assert speeds == pytest.approx([0.0, 2.0], abs=1e-6)


def test_a_gap_between_bonded_bodies_has_a_warning(thawslide: Program, tmp_path: Path) -> None:
    reported = "body.b stands apart from body.a, and contact.between_bodies is"
    assert reported in thawslide.ok("check", DATA / "case.toml")
    short = thawslide("run", DATA / "case.toml", "--output", tmp_path / "run", *sets(time__end=0.02))
    assert reported in short.stdout
