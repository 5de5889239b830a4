"""A block that slides without friction into walls keeps its velocity until it arrives (issue data p05)."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from conftest import ROOT, Program, sets

WALLS = ROOT.parent / "shared" / "data" / "faults" / "p05-thin-wall"
FRONT, SPEED = 50.0, 20.0  # m, m/s
EARLY = 1.5  # m: 0.3 cells
FOOT = {
    "thick57.5": 57.5,
    "thick59": 59.0,
    "thick61": 61.0,
    "thin59": 59.0,
    "thin61": 61.0,
    "ramp80": 59.0,
}  # m


@pytest.mark.parametrize("name", FOOT)
def test_velocity_is_kept_until_the_block_arrives(thawslide: Program, tmp_path: Path, name: str) -> None:
    if not WALLS.is_dir():
        pytest.skip(f"there is no {WALLS}")
    run = tmp_path / "run"
    arrival = (FOOT[name] - EARLY - FRONT) / SPEED
    done = thawslide(
        "run", WALLS / f"alone-{name}.toml", "--output", run, *sets(time__end=arrival, terrain__extend="true")
    )
    assert done.returncode == 0, done.stderr
    with (run / "history.csv").open() as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["time_s"]) == pytest.approx(arrival, abs=0.004)
    assert float(last["mean_velocity_m_s"]) == pytest.approx(SPEED, rel=0.01)
