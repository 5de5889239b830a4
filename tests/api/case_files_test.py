"""A case reads its files once: later changes of files or of the working directory do not affect it."""

import json
import pickle
from pathlib import Path

import pytest
from conftest import silent

import thawslide
from thawslide import Case, Simulation, UserError

PROFILE = "distance_m,terrain_elevation_m\n0,90\n200,0\n"  # gentler than that of the slope


@pytest.fixture
def inside(slope: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in the folder of the case; another folder has a case of the same name with other values."""
    other = slope.parent.parent / "other"
    other.mkdir()
    (other / "case.toml").write_text(slope.read_text().replace("porosity = 0.3", "porosity = 0.1"))
    (other / "profile.csv").write_text(PROFILE)
    monkeypatch.chdir(slope.parent)
    return other


def assert_only_friction_changes(case: Case) -> None:
    before = case.to_toml()
    case["basal.friction_angle"] = 12.0
    assert case.to_toml() == before.replace("friction_angle = 10.0  # degrees", "friction_angle = 12.0  # degrees")
    assert case["basal.friction_angle"] == 12.0


def test_a_change_in_another_folder_touches_the_named_key_only(inside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = Case("case.toml")
    simulation = Simulation("case.toml", threads=1, on_message=silent)
    simulation.run(until=0.1)
    monkeypatch.chdir(inside)
    assert_only_friction_changes(case)
    simulation.change({"basal.friction_angle": 12.0})
    assert simulation.case.to_toml() == case.to_toml()


def test_an_edited_or_removed_file_does_not_affect_its_case(inside: Path) -> None:
    file = Path("case.toml")
    Path("steep.toml").write_text('[case]\nbased_on = "case.toml"\n[basal]\nfriction_angle = 10.0\n')
    edited, removed, based = Case(file), Case(file), Case("steep.toml")
    file.write_text((inside / "case.toml").read_text())
    for case in (edited, based):
        assert_only_friction_changes(case)
        assert case["body.block.porosity"] == 0.3
    file.unlink()
    assert_only_friction_changes(removed)


def test_relative_paths_of_changes_remain_those_of_their_folder(inside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("second.csv").write_text(PROFILE)
    case = Case("case.toml", {"terrain.file": "second.csv"})
    found = case["terrain.file"]
    monkeypatch.chdir(inside)
    assert_only_friction_changes(case)
    assert case["terrain.file"] == found == str(inside.parent / "slope" / "second.csv")
    with pytest.raises(UserError, match=r"no such file"):
        case["terrain.file"] = "second.csv"


def test_a_refused_change_changes_nothing(inside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = Case("case.toml")
    before = case.to_toml()
    monkeypatch.chdir(inside)
    with pytest.raises(UserError):
        case.change({"basal.friction_angle": 30.0, "band.thickness": -1.0})
    assert case.to_toml() == before and case.changes == {}


def test_a_pickled_case_is_the_same_elsewhere(inside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = Case("case.toml", {"terrain.file": "profile.csv", "band.thickness": 0.2})
    text, pickled = case.to_toml(), pickle.dumps(case)
    monkeypatch.chdir(inside)
    other = pickle.loads(pickled)
    assert other.to_toml() == text and other.changes == case.changes
    assert_only_friction_changes(other)


def test_a_run_keeps_the_text_that_was_read(inside: Path, tmp_path: Path) -> None:
    text = Path("case.toml").read_text()
    case = Case("case.toml", {"time.end": 0.01})
    Path("case.toml").write_text((inside / "case.toml").read_text())
    run = thawslide.run(case, tmp_path / "run", progress=False)
    assert (run.folder / "inputs" / "case.toml").read_text() == text
    assert "porosity = 0.3" in (run.folder / "case.toml").read_text()
    assert json.loads((run.folder / "run.json").read_text())["inputs"][0]["bytes"] == len(text)


def test_a_case_from_text_needs_no_file_later(slope: Path, tmp_path: Path) -> None:
    case = Case.from_text(slope.read_text(), {"terrain.file": slope.parent / "profile.csv", "time.end": 0.01})
    assert_only_friction_changes(case)
    run = thawslide.run(case, tmp_path / "run", progress=False)
    assert (run.folder / "inputs" / "case.toml").read_text() == slope.read_text()
