"""Sweeps end to end: tables, restarts, failures, deaths of workers, and errors before any run."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import Capture

import thawslide
from thawslide import Case, Run, UserError
from thawslide.errors import ReportError
from thawslide.sweeps.command import main
from thawslide.sweeps.folder import SweepFolder

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


def test_titles_may_be_long_and_columns_may_not_replace_others(slope: Path, tmp_path: Path) -> None:
    command = [str(slope), "--block", "--set", f"case.title={'x' * 300}", "--vary", "basal.friction_angle=20,30"]
    assert main([*command, "--output", str(tmp_path / "sweep")]) == 0
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


def test_a_killed_sweep_continues_from_checkpoints(slope: Path, tmp_path: Path) -> None:
    sweep = tmp_path / "sweep"
    case, command, process, checkpoints = start_slow(slope, sweep, "20,30", "--keep", "all", "--workers", "2")
    os.killpg(process.pid, signal.SIGKILL)  # with its workers
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
