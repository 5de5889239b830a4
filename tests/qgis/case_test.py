"""The algorithms 'New case' and 'Check case'."""

import sqlite3
import subprocess
from contextlib import closing
from pathlib import Path

import rasterio
from conftest import Algorithm, Script
from rasterio.shutil import copy
from terrain_files import SOUTH, WEST


def test_new_case_is_that_of_the_command(case: Path, slope: Path, binary: Path, tmp_path: Path) -> None:
    files = ["--dem", slope / "dem.tif", "--release", slope / "release.geojson", "--thickness", "24"]
    subprocess.run([binary, "new", tmp_path / "slope", *files], check=True, capture_output=True)
    expected = (tmp_path / "slope" / "case.toml").read_text().replace("release.geojson", "release.gpkg")
    assert case.read_text() == expected


def test_choices_and_cell_size_become_options(algorithm: Algorithm, slope: Path, tmp_path: Path) -> None:
    inputs = {"DEM": slope / "dem.tif", "RELEASE": slope / "release.geojson", "THICKNESS": 24}
    algorithm("newcase", **inputs, PLACEMENT="cut", REACH_ANGLE=10, OUTPUT=tmp_path / "cut")
    text = (tmp_path / "cut" / "case.toml").read_text()
    assert 'placement = "cut"' in text and "descends at 10 degrees" in text
    standard = algorithm("newcase", **inputs, RESOLUTION="standard", OUTPUT=tmp_path / "standard")
    assert "resolution:  standard" in standard.stdout
    algorithm("newcase", **inputs, CELL=6, OUTPUT=tmp_path / "slide")
    assert "cell = 6.0" in (tmp_path / "slide" / "case.toml").read_text()


def test_layers_in_memory_selections_and_assigned_systems_are_used(script: Script, slope: Path, tmp_path: Path) -> None:
    dem = tmp_path / "dem.vrt"  # a format that the program does not read, without its coordinate system
    copy(slope / "dem.tif", dem, driver="VRT")
    with rasterio.open(dem) as file:
        assert file.driver == "VRT"
    dem.write_text("".join(line for line in dem.read_text().splitlines(keepends=True) if "<SRS" not in line))
    made = script("new_from_layers.py", dem, tmp_path / "slide", WEST + 50.0, SOUTH + 250.0)
    assert made == {"CASE": str(tmp_path / "slide" / "case.toml"), "OUTPUT": str(tmp_path / "slide")}
    with rasterio.open(tmp_path / "slide" / "dem.tif") as file:
        assert file.crs.to_epsg() == 32632
    with closing(sqlite3.connect(tmp_path / "slide" / "release.gpkg")) as file:
        assert file.execute("SELECT thickness FROM release").fetchall() == [(24.0,)]


def test_refusal_shows_the_message_of_the_program(algorithm: Algorithm, slope: Path, tmp_path: Path) -> None:
    inputs = {"DEM": slope / "dem.tif", "RELEASE": slope / "release.geojson"}
    refused = algorithm("newcase", **inputs, THICKNESS=-1, OUTPUT=tmp_path / "slide", code=1)
    assert "error: --thickness" in refused.stderr


def test_check_shows_facts_and_warnings(algorithm: Algorithm, case: Path) -> None:
    checked = algorithm("checkcase", CASE=case, THREADS=1, SETTINGS="time.end=3")
    for expected in ["the case is valid", "  particles ", "  memory ", "WARNING:\twarning: "]:
        assert expected in checked.stdout


def test_check_draws_a_picture(algorithm: Algorithm, case: Path, tmp_path: Path) -> None:
    picture = tmp_path / "setup.png"
    algorithm("checkcase", CASE=case, THREADS=1, PICTURE=picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
