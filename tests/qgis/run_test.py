"""The algorithms 'Run case' and 'Resume run'."""

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import Algorithm, Outcome, Script


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
