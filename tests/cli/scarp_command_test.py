"""A release from `thawslide scarp` becomes a valid case."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from conftest import ROOT, Program
from slope_files import CELL, COLUMNS, ROWS, SOUTH, WEST, Slope, write_release

X, Y = WEST + 0.3 * COLUMNS * CELL, SOUTH + 0.5 * ROWS * CELL
SURFACES = {
    "plane": ["--plane", f"x={X},y={Y},dip=25,direction=90,depth=5"],
    "ellipsoid": ["--ellipsoid", f"x={X},y={Y},half_length=90,half_width=60,azimuth=90"],
    "slbl": ["--slbl"],
}


@pytest.mark.parametrize("surface", SURFACES)
def test_release_of_a_volume_makes_a_valid_case(surface: str, thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    dem, raster, folder = slope(), tmp_path / "scarp.tif", tmp_path / "case"
    outline = tmp_path / "outline.geojson"
    write_release(outline, X - 90.0, Y - 60.0, 180.0, 120.0)
    command = [sys.executable, "-m", "thawslide.scarps.command", dem, *SURFACES[surface], "--within", outline]
    done = subprocess.run(
        [*command, "--volume", "250000", "--output", raster],
        capture_output=True, text=True, check=False, cwd=ROOT / "python", timeout=60.0,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    words = done.stdout.splitlines()[-1].removeprefix("To continue: thawslide ").replace("FOLDER", str(folder)).split()
    made = thawslide(*words)
    assert made.returncode == 0, made.stderr
    (volume,) = re.findall(r"a release of ([\d,]+) m3", made.stdout)
    assert float(volume.replace(",", "")) == pytest.approx(250_000.0, rel=2e-3)
    assert tomllib.loads((folder / "case.toml").read_text())["body"]["slide"]["placement"] == "cut"
    checked = thawslide("check", folder, "--json")
    assert checked.returncode == 0, checked.stderr
    assert json.loads(checked.stdout)
