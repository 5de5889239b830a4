"""Warnings of `thawslide new` and `thawslide check` about releases and DEMs that are valid but probably unintended."""

import json
import re
import sqlite3
import tomllib
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import Program, Ran, Slope, run_facts, sets
from terrain_files import CELL, SOUTH, THICKNESS, WEST, write_rectangle

ACROSS = "across the median thickness of body slide, 24 m, there are "
MAPS = "too few cells for maps of thickness and area"


def warnings_of(thawslide: Program, case: Path) -> list[str]:
    return [text for text in thawslide.json("check", case)["warnings"] if not text.startswith("note: ")]


def test_too_few_particles_across_have_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    assert "too few particles" not in slope.ok(folder=tmp_path / "fine")
    checked = thawslide("check", tmp_path / "fine")
    assert (
        "  body        slide: 288,000 m3 and 594,000 t, over 12,000 m2; 24 m thick on average, 24 m in the median and "
        "24 m at most (vertical)\n              1,400 particles 6 m apart; 4 across in the median and 4 at most; -5 "
        "C\n  roughness   noise of 0 m rms"
    ) in checked.stdout
    coarse = slope.new("--cell", 30, folder=tmp_path / "coarse")
    particles = "too few particles to resolve shear and thinning (found 1.6; needed 4)"
    problem = f"{ACROSS}{particles}, and {MAPS} (found 0.8; needed 4)"
    assert (
        f"warning: --cell: {problem}. Set --cell to 12 m, at about 39 times the run time, or for maps to 6 m, at about "
        "630 times the run time.\n"
    ) in coarse.stdout, coarse.stderr
    checked = thawslide.ok("check", tmp_path / "coarse")
    assert "; 1.6 across in the median and 1.6 at most; " in checked
    fitting = re.search(
        rf"/coarse/case\.toml:\d+:\d+: grid\.cell: {re.escape(problem)}\. Set grid\.cell to (\S+) m, at about \S+ "
        r"times the run time, or for maps to (\S+) m, at about \S+ times the run time\.\n",
        checked,
    )
    assert fitting and 6.0 < float(fitting[1]) <= 12.0, checked
    assert 4.0 <= float(fitting[2]) <= 6.0, checked
    assert "too few particles" not in thawslide.ok("check", tmp_path / "coarse", "--set", f"grid.cell={fitting[1]}")
    assert MAPS not in thawslide.ok("check", tmp_path / "coarse", "--set", f"grid.cell={fitting[2]}")


def test_too_few_cells_for_maps_have_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    folder = tmp_path / "slide"
    outcome = slope.new()
    problem = f"{ACROSS}{MAPS} (found 2; needed 4)"
    fewer = "Travel distance and speed need 2.\n"
    assert "warning: " not in outcome.stdout and "  --resolution standard: cells of 6 m, about " in outcome.stdout
    text = (folder / "case.toml").read_text()
    assert (
        "cell = 12.0  # m; two particles a cell and axis make 4.0 across a thickness of 24 m\n"
        "# Travel distance and speed need 2 cells across the thickness of the release. Maps of thickness and area "
        "need\n# 4: cells of 6 m (`thawslide new --resolution standard`), at about 16 times the run time.\n"
    ) in text
    place = f"{folder / 'case.toml'}:{text.splitlines().index('[grid]') + 2}:8"
    (note,) = warnings_of(thawslide, folder)
    assert note.startswith(f"{place}: grid.cell: {problem}. Set grid.cell to ") and note.endswith(fewer.strip())
    run = thawslide("run", folder, "--output", tmp_path / "run", *sets(time__end=0.01))
    assert f"warning: {note}\n" in run.stdout, run.stderr
    assert f"{problem}. Set grid.cell to " in thawslide.ok("check", tmp_path / "run")

    assert "warning: " not in slope.ok("--cell", 6, folder=tmp_path / "fine")
    assert "need 2 cells" not in (tmp_path / "fine" / "case.toml").read_text()
    assert warnings_of(thawslide, tmp_path / "fine") == []

    (folder / "case.toml").write_text(text.partition("# Maps are updated")[0])
    assert warnings_of(thawslide, folder) == [], "no key of maps is given"


def test_a_hole_filled_with_zeros_has_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    dem = slope()
    with rasterio.open(dem, "r+") as file:
        heights = file.read(1)
        heights[27:30, 40:45] = 0.0
        file.write(heights, 1)
    note = (
        "warning: 15 points of dem.tif are exactly 0 m among heights of 1000 to 1035 m, such as (412400, 5160300): a "
        "hole without data? Then declare it in the file, gdal_edit.py -a_nodata 0 {}dem.tif, or fill it\n"
    )
    assert slope.ok(dem=dem).startswith(note.format(f"{slope.folder}/"))
    for words in (["check", slope.case], ["run", slope.case, "--output", tmp_path / "run", "--set", "time.end=0.01"]):
        assert note.format(f"{slope.case}/") in thawslide.ok(*words)


def test_resampling_a_case_reports_the_domain_that_fits(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    folder = tmp_path / "slide"
    slope.ok()
    words = ("--set", "terrain.resample=40")
    message = thawslide.error("check", folder, *words)
    reported = message.partition("Set ")[2].partition(", or take a larger")[0]
    low, _, high = reported.partition(" and ")
    assert low.startswith("grid.min = [") and high.startswith("grid.max = ["), message
    thawslide.ok("check", folder, *words, "--set", low.replace(" ", ""), "--set", high.replace(" ", ""))


def test_a_release_near_the_edge_of_the_known_terrain_has_a_warning(tmp_path: Path, slope: Slope) -> None:
    def warning(name: str, west: float, hole: slice | None = None) -> str:
        near = write_rectangle(tmp_path / f"{name}.geojson", WEST + west, SOUTH + 250.0)
        printed = slope.ok(folder=tmp_path / name, dem=slope(hole=hole), release=near)
        case = tomllib.loads((tmp_path / name / "case.toml").read_text())
        assert case["grid"]["leaving"] == "remove"
        return "".join(line for line in printed.splitlines() if line.startswith("warning: "))

    # The release has the points from 205 to 315 m, and ends a cell beyond them.
    assert warning("middle", 205.0) == ""
    advice = (
        "needed at least its own length, 130 m). Particles that pass the edge are removed, and the results do not "
        "include them. Use a larger DEM"
    )
    start = "warning: --dem: the release is close to the edge of the known terrain (found "
    assert warning("west", 75.0) == f"{start}70 m; {advice}"
    assert warning("hole", 205.0, hole=slice(40, 45)) == f"{start}70 m; {advice}"


def rows_of(file: Path, layer: str) -> list[dict[str, object]]:
    with closing(sqlite3.connect(file)) as database:
        database.row_factory = sqlite3.Row
        return [dict(row) for row in database.execute(f"SELECT * FROM {layer}").fetchall()]


@pytest.mark.parametrize("degrees", [0.0, 30.0, 45.0])
def test_a_release_at_rest_has_the_area_that_was_drawn(ran: Ran, tmp_path: Path, slope: Slope, degrees: float) -> None:
    """The release of 80 m by 100 m, at least eight cells of the DEM, has any direction."""
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    corners = np.array([[-40.0, -50.0], [40.0, -50.0], [40.0, 50.0], [-40.0, 50.0], [-40.0, -50.0]]) @ turn
    path = write_rectangle(tmp_path / "turned.geojson", WEST, SOUTH)
    drawn = json.loads(path.read_text())
    drawn["features"][0]["geometry"]["coordinates"] = [(corners + np.array([WEST + 303.0, SOUTH + 301.0])).tolist()]
    path.write_text(json.dumps(drawn))
    folder = tmp_path / "slide"
    slope.ok(release=path)
    run = ran(*sets(time__end=0.01, maps__cell=CELL), case=folder)
    facts = run_facts(run)
    assert facts["at_rest"] is False
    assert facts["affected_area_m2"] == pytest.approx(8000.0, rel=0.05)
    assert facts["covered_area_m2"] == pytest.approx(8000.0, rel=0.05)
    with closing(sqlite3.connect(run / "maps" / "results.gpkg")) as database:
        ((area, state),) = database.execute("SELECT area_m2, state FROM affected_area").fetchall()
    assert area == pytest.approx(facts["affected_area_m2"], rel=1e-9)
    assert state == "at 0.01 s, not at rest"
    layers = {name: rows_of(run / "maps" / "results.gpkg", name) for name in ("deposit_area", "release_area")}
    ((deposit,), (release,)) = layers.values()
    assert deposit["area_m2"] == pytest.approx(facts["deposit_area_m2"], rel=1e-9)
    assert deposit["volume_m3"] == pytest.approx(8000.0 * THICKNESS, rel=0.01)
    assert (deposit["threshold_m"], deposit["time_s"], deposit["run"]) == (0.5, 0.01, "run")
    assert release["area_m2"] == pytest.approx(8000.0, rel=1e-9), "the outline as drawn"
    assert release["volume_m3"] == pytest.approx(8000.0 * THICKNESS, rel=0.01)
    assert (release["body"], release["run"]) == ("slide", "run")
    with rasterio.open(run / "maps" / "final_thickness.tif") as file:
        thickness = file.read(1, masked=True)
        assert file.descriptions == ("at 0.01 s, not at rest: vertical thickness of the sliding mass",)
    assert thickness.sum() * CELL**2 == pytest.approx(8000.0 * THICKNESS, rel=0.01)
    whole_cells = (thickness > 0.1).sum() * CELL**2
    assert whole_cells > 1.25 * 8000.0, "on the DEM, the edges are ramps"
