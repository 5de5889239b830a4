"""A small case for sweeps."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def with_program(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a sweep find the program that the tests use."""
    program = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    if not program.is_file():
        pytest.skip(f"program not found: {program}. Build it, or set THAWSLIDE_BINARY.")
    monkeypatch.setenv("THAWSLIDE_PROGRAM", str(program))


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Return the case file of a block that slides down a slope, 0.5 s in 100 steps."""
    folder = tmp_path / "slope"
    folder.mkdir()
    (folder / "profile.csv").write_text("distance_m,terrain_elevation_m\n0,100\n200,0\n")
    (folder / "case.toml").write_text(
        """[time]
end = 0.5
step = 0.005
output_interval = 0.25
history_interval = 0.05

[grid]
cell = 10.0
min = [0.0, -20.0]
max = [200.0, 140.0]

[terrain]
type = "profile"
file = "profile.csv"

[material.rock]
law = "mohr_coulomb"
youngs_modulus = 1.0e8
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 1.0e5

[body.block]
material = "rock"
shape = "polygon"
vertices = [[40.0, 80.0], [80.0, 60.0], [80.0, 80.0], [40.0, 100.0]]
temperature = -1.0
porosity = 0.3

[basal]
friction_angle = 10.0

[band]
thickness = 0.1
"""
    )
    return folder / "case.toml"
