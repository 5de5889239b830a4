"""The program and a small case, for tests that compare the Python package with the command line."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))

CommandLine = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def interrupts() -> Iterator[None]:
    """Let SIGINT raise KeyboardInterrupt: a background process begins with the signal ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def command_line(tmp_path: Path) -> CommandLine:
    """Return a function that runs `thawslide` with arguments in an empty folder."""
    program = os.environ.get("THAWSLIDE_BINARY", str(ROOT / "build" / "release" / "thawslide"))

    def start(*arguments: object) -> subprocess.CompletedProcess[str]:
        command = [program, *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=120)

    return start


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Return the case file of a block that slides down a slope with band columns, 1 s in 200 steps."""
    folder = tmp_path / "slope"
    folder.mkdir()
    (folder / "profile.csv").write_text("distance_m,terrain_elevation_m\n0,100\n200,0\n")
    (folder / "case.toml").write_text(
        """[case]
title = "Block on a slope"

[time]
end = 1.0
step = 0.005
output_interval = 0.25
history_interval = 0.05

[grid]
cell = 5.0
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
friction = "constant"
friction_angle = 10.0

[band]
thickness = 0.1
"""
    )
    return folder / "case.toml"
