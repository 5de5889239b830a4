"""The case of the page for users of RAMMS and AvaFrame: it is valid, and runs as a block and as a simulation."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path

import pytest
from conftest import ROOT, Program
from slope_files import SOUTH, WEST, write_release, write_slope

PAGE = ROOT / "docs" / "coming-from-ramms-avaframe.md"


@pytest.fixture
def case(tmp_path: Path) -> Path:
    """Write the page's case next to the files that it names: a slope of 30 degrees and a release on it."""
    text, _ = re.findall(r"^```toml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    write_slope(tmp_path / "dem.tif")
    write_release(tmp_path / "release.geojson", WEST + 50.0, SOUTH + 250.0)
    path = tmp_path / "case.toml"
    path.write_text(text)
    return path


def test_page_case_is_valid(thawslide: Program, case: Path) -> None:
    outcome = thawslide("check", case)
    assert outcome.returncode == 0, outcome.stderr
    assert "friction_coefficient" not in outcome.stdout + outcome.stderr, "no warning about its friction"


def test_page_case_as_block_stays_below_its_terminal_velocity(thawslide: Program, case: Path, tmp_path: Path) -> None:
    """On 30 degrees the release, 20 m along the normal, cannot exceed sqrt(xi h (sin - mu cos))."""
    fastest = {}
    for turbulence in ("500", "100"):
        rows = tmp_path / f"block-{turbulence}.csv"
        words = ["--set", f"basal.turbulent_friction={turbulence}", "--output", rows]
        outcome = thawslide("block", case, *words)
        assert outcome.returncode == 0, outcome.stderr
        with rows.open() as file:
            fastest[turbulence] = max(float(row["velocity_m_s"]) for row in csv.DictReader(file))
        angle = math.radians(30.0)
        terminal = math.sqrt(float(turbulence) * 20.0 * (math.sin(angle) - 0.15 * math.cos(angle)))
        assert 0.5 * terminal < fastest[turbulence] < 1.02 * terminal
    assert fastest["100"] < fastest["500"]


def test_page_case_runs(thawslide: Program, case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = ["--set", "time.end=2.0", "--threads", "1"]
    outcome = thawslide("run", case, "--output", run, *words)
    assert outcome.returncode == 0, outcome.stderr
    header, *_, last = (run / "history.csv").read_text().splitlines()
    assert float(last.split(",")[header.split(",").index("mean_velocity_m_s")]) > 1.0
    assert "turbulent_friction = 500.0  # m/s2" in (run / "case.toml").read_text()
