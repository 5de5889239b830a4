"""Warnings of `thawslide new` and `thawslide check` about releases and DEMs that are valid but probably unintended."""

import re
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
import rasterio
from conftest import Program, Ran, Slope, run_facts, sets
from terrain_files import CELL, DEPTH, SOUTH, THICKNESS, WEST, WIDTH, write_rectangle

ACROSS = "across the median thickness of body slide, 24 m, there are "
MAPS = "too few cells for maps of thickness and area"


def warnings_of(thawslide: Program, case: Path) -> list[str]:
    return [text for text in thawslide.json("check", case)["warnings"] if not text.startswith("note: ")]


def test_too_few_particles_across_have_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    assert "too few particles" not in slope.ok(folder=tmp_path / "fine")
    assert (
        "  body        slide: 288,000 m3 and 594,000 t, over 12,000 m2; 24 m thick on average, 24 m in the median and "
        "24 m at most (vertical)\n              1,400 particles 6 m apart; 4 across in the median and 4 at most; -5 "
        "C\n  roughness   noise of 0 m rms"
    ) in thawslide.ok("check", tmp_path / "fine")
    problem = f"{ACROSS}too few particles to resolve shear and thinning (found 1.6; needed 4), and {MAPS} (found 0.8; "
    assert f"warning: --cell: {problem}" in slope.ok("--cell", 30, folder=tmp_path / "coarse")
    checked = thawslide.ok("check", tmp_path / "coarse")
    fitting = re.search(
        rf"/coarse/case\.toml:\d+:\d+: grid\.cell: {re.escape(problem)}needed 4\)\. Set grid\.cell to (\S+) m, at "
        r"about \S+ times the run time, or for maps to (\S+) m, ",
        checked,
    )
    assert fitting and 6.0 < float(fitting[1]) <= 12.0 and 4.0 <= float(fitting[2]) <= 6.0, checked
    assert "too few particles" not in thawslide.ok("check", tmp_path / "coarse", "--set", f"grid.cell={fitting[1]}")
    assert MAPS not in thawslide.ok("check", tmp_path / "coarse", "--set", f"grid.cell={fitting[2]}")


def test_too_few_cells_for_maps_have_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    printed = slope.ok()
    assert "warning: " not in printed and "  --resolution standard: cells of 6 m, about " in printed
    text = (slope.case / "case.toml").read_text()
    place = f"{slope.case / 'case.toml'}:{text.splitlines().index('[grid]') + 2}:8"
    problem = f"grid.cell: {ACROSS}{MAPS} (found 2; needed 4). Set grid.cell to "
    (note,) = warnings_of(thawslide, slope.case)
    assert note.startswith(f"{place}: {problem}") and note.endswith("Travel distance and speed need 2.")
    run = thawslide.ok("run", slope.case, "--output", tmp_path / "run", *sets(time__end=0.01))
    assert f"warning: {note}\n" in run and problem in thawslide.ok("check", tmp_path / "run")
    (slope.case / "case.toml").write_text(text.partition("# Maps are updated")[0])
    assert warnings_of(thawslide, slope.case) == [], "no key of maps is given"

    assert "warning: " not in slope.ok("--cell", 6, folder=tmp_path / "fine")
    assert warnings_of(thawslide, tmp_path / "fine") == []


def test_a_hole_filled_with_zeros_has_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    dem = slope()
    with rasterio.open(dem, "r+") as file:
        heights = file.read(1)
        heights[27:30, 40:45] = 0.0
        file.write(heights, 1)
    note = (
        r"warning: 15 points of dem\.tif are exactly 0 m among heights of \d+ to \d+ m, such as \(412400, 5160300\): a "
        r"hole without data\? Then declare it in the file, gdal_edit\.py -a_nodata 0 {}dem\.tif, or fill it\n"
    )
    assert re.match(note.format(f"{slope.folder}/"), slope.ok(dem=dem))
    for words in (["check", slope.case], ["run", slope.case, "--output", tmp_path / "run", "--set", "time.end=0.01"]):
        assert re.search(note.format(f"{slope.case}/"), thawslide.ok(*words))


def test_a_release_near_the_edge_of_the_known_terrain_has_a_warning(tmp_path: Path, slope: Slope) -> None:
    near = write_rectangle(tmp_path / "near.geojson", WEST + 205.0, SOUTH + 250.0)
    for hole in (None, slice(40, 45)):
        printed = slope.ok(folder=tmp_path / f"{hole}", dem=slope(hole=hole), release=near)
        warning = "warning: --dem: the release is close to the edge of the known terrain (found 70 m; needed at least "
        assert (warning in printed) == (hole is not None)


def rows_of(file: Path, layer: str) -> list[dict[str, object]]:
    with closing(sqlite3.connect(file)) as database:
        database.row_factory = sqlite3.Row
        return [dict(row) for row in database.execute(f"SELECT * FROM {layer}").fetchall()]


def test_a_release_at_rest_has_the_area_that_was_drawn(ran: Ran, slope: Slope) -> None:
    """In any direction: tests/cpp/sim/covered_area_test.cpp."""
    slope.ok()
    run = ran(*sets(time__end=0.01, maps__cell=CELL), case=slope.case)
    facts, area, volume = run_facts(run), WIDTH * DEPTH, WIDTH * DEPTH * THICKNESS
    assert facts["at_rest"] is False
    assert facts["affected_area_m2"] == pytest.approx(area, rel=0.05)
    assert facts["covered_area_m2"] == pytest.approx(area, rel=0.05)
    layers = (rows_of(run / "maps" / "results.gpkg", f"{name}_area") for name in ("affected", "deposit", "release"))
    (affected,), (deposit,), (release,) = layers
    assert affected["area_m2"] == pytest.approx(facts["affected_area_m2"], rel=1e-9)
    assert affected["state"] == "at 0.01 s, not at rest"
    assert deposit["area_m2"] == pytest.approx(facts["deposit_area_m2"], rel=1e-9)
    assert deposit["volume_m3"] == pytest.approx(volume, rel=0.01)
    assert (deposit["threshold_m"], deposit["time_s"], deposit["run"]) == (0.5, 0.01, "run")
    assert release["area_m2"] == pytest.approx(area, rel=1e-9), "the outline as drawn"
    assert release["volume_m3"] == pytest.approx(volume, rel=0.01)
    assert (release["body"], release["run"]) == ("slide", "run")
    with rasterio.open(run / "maps" / "final_thickness.tif") as file:
        thickness = file.read(1, masked=True)
        assert file.descriptions == ("at 0.01 s, not at rest: vertical thickness of the sliding mass",)
    assert thickness.sum() * CELL**2 == pytest.approx(volume, rel=0.01)
    assert (thickness > 0.1).sum() * CELL**2 > 1.1 * area, "on the DEM, the edges are ramps"
