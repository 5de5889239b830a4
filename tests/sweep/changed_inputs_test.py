"""A repeated sweep runs the members again whose inputs have changed, and is refused for another program."""

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from conftest import Capture

from thawslide import _core
from thawslide.sweeps.command import main
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.member import perform

Sweep = Callable[[], list[int]]
STEEP, GENTLE = (f"distance_m,terrain_elevation_m\n0,{height}\n200,0\n" for height in (100, 90))


@pytest.fixture
def command(slope: Path, tmp_path: Path) -> list[str]:
    """Return the arguments of a sweep over two profiles and two angles; odd members have the second profile."""
    for name, text in (("a.csv", STEEP), ("b.csv", GENTLE)):
        (slope.parent / name).write_text(text)
    profiles = ",".join(str(slope.parent / name) for name in ("a.csv", "b.csv"))
    angles = ["--vary", "basal.friction_angle=10,15", "--vary", f"terrain.file={profiles}"]
    return [str(slope), "--block", *angles, "--set", f"case.title={'x' * 300}", "--output", str(tmp_path / "sweep")]


def starts_after(command: list[str], tmp_path: Path, stamps: dict[int, float]) -> list[int]:
    """Run the sweep; return the members whose record is new."""
    assert main(command) == 0
    folder = SweepFolder(tmp_path / "sweep")
    now = {number: folder.record_file(number).stat().st_mtime_ns for number in range(4)}
    again = [number for number in now if now[number] != stamps.get(number)]
    stamps.update(now)
    return again


@pytest.fixture
def sweep(command: list[str], tmp_path: Path) -> Sweep:
    """Return a function that repeats the sweep and returns the members that ran."""
    stamps: dict[int, float] = {}
    assert starts_after(command, tmp_path, stamps) == [0, 1, 2, 3]
    return lambda: starts_after(command, tmp_path, stamps)


def speeds(tmp_path: Path) -> list[float]:
    return list(pd.read_parquet(tmp_path / "sweep" / "members.parquet")["peak_speed_m_s"])


def test_members_of_a_changed_file_run_again(sweep: Sweep, slope: Path, tmp_path: Path, capfd: Capture) -> None:
    before = speeds(tmp_path)
    assert sweep() == []
    (slope.parent / "b.csv").write_text(STEEP)
    capfd.readouterr()
    assert sweep() == [1, 3]
    assert "note: 2 of 4 members run again, because their inputs have changed" in capfd.readouterr().err
    after = speeds(tmp_path)
    assert after[::2] == before[::2] and after[1] == after[0] != before[1] and after[3] == after[2] != before[3]
    assert sweep() == []


def test_a_changed_case_file_or_base_runs_again(sweep: Sweep, slope: Path) -> None:
    text = slope.read_text()
    slope.write_text(f"# a comment changes no member\n{text}")
    assert sweep() == []
    slope.write_text(text.replace("end = 0.5", "end = 0.4"))
    assert sweep() == [0, 1, 2, 3]
    (slope.parent / "base.toml").write_text(text)
    slope.write_text('[case]\nbased_on = "base.toml"\n')
    assert sweep() == [0, 1, 2, 3]
    (slope.parent / "base.toml").write_text(text.replace("cohesion = 1.0e5", "cohesion = 1.1e5"))
    assert sweep() == [0, 1, 2, 3]


def test_changed_targets_run_again(slope: Path, command: list[str], tmp_path: Path) -> None:
    targets = slope.parent / "targets.csv"
    targets.write_text("quantity,time_s,value,unit,source\nmean_velocity,0.4,10,m/s,A\n")
    command += ["--set", f"report.targets={targets}"]
    stamps: dict[int, float] = {}
    assert starts_after(command, tmp_path, stamps) == [0, 1, 2, 3]
    targets.write_text("quantity,time_s,value,unit,source\nmean_velocity,0.4,12,m/s,A\n")
    assert starts_after(command, tmp_path, stamps) == [0, 1, 2, 3]


def test_an_unfinished_member_of_a_changed_file_starts_again(sweep: Sweep, slope: Path, tmp_path: Path) -> None:
    folder = SweepFolder(tmp_path / "sweep")
    folder.write_record(1, {"status": "running", "starts": 1})
    (folder.run_folder(1)).mkdir()
    (folder.run_folder(1) / "checkpoint.bin").write_bytes(b"of the former profile")
    (slope.parent / "b.csv").write_text(STEEP)
    assert sweep() == [1, 3]
    assert not folder.run_folder(1).exists() and folder.record(1)["starts"] == 1


def test_another_build_of_the_program_is_refused(
    sweep: Sweep, command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Capture
) -> None:
    other = tmp_path / "core.so"
    other.write_bytes(Path(_core.__file__).read_bytes() + b"other build")
    monkeypatch.setattr(_core, "__file__", str(other))
    assert main(command) == 2
    assert "contains another sweep (different: program)" in capfd.readouterr().err
    monkeypatch.undo()
    assert sweep() == []


def test_a_file_edited_during_a_sweep_does_not_change_its_members(
    command: list[str], slope: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Workers use the text that was checked."""

    def edit_and_perform(tasks, client, progress, on_finished, most) -> None:  # type: ignore[no-untyped-def]
        slope.write_text("[case]\n")
        monkeypatch.chdir(tmp_path)
        for task in tasks:
            assert perform(task)["status"] == "done"

    from thawslide.sweeps import engine

    monkeypatch.setattr(engine, "perform_all", edit_and_perform)
    assert main([*command, "--workers", "1"]) == 0
    assert len(set(speeds(tmp_path))) == 4
