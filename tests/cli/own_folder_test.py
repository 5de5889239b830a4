"""A run writes only into the folder in which it began, and not into a replacement."""

from __future__ import annotations

import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from conftest import LIMIT, Program, content_of, run_facts, sets

LONG = sets(time__end=1000, time__output_interval=0.5, time__history_interval=0.1, checkpoint__interval=0.5)
Start = Callable[[Path], "subprocess.Popen[str]"]


def wait_for(file: Path) -> None:
    end = time.monotonic() + LIMIT
    while not file.exists():
        assert time.monotonic() < end, f"{file} does not appear"
        time.sleep(0.01)


@pytest.fixture
def started(binary: Path, small_case: Path) -> Iterator[Start]:
    """Return a function that starts a long run into a folder and waits for its first files."""
    processes: list[subprocess.Popen[str]] = []

    def start(run: Path) -> subprocess.Popen[str]:
        command = [str(binary), "run", str(small_case), "--output", str(run), "--threads", "1", *LONG]
        pipe = subprocess.PIPE
        processes.append(subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True))
        wait_for(run / "snapshots" / "000001.vtkhdf")
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.communicate()


def assert_stopped(process: subprocess.Popen[str], run: Path) -> None:
    _, message = process.communicate(timeout=LIMIT)
    assert process.returncode == 5
    assert message.startswith(f"error: {run} is no longer the folder in which this run began: ")
    assert "continues from the last checkpoint.\nstopped at t = " in message and "resume " + str(run) not in message


def test_a_run_whose_folder_was_moved_does_not_change_its_replacement(
    thawslide: Program, started: Start, small_case: Path, tmp_path: Path
) -> None:
    run, moved, alone = (tmp_path / name for name in ("run", "moved", "alone"))
    process = started(run)
    run.rename(moved)
    for folder in (run, alone):
        assert thawslide("run", small_case, "--output", folder).returncode == 0
    assert_stopped(process, run)
    assert {path.relative_to(run) for path in content_of(run)} == {
        path.relative_to(alone) for path in content_of(alone)
    }
    assert (run / "history.csv").read_bytes() == (alone / "history.csv").read_bytes()
    assert (run / "checkpoint.bin").read_bytes() == (alone / "checkpoint.bin").read_bytes()
    assert run_facts(run)["status"] == "done"
    # The moved run can be resumed.
    reached = run_facts(moved)["simulated_time_s"]
    outcome = thawslide("resume", moved, "--end", reached + 1)
    assert outcome.returncode == 0, outcome.stderr


def test_a_run_does_not_restore_its_removed_folder(started: Start, tmp_path: Path) -> None:
    run = tmp_path / "run"
    process = started(run)
    run.rename(tmp_path / "to be removed")
    shutil.rmtree(tmp_path / "to be removed")
    assert_stopped(process, run)
    assert not run.exists()


def test_a_run_whose_lock_is_removed_stops(thawslide: Program, started: Start, tmp_path: Path) -> None:
    run = tmp_path / "run"
    process = started(run)
    (run / "run.lock").unlink()
    assert_stopped(process, run)
    outcome = thawslide("resume", run, "--end", run_facts(run)["simulated_time_s"] + 1)
    assert outcome.returncode == 0, outcome.stderr
