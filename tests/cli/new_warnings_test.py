"""Warnings of `thawslide new` and `thawslide check` about releases and DEMs that are valid but probably unintended."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
import rasterio
from conftest import Program, Ran, Slope, run_facts, sets
from terrain_files import CELL, DEPTH, SOUTH, THICKNESS, WEST, WIDTH, write_rectangle


def test_warnings_of_new_are_those_of_check_and_run(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    """The rules and the texts: tests/cpp/gis, tests/cpp/sim."""
    near = write_rectangle(tmp_path / "near.geojson", WEST + 205.0, SOUTH + 250.0)
    printed = slope.ok("--cell", 30, dem=slope(hole=slice(40, 45)), release=near)
    assert "warning: --dem: the release is close to the edge of the known terrain (found 70 m; needed at " in printed
    resolution = "across the median thickness of body slide, 24 m, there are too few particles to resolve "
    assert f"warning: --cell: {resolution}" in printed
    for words in (["check", slope.case], ["run", slope.case, "--output", tmp_path / "run", *sets(time__end=0.01)]):
        assert f": grid.cell: {resolution}" in thawslide.ok(*words)


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
