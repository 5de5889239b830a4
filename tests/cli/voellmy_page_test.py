"""The case of the page for users of RAMMS and AvaFrame: it is valid, and runs as a block and as a simulation."""

import math
import re
from pathlib import Path

import pytest
from conftest import ROOT, Program, Ran, columns_of, history
from terrain_files import SOUTH, WEST, write_rectangle, write_slope

PAGE = ROOT / "docs" / "coming-from-ramms-avaframe.md"


@pytest.fixture
def case(thawslide: Program, tmp_path: Path) -> Path:
    text, _ = re.findall(r"^ *```toml\n(.*?)^ *```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    write_slope(tmp_path / "dem.tif")
    write_rectangle(tmp_path / "release.geojson", WEST + 50.0, SOUTH + 250.0)
    folder = tmp_path / "my-slide"
    inputs = ["--dem", tmp_path / "dem.tif", "--release", tmp_path / "release.geojson"]
    thawslide.ok("new", folder, *inputs, "--thickness", 20)
    path = folder / "voellmy.toml"
    path.write_text(text)
    return path


def test_page_case_is_valid(thawslide: Program, case: Path) -> None:
    outcome = thawslide("check", case)
    assert outcome.returncode == 0, outcome.stderr
    assert "friction_coefficient" not in outcome.stdout + outcome.stderr, "no warning about its friction"


def test_page_case_as_block_stays_below_its_terminal_velocity(thawslide: Program, case: Path, tmp_path: Path) -> None:
    """On 30 degrees the release, 20 m along the vertical, cannot exceed sqrt(xi h cos (sin - mu cos))."""
    fastest = {}
    for turbulence in ("500", "100"):
        rows = tmp_path / f"block-{turbulence}.csv"
        words = ["--set", f"basal.turbulent_friction={turbulence}", "--output", rows]
        thawslide.ok("block", case, *words)
        fastest[turbulence] = columns_of(rows)["velocity_m_s"].max()
        angle = math.radians(30.0)
        terminal = math.sqrt(float(turbulence) * 20.0 * math.cos(angle) * (math.sin(angle) - 0.15 * math.cos(angle)))
        assert 0.5 * terminal < fastest[turbulence] < 1.02 * terminal
    assert fastest["100"] < fastest["500"]


def test_page_case_runs(ran: Ran, case: Path) -> None:
    words = ["--set", "time.end=2.0", "--threads", "1"]
    run = ran(*words, case=case)
    assert history(run)["mean_velocity_m_s"][-1] > 1.0
    assert "turbulent_friction = 500.0  # m/s2" in (run / "case.toml").read_text()
