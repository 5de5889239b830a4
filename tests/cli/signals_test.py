"""Signals during a run, and runs whose folder was moved, removed or unlocked."""

import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from conftest import HANG, Program, Ran, content_of, run_facts, sets

LONG = sets(time__end=1000, time__output_interval=0.5, time__history_interval=0.1, checkpoint__interval=0.5)
SETTLES = sets(mechanics__initial_stress="settle", mechanics__settle_time=1000, mechanics__settle_damping=10)
Process = subprocess.Popen
Start = Callable[..., "Process[str]"]


@pytest.fixture
def started(thawslide: Program, small_case: Path) -> Iterator[Start]:
    """Return a function that starts a long run into a folder and waits for one of its files.

    The parent can ignore a signal, as nohup does with SIGHUP.
    """
    processes: list[Process[str]] = []

    def start(run: Path, file: str, *words: str, ignored: signal.Signals | None = None) -> Process[str]:
        def ignore() -> None:
            if ignored:
                signal.signal(ignored, signal.SIG_IGN)

        command = ("run", small_case, "--output", run, "--threads", 1, *words)
        processes.append(thawslide.start(*command, stdout=subprocess.DEVNULL, preexec_fn=ignore))
        while not (run / file).exists():
            assert processes[-1].poll() is None, f"{file} does not appear"
            time.sleep(0.01)
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("ignored", [signal.SIGHUP, signal.SIGINT])
def test_ignored_signals_remain_ignored(started: Start, tmp_path: Path, ignored: signal.Signals) -> None:
    process = started(tmp_path / "run", "checkpoint.bin", *sets(time__end=1000), ignored=ignored)
    process.send_signal(ignored)
    time.sleep(0.3)
    assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    assert f"interrupted by signal {int(signal.SIGTERM)} at t = " in process.communicate(timeout=HANG)[1]
    assert process.returncode == 4


def test_a_signal_ends_the_settling(thawslide: Program, started: Start, run: Path) -> None:
    process = started(run, "run.json", *SETTLES)
    time.sleep(0.3)
    process.send_signal(signal.SIGTERM)
    message = process.communicate(timeout=HANG)[1]
    assert process.returncode == 4
    assert message == f"interrupted by signal 15 while the body settled. To start again: thawslide resume {run}\n"
    facts = run_facts(run)
    assert (facts["status"], facts["message"], facts["simulated_time_s"]) == ("stopped", "signal 15", 0.0)
    assert thawslide.ok("status", run).startswith(f"{run}: stopped")


def assert_stopped(process: Process[str], run: Path) -> None:
    _, message = process.communicate(timeout=HANG)
    assert process.returncode == 5
    assert message.startswith(f"error: {run} is no longer the folder in which this run began: ")
    assert "continues from the last checkpoint.\nstopped at t = " in message and "resume " + str(run) not in message


SECOND = "snapshots/000001.vtkhdf"


def test_a_moved_run_does_not_change_another(thawslide: Program, started: Start, ran: Ran, tmp_path: Path) -> None:
    process = started(tmp_path / "run", SECOND, *LONG)
    moved = (tmp_path / "run").rename(tmp_path / "moved")
    run, alone = (ran(*sets(time__end=0.2), name=name) for name in ("run", "alone"))
    assert_stopped(process, run)
    files, expected = ({path.relative_to(folder) for path in content_of(folder)} for folder in (run, alone))
    assert files == expected
    for name in ("history.csv", "checkpoint.bin"):
        assert (run / name).read_bytes() == (alone / name).read_bytes()
    assert run_facts(run)["status"] == "done"
    # The moved run can be resumed.
    thawslide.ok("resume", moved, "--end", run_facts(moved)["simulated_time_s"] + 1)


def test_a_run_does_not_restore_its_removed_folder(started: Start, tmp_path: Path, run: Path) -> None:
    process = started(run, SECOND, *LONG)
    shutil.rmtree(run.rename(tmp_path / "to be removed"))
    assert_stopped(process, run)
    assert not run.exists()


def test_a_run_whose_lock_is_removed_stops(thawslide: Program, started: Start, run: Path) -> None:
    process = started(run, SECOND, *LONG)
    (run / "run.lock").unlink()
    assert_stopped(process, run)
    thawslide.ok("resume", run, "--end", run_facts(run)["simulated_time_s"] + 1)
