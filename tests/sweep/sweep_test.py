"""Sweeps end to end: tables, restarts, changed inputs, failures, deaths of workers, and errors before any run."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import Capture

import thawslide
from thawslide import Case, Run, UserError, _core
from thawslide.errors import ReportError
from thawslide.sweeps.command import main
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.member import perform

Process = subprocess.Popen[bytes]
# A case that runs for seconds and writes checkpoints often.
SLOW = '[case]\nbased_on = "case.toml"\n[time]\nend = 3.0\nstep = 0.0005\n[checkpoint]\ninterval = 0.05\n'


def starts_of(folder: Path) -> list[int]:
    return list(pd.read_parquet(folder / "members.parquet")["starts"])


def test_a_sweep_returns_the_numbers_of_separate_runs(slope: Path, tmp_path: Path) -> None:
    vary = {"band.thickness": [0.05, 0.1], "basal.friction_angle": [20.0, 30.0]}
    columns = {"last": "last(mean_velocity_m_s)"}
    table = thawslide.sweep(slope, tmp_path / "sweep", vary=vary, columns=columns, workers=2, progress=False)
    assert list(table["status"]) == ["done"] * 4 and list(table["starts"]) == [1] * 4
    run = thawslide.run(Case(slope, {"band.thickness": 0.1, "basal.friction_angle": 20.0}), tmp_path / "run")
    member = table[(table["band.thickness"] == 0.1) & (table["basal.friction_angle"] == 20.0)].iloc[0]
    assert member["last"] == run.series["mean_velocity_m_s"][-1]
    assert member["peak_mean_velocity_m_s"] == run.series["mean_velocity_m_s"].max()
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "sweep" / "members.parquet"), table)
    folder = SweepFolder(tmp_path / "sweep").run_folder(0)
    assert sorted(path.name for path in folder.iterdir()) == ["case.toml", "history.csv", "run.json"]


def test_finished_members_are_not_repeated(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    command = [str(slope), "--vary", "basal.friction_angle=20:30:5", "--output", str(tmp_path / "sweep")]
    command += ["--keep", "all"]
    assert main(command) == 0
    first = pd.read_parquet(tmp_path / "sweep" / "members.parquet")
    SweepFolder(tmp_path / "sweep").record_file(1).unlink()
    assert main(command) == 0
    second = pd.read_parquet(tmp_path / "sweep" / "members.parquet")
    assert list(second["starts"]) == [1, 1, 1]
    pd.testing.assert_frame_equal(first.drop(columns="wall_s"), second.drop(columns="wall_s"))
    assert main([*command, "--vary", "band.thickness=0.1"]) == 2
    assert "contains another sweep (different: design)" in capfd.readouterr().err


def test_columns_may_not_replace_others(slope: Path, tmp_path: Path) -> None:
    for name in ("status", "peak_speed_m_s", "probe_dam_speed_m_s", "runs"):
        command = [str(slope), "--block", "--vary", "basal.friction_angle=20,30", "--output", str(tmp_path / name)]
        assert main([*command, "--column", f"{name}=last(velocity_m_s)"]) == (0 if name == "runs" else 2)


@pytest.mark.parametrize(
    ("is_block", "text", "near"),
    [(False, "last(mean_velocty_m_s)", "mean_velocity_m_s"), (True, "max(velocity_ms)", "velocity_m_s")],
)
def test_an_unknown_column_is_refused_before_any_run(
    slope: Path, tmp_path: Path, with_program: None, is_block: bool, text: str, near: str
) -> None:
    vary, folder = {"basal.friction_angle": [10.0]}, tmp_path / "sweep"
    with pytest.raises(ReportError, match=rf"no column '\w+' in the history \(allowed, for example: {near}"):
        thawslide.sweep(slope, folder, vary=vary, columns={"x": text}, block=is_block, progress=False)
    assert not (tmp_path / "sweep").exists()


def start_slow(slope: Path, sweep: Path, angles: str, *options: str) -> tuple[Path, list[str], Process, list[Path]]:
    """Start a slow sweep in a session of its own; return case, command, process and checkpoints once all exist."""
    case = slope.with_name("slow.toml")
    case.write_text(SLOW)
    command = [sys.executable, "-m", "thawslide.sweeps.command", str(case), "--vary", f"basal.friction_angle={angles}"]
    command += ["--output", str(sweep), *options]
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL, start_new_session=True)
    folders = [SweepFolder(sweep).run_folder(number) for number in range(len(angles.split(",")))]
    checkpoints = [folder / "checkpoint.previous.bin" for folder in folders]
    deadline = time.monotonic() + 600.0
    while not all(path.is_file() for path in checkpoints):
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    return case, command, process, checkpoints


@pytest.mark.parametrize("kill", [os.killpg, os.kill], ids=["with its workers", "alone"])
def test_a_killed_sweep_continues_from_checkpoints(
    slope: Path, tmp_path: Path, kill: Callable[[int, int], None]
) -> None:
    sweep = tmp_path / "sweep"
    case, command, process, checkpoints = start_slow(slope, sweep, "20,30", "--keep", "all", "--workers", "2")
    kill(process.pid, signal.SIGKILL)
    process.wait()
    checkpoints[0].with_name("checkpoint.bin").unlink(missing_ok=True)  # as if killed while replacing it
    assert subprocess.run(command, stderr=subprocess.DEVNULL, timeout=900, check=False).returncode == 0
    assert starts_of(sweep) == [2, 2]
    for number, angle in enumerate((20.0, 30.0)):
        run = Run(SweepFolder(sweep).run_folder(number))
        whole = thawslide.run(Case(case, {"basal.friction_angle": angle}), tmp_path / f"whole{number}", progress=False)
        assert len(run.facts["parts"]) == 2
        assert (run.series["mean_velocity_m_s"] == whole.series["mean_velocity_m_s"]).all()


def test_a_member_continues_after_the_death_of_its_worker(slope: Path, tmp_path: Path) -> None:
    sweep = tmp_path / "sweep"
    _, _, process, _ = start_slow(slope, sweep, "20", "--workers", "1")
    worker = SweepFolder(sweep).record(0)["process"]
    assert parent_of(worker) == process.pid  # not a process of anyone else
    os.kill(worker, signal.SIGKILL)
    assert process.wait(900) == 0
    assert starts_of(sweep) == [2]


def parent_of(process: int) -> int:
    return int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])


def test_a_failed_member_is_reported(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    command = [str(slope), "--vary", "body.block.velocity=[0.0, 0.0],[0.0, 300.0]", "--output", str(tmp_path / "sweep")]
    assert main(command) == 3
    table = pd.read_parquet(tmp_path / "sweep" / "members.parquet")
    assert list(table["status"]) == ["done", "failed"] and "the run failed at t = " in table["error"][1]
    assert table["peak_speed_m_s"].notna().tolist() == [True, False]
    assert "member 1: the run failed" in capfd.readouterr().err
    assert main(command) == 3 and starts_of(tmp_path / "sweep") == [1, 1]
    assert main([*command, "--retry-failed", "--max-failures", "0"]) == 2
    assert "1 members failed (allowed 0)" in capfd.readouterr().err


def test_invalid_keys_fail_before_any_run(slope: Path, tmp_path: Path) -> None:
    for vary, text in (
        ({"basal.friction_angl": [1.0]}, "did you mean"),
        ({"basal.friction_angle": [20.0, 95.0]}, "95"),
    ):
        with pytest.raises(UserError, match=text):
            thawslide.sweep(slope, tmp_path / "sweep", vary=vary, progress=False)
    vary, columns = {"band.thickness": [0.1]}, {"x": "maximum(time_s)"}
    with pytest.raises(ReportError, match="did you mean"):
        thawslide.sweep(slope, vary=vary, columns=columns, progress=False)
    assert not (tmp_path / "sweep").exists()


def test_a_block_sweep_has_the_numbers_of_single_blocks(slope: Path, tmp_path: Path) -> None:
    table = thawslide.sweep(
        slope, tmp_path / "sweep", ranges={"basal.friction_angle": (10.0, 30.0)}, sample="lhs:6", seed=4, block=True,
        progress=False,
    )  # fmt: skip
    rows = thawslide.block(Case(slope, {"basal.friction_angle": float(table["basal.friction_angle"][3])}))
    assert table["peak_speed_m_s"][3] == rows["velocity_m_s"].max()
    plan = json.loads((tmp_path / "sweep" / "sweep.json").read_text())
    assert plan["design"]["seed"] == 4 and plan["design"]["method"] == "lhs"


def test_a_file_describes_a_sweep(slope: Path, tmp_path: Path) -> None:
    file = tmp_path / "sweep.toml"
    file.write_text(
        '[sweep]\ncases = ["slope", "slope/steep.toml"]\nsample = "lhs:4"\nseed = 2\nblock = true\n\n'
        '[sweep.range]\n"basal.friction_angle" = [10, 20]\n\n[sweep.column]\nend = "last(velocity_m_s)"\n'
    )
    (slope.parent / "steep.toml").write_text('[case]\nbased_on = "case.toml"\n\n[band]\nthickness = 0.2\n')
    assert main([str(file), "--output", str(tmp_path / "sweep"), "--quiet"]) == 0
    table = pd.read_parquet(tmp_path / "sweep" / "members.parquet")
    assert sorted(Path(case).name for case in table["case"]) == ["case.toml"] * 2 + ["steep.toml"] * 2
    assert table["end"].notna().all()
    file.write_text('[sweep]\ncases = ["slope"]\nsmaple = "lhs:4"\n')
    assert main([str(file)]) == 2


@pytest.mark.parametrize("block", [False, True])
def test_members_depart_at_their_release_times(slope: Path, tmp_path: Path, block: bool) -> None:
    """Each member moves as the first one, which is released at the start, but later."""
    vary = {"body.block.release_time": [0.0, 0.1, 0.3]}
    table = thawslide.sweep(slope, tmp_path / "sweep", vary=vary, block=block, workers=2, progress=False)
    assert list(table["status"]) == ["done"] * 3
    series = [np.load(SweepFolder(tmp_path / "sweep").series_file(number)) for number in table["member"]]
    first = series[0]
    for release, found in zip(table["body.block.release_time"], series, strict=True):
        moves = found["time_s"] > release + 1e-6
        assert not found["speed_m_s"][~moves].any() and (found["speed_m_s"][moves] > 0.0).all()
        expected = np.interp(found["time_s"][moves] - release, first["time_s"], first["speed_m_s"])
        assert found["speed_m_s"][moves] == pytest.approx(expected, rel=1e-3)
    assert series[2]["speed_m_s"][-1] < 0.5 * first["speed_m_s"][-1]


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


def test_members_of_a_changed_input_run_again(sweep: Sweep, slope: Path, tmp_path: Path, capfd: Capture) -> None:
    before = speeds(tmp_path)
    assert sweep() == []
    (slope.parent / "b.csv").write_text(STEEP)
    capfd.readouterr()
    assert sweep() == [1, 3]
    assert "note: 2 of 4 members run again, because their inputs have changed" in capfd.readouterr().err
    after = speeds(tmp_path)
    assert after[::2] == before[::2] and after[1] == after[0] != before[1] and after[3] == after[2] != before[3]
    assert sweep() == []
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
