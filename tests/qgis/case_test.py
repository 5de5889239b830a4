"""The algorithms 'New case', 'Check case', 'Run case' and 'Resume run'."""

import json
import sqlite3
import subprocess
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import rasterio
from conftest import Algorithm, Outcome, Script
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


def test_check_shows_facts_and_warnings_and_draws_a_picture(algorithm: Algorithm, case: Path, tmp_path: Path) -> None:
    checked = algorithm("checkcase", CASE=case, THREADS=1, SETTINGS="time.end=3")
    for expected in ["the case is valid", "  particles ", "  memory ", "WARNING:\twarning: "]:
        assert expected in checked.stdout
    picture = tmp_path / "setup.png"
    algorithm("checkcase", CASE=case, THREADS=1, PICTURE=picture)
    assert picture.read_bytes().startswith(b"\x89PNG")


def state_of(run: Path) -> Any:
    return json.loads((run / "run.json").read_text())


def test_run_writes_its_folder_and_shows_progress(finished: tuple[Path, Outcome]) -> None:
    folder, outcome = finished
    assert (state_of(folder)["status"], state_of(folder)["simulated_time_s"]) == ("done", 2.0)
    assert "0...10" in outcome.stdout and f"results in {folder}" in outcome.stdout


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ("time.nonsense=1", "error: --set time.nonsense=1: key 'time.nonsense' is not known in [time]."),
        ("time.end", "error: --set time.end"),
    ],
)
def test_wrong_settings_fail(algorithm: Algorithm, case: Path, tmp_path: Path, settings: str, message: str) -> None:
    assert message in algorithm("runcase", CASE=case, OUTPUT=tmp_path / "run", SETTINGS=settings, code=1).stderr
    assert not (tmp_path / "run" / "run.json").exists()


def test_several_settings_are_separated_by_lines(algorithm: Algorithm, case: Path, tmp_path: Path) -> None:
    settings = "time.end=0.1\n\n  time.history_interval=0.05\n"
    algorithm("runcase", CASE=case, OUTPUT=tmp_path / "run", THREADS=1, SETTINGS=settings)
    assert len((tmp_path / "run" / "history.csv").read_text().splitlines()) == 4


def test_a_run_is_replaced_on_request_only(algorithm: Algorithm, case: Path, tmp_path: Path) -> None:
    parameters = {"CASE": case, "OUTPUT": tmp_path / "run", "THREADS": 1, "SETTINGS": "time.end=0.1"}
    algorithm("runcase", **parameters)
    assert "--overwrite" in algorithm("runcase", **parameters, code=1).stderr
    algorithm("runcase", **parameters, OVERWRITE="true")


def test_temporary_folders_and_missing_runs_are_refused(algorithm: Algorithm, case: Path, tmp_path: Path) -> None:
    refused = algorithm("runcase", CASE=case, OUTPUT="TEMPORARY_OUTPUT", code=1)
    assert "OUTPUT: a temporary folder is deleted when QGIS is closed." in refused.stderr
    assert f"error: {tmp_path} is not a run folder" in algorithm("resumerun", RUN=tmp_path, code=1).stderr


def test_cancelled_run_can_be_resumed(algorithm: Algorithm, script: Script, case: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    cancelled = script("cancel_run.py", case, folder)
    assert state_of(folder)["status"] == "stopped"
    assert "thawslide resume" in cancelled["log"]
    reached = state_of(folder)["simulated_time_s"]
    assert 0.0 < reached < 100.0
    algorithm("resumerun", RUN=folder, THREADS=1, END=round(reached + 0.5, 1))
    assert state_of(folder)["status"] == "done"
