"""Scripts that run cases and write pages, shortened; `./run paper`; and `thawslide scarp`, whose release is a case."""

from __future__ import annotations

import math
import os
import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import LAMPLUGH, ROOT, Outcome, Program, Slope
from terrain_files import CELL, COLUMNS, ROWS, SOUTH, WEST, write_rectangle

COLUMNS_PAGE, ONE_AT_A_TIME = ROOT / "scripts" / "lamplugh-columns-page", LAMPLUGH / "one-at-a-time"
X, Y = WEST + 0.3 * COLUMNS * CELL, SOUTH + 0.5 * ROWS * CELL
SURFACES = {
    "plane": ["--plane", f"x={X},y={Y},dip=25,direction=90,depth=5"],
    "ellipsoid": ["--ellipsoid", f"x={X},y={Y},half_length=90,half_width=60,azimuth=90"],
    "slbl": ["--slbl"],
}
Script = Callable[..., Outcome]


@pytest.fixture
def script(thawslide: Program, report_environment: dict[str, str]) -> Script:
    """Return a function that runs a script of Python with arguments."""
    path = f"{ROOT}:{ROOT / 'python'}"
    environment = report_environment | {"PYTHONPATH": path, "HOME": os.environ.get("HOME", "")}
    return lambda *words: thawslide.finish([sys.executable, *words], env=environment)


def read_page(page: Path) -> str:
    """Return a page, whose lines outside tables are short."""
    text = page.read_text(encoding="utf-8")
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 120
    return text


def test_columns_page_shortened(script: Script, binary: Path, tmp_path: Path) -> None:
    """One second of three members and two variants."""
    page = tmp_path / "page" / "results.md"

    def call(*more: str) -> str:
        words = ("--quick", "--program", binary, "--page", page, "--output", tmp_path / "runs")
        done = script(COLUMNS_PAGE, *words, *more)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "4 runs, 0 of them complete" in call()
    text = read_page(page)
    assert "## 3 members" in text
    assert "| model | peak of the mean velocity [m/s] | 80 | 72 to 88 |" in text
    # A second of sliding is not enough for 8 m/s.
    assert "- from 8 m/s to the peak: no member has it (accepted: 28 to 42)" in text
    assert "| bound | maximum P over averaged N |  | at most 1 | 0.000 | 0.000 | 3 of 3 | yes |" in text
    assert "| `band.thickness=" in text and "not run" not in text
    assert "@" not in text and "{" not in text
    page.unlink()
    assert "runs," not in call("--draw-only")
    assert page.read_text(encoding="utf-8") == text


def test_one_at_a_time_shortened(script: Script, binary: Path, tmp_path: Path) -> None:
    """Half a second of a few rows of the table."""
    page = tmp_path / "page" / "assumptions.md"
    rows = ("--only", "case", "no-viscosity", "thick", "s-c100")
    words = ("--quick", "--program", binary, "--page", page, *rows, "--output", tmp_path / "runs")
    done = script(ONE_AT_A_TIME, *words)
    assert done.returncode == 0, done.stderr
    assert "min left: " in done.stdout
    text = read_page(page)
    lines = [line for line in text.splitlines() if line.startswith("| no viscosity |")]
    assert len(lines) == 1 and "`material.rock_ice.viscosity_time=0.0`" in lines[0] and "not run" not in lines[0]
    assert "| lubrication off | not run |" in text
    assert "[thick-body.toml](thick-body.toml)" in text
    for name in ("assumptions", "block", "deposit"):
        assert (page.parent / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("path", [COLUMNS_PAGE, ONE_AT_A_TIME], ids=lambda path: path.name)
def test_a_script_needs_the_program(script: Script, tmp_path: Path, path: Path) -> None:
    done = script(path, "--program", tmp_path / "none")
    assert done.returncode == 2
    assert "Build it with ./run --setup." in done.stderr


def test_paper_shortened(script: Script, binary: Path, tmp_path: Path) -> None:
    output = tmp_path / "paper"
    words = ("--quick", "--program", binary, "--cases", ROOT / "cases", "--output", output)
    done = script("-m", "reproduction", *words)
    assert done.returncode == 0, done.stderr
    page = (output / "report.html").read_text(encoding="utf-8")
    links = re.findall(r'<img src="([^"]+)"', page)
    assert len(links) == 15
    assert all((output / link).read_bytes().startswith(b"\x89PNG") for link in links)
    assert "Shortened runs" in page
    assert len(re.findall(r"<td><b>(?:true|false|undetermined)</b></td>", page)) > 50
    rows = dict(line.split(",") for line in (output / "measures.csv").read_text().splitlines()[1:])
    # After 864 s the fronts are in the first cell; without latent heat, cooling has passed through several cells.
    assert float(rows["freezing_m050_no_latent_rms_error"]) < 0.01
    # The published update creates heat spuriously as soon as the bar freezes.
    assert float(rows["freezing_m100_printed_heat"]) > 1.0
    # The block starts with its frozen band at the pressure of ice, rho_I g H.
    assert math.isclose(float(rows["block_e050_pressure_start"]), 917 * 9.81 * 50 / 1e3, rel_tol=1e-3)


def test_paper_reports_a_program_without_results(script: Script, tmp_path: Path) -> None:
    done = script("-m", "reproduction", "--program", "false", "--cases", tmp_path, "--output", tmp_path / "paper")
    assert done.returncode == 2
    assert "./run paper: error: " in done.stderr


@pytest.mark.parametrize("surface", SURFACES)
def test_release_of_a_volume_makes_a_valid_case(surface: str, thawslide: Program, script: Script, slope: Slope) -> None:
    folder = slope.folder / "case"
    outline = write_rectangle(slope.folder / "outline.geojson", X - 90.0, Y - 60.0, 180.0, 120.0)
    words = [slope(), *SURFACES[surface], "--within", outline, "--volume", 250000]
    done = script("-m", "thawslide.scarps.command", *words, "--output", slope.folder / "scarp.tif")
    assert done.returncode == 0, done.stderr
    command = done.stdout.splitlines()[-1].removeprefix("To continue: thawslide ").replace("FOLDER", str(folder))
    (volume,) = re.findall(r"a release of ([\d,]+) m3", thawslide.ok(*command.split()))
    assert float(volume.replace(",", "")) == pytest.approx(250_000.0, rel=2e-3)
    assert tomllib.loads((folder / "case.toml").read_text())["body"]["slide"]["placement"] == "cut"
    assert thawslide.json("check", folder)
