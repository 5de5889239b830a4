"""What `thawslide new` reports of its rigid block, and warnings about values that it wrote."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program, Slope, columns_of
from terrain_files import SOUTH, WEST, write_dem, write_rectangle, write_release

VALLEY = ROOT / "cases" / "valley3d"


def block_line(printed: str) -> str:
    found = re.findall(r"^block:       a rigid block with pore pressure (.*)$", printed, re.MULTILINE)
    assert len(found) == 1, printed
    return str(found[0])


def test_a_base_above_the_limit_of_temperature_has_a_warning(thawslide: Program, tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", lambda x, y: 4000.0 - np.minimum(x, 2800.0) - 0.1 * x, 180, 60, 20.0)
    corners = [(400.0, 400.0), (900.0, 400.0), (900.0, 800.0), (400.0, 800.0)]
    release = write_release(tmp_path / "release.geojson", corners)
    words = ["--dem", dem, "--release", release, "--thickness"]
    printed = thawslide.ok("new", tmp_path / "thick", *words, 150)
    heated = re.search(r"a band of 2\.0 m, which a rigid block without pore pressure heats to (\d+) C\n", printed)
    assert heated and int(heated[1]) > 210, printed
    assert (
        "warning: band.thickness: friction heats the base of the rigid block above 210 C, which is not credible (found "
        f"{heated[1]} C with 2 m). Set a lower basal.friction_angle or a larger band.thickness"
    ) in printed
    assert "which is not credible" not in thawslide.ok("new", tmp_path / "thin", *words, 30)


def test_a_release_that_leaves_the_dem_at_once_has_a_case(slope: Slope) -> None:
    slope(degrees=45.0, foot=800.0)
    assert "/case.toml: a release of 1,800,000 m3, 150 m thick, on " in slope.ok(thickness=150)


def test_a_block_that_stays_states_the_friction_with_which_it_leaves(thawslide: Program, slope: Slope) -> None:
    slope(degrees=8.0, foot=800.0)
    printed = slope.ok(thickness=20)
    line = block_line(printed)
    found = re.fullmatch(r"does not leave; it needs a basal\.friction_angle below (8\.[01]) degrees", line)
    assert found, printed
    rows = slope.folder / "block.csv"
    for angle, leaves in ((float(found[1]) + 0.1, False), (float(found[1]) - 0.1, True)):
        thawslide.ok("block", slope.case, "--set", f"basal.friction_angle={angle}", "--output", rows)
        assert (columns_of(rows)["displacement_m"][-1] > 1.0) == leaves


def test_a_block_that_comes_to_rest_has_a_travel_distance(thawslide: Program, tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", lambda x, y: 1000.0 - 0.5 * np.minimum(x, 400.0) - 0.1 * x, columns=200)
    corners = [(105.0, 155.0), (205.0, 155.0), (205.0, 245.0), (105.0, 245.0)]
    release = write_release(tmp_path / "release.geojson", corners, thickness=20.0)
    line = block_line(thawslide.ok("new", tmp_path / "slide", "--dem", dem, "--release", release))
    rows = tmp_path / "block.csv"
    thawslide.ok("block", tmp_path / "slide", "--output", rows)
    columns = columns_of(rows)
    length, height = (columns[name][-1] for name in ("travel_distance_m", "drop_height_m"))
    found = re.fullmatch(r"travels ([\d,]+) m, H/L (0\.\d\d)", line)
    assert found, line
    assert float(found[1].replace(",", "")) == pytest.approx(length, rel=0.01)
    assert float(found[2]) == pytest.approx(height / length, abs=0.006)


def test_a_block_that_reaches_the_end_of_the_dem_states_it(thawslide: Program, tmp_path: Path) -> None:
    words = ["--dem", VALLEY / "valley.tif", "--release", VALLEY / "release.geojson"]
    line = block_line(thawslide.ok("new", tmp_path / "slide", *words))
    found = re.fullmatch(r"reaches the end of the known terrain after ([\d,]+) m, at (\d+) m/s\. Use a larger .*", line)
    assert found, line
    rows = tmp_path / "block.csv"
    assert "the front leaves the DEM" in thawslide.ok("block", tmp_path / "slide", "--output", rows)
    columns = columns_of(rows)
    assert float(found[1].replace(",", "")) == pytest.approx(columns["travel_distance_m"][-1], rel=0.01)
    assert float(found[2]) == pytest.approx(columns["velocity_m_s"][-1], abs=1.0)


@pytest.mark.parametrize(
    "words",
    ["--on-top", "--cut", "--resolution standard", "--cell 10", "--reach-angle 12", "--glacier", "--snow",
     "--valley-floor"],
)  # fmt: skip
def test_check_has_no_warning_of_values_of_new(thawslide: Program, slope: Slope, tmp_path: Path, words: str) -> None:
    """The cell is a choice, whose errors `new` states."""
    given: list[object] = list(words.split())
    if words in ("--glacier", "--snow", "--valley-floor"):
        given.append(write_rectangle(tmp_path / "ground.geojson", WEST + 400.0, SOUTH + 100.0))
    printed = slope.ok(*given)
    checked = thawslide.json("check", slope.case)
    assert math.isfinite(checked["bodies"][0]["volume_m3"])
    warnings = [text for text in checked["warnings"] if not text.startswith("note: ")]
    assert [text for text in warnings if " grid.cell: across " not in text] == [], printed
