"""`thawslide scarp`, whose release is a case."""

import re
import sys
import tomllib

import pytest
from conftest import ROOT, Program, Slope
from terrain_files import CELL, COLUMNS, ROWS, SOUTH, WEST, write_rectangle

X, Y = WEST + 0.3 * COLUMNS * CELL, SOUTH + 0.5 * ROWS * CELL
SURFACES = {
    "plane": ["--plane", f"x={X},y={Y},dip=25,direction=90,depth=5"],
    "ellipsoid": ["--ellipsoid", f"x={X},y={Y},half_length=90,half_width=60,azimuth=90"],
    "slbl": ["--slbl"],
}


@pytest.mark.parametrize("surface", SURFACES)
def test_release_is_a_case(surface: str, thawslide: Program, report_environment: dict[str, str], slope: Slope) -> None:
    folder = slope.folder / "case"
    outline = write_rectangle(slope.folder / "outline.geojson", X - 90.0, Y - 60.0, 180.0, 120.0)
    words = [slope(), *SURFACES[surface], "--within", outline, "--volume", 250000]
    environment = report_environment | {"PYTHONPATH": str(ROOT / "python")}
    scarp = [sys.executable, "-m", "thawslide.scarps.command", *words, "--output", slope.folder / "scarp.tif"]
    done = thawslide.finish(scarp, env=environment)
    assert done.returncode == 0, done.stderr
    command = done.stdout.splitlines()[-1].removeprefix("To continue: thawslide ").replace("FOLDER", str(folder))
    (volume,) = re.findall(r"a release of ([\d,]+) m3", thawslide.ok(*command.split()))
    assert float(volume.replace(",", "")) == pytest.approx(250_000.0, rel=2e-3)
    assert tomllib.loads((folder / "case.toml").read_text())["body"]["slide"]["placement"] == "cut"
    assert thawslide.json("check", folder)
