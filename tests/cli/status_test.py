"""State of a run, one process per folder, signals, and runs whose folder was moved, removed or unlocked.

With and without file locks.
"""

import fcntl
import re
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from conftest import HANG, LAMPLUGH, Program, Ran, content_of, run_facts, sets
from faults import FAILING_WRITES, running_in

Process = subprocess.Popen[str]
KILLED = "terminated unexpectedly: the process was killed, the machine stopped, or the disk was full"


@pytest.fixture(scope="session")
def without_locks(plain_environment: dict[str, str]) -> dict[str, str]:
    """Return the environment of a file system without locks, like some network disks."""
    if not FAILING_WRITES.exists():
        pytest.skip(f"{FAILING_WRITES} is not built")
    return plain_environment | {"LD_PRELOAD": str(FAILING_WRITES), "FAULT_LOCKS": "absent"}


@pytest.fixture(params=["locks", "no locks"])
def environment(request: pytest.FixtureRequest, plain_environment: dict[str, str]) -> dict[str, str]:
    if request.param == "locks":
        return plain_environment
    found: dict[str, str] = request.getfixturevalue("without_locks")
    return found


@pytest.fixture
def running(binary: Path, environment: dict[str, str], tmp_path: Path) -> Iterator[Process]:
    with running_in(tmp_path / "run", binary, environment) as process:
        yield process


with_locks = pytest.mark.parametrize("environment", ["locks"], indirect=True)


@with_locks
def test_status_of_running_and_killed_runs(thawslide: Program, running: Process, run: Path) -> None:
    printed = thawslide.ok("status", run)
    process = f"process {running.pid} on {socket.gethostname()}"
    assert re.fullmatch(
        rf"{re.escape(str(run))}: running, by {re.escape(process)}\n  \S+ of 150 s simulated \(\d %\)(, about .* "
        r"left)?\n  last checkpoint .* ago\n",
        printed,
    ), printed
    facts = thawslide.json("status", run)
    assert facts["state"] == "running" and facts["process"] == process
    assert 0.1 <= facts["simulated_time_s"] < facts["end_s"] == 150
    assert facts["time_left_s"] is None or facts["time_left_s"] > 0
    # The end is not known if the case is damaged.
    (run / "case.toml").rename(run / "kept")
    (run / "case.toml").write_text("[time\n")
    first, second, *_ = thawslide.ok("status", run).splitlines()
    assert first == f"{run}: running, by {process}"
    assert re.match(rf"  \S+ s simulated; its end is not known: {re.escape(str(run / 'case.toml'))}:1:", second), second
    facts = thawslide.json("status", run)
    assert (facts["state"], facts["process"], facts["end_s"]) == ("running", process, None)

    running.kill()
    running.communicate(timeout=HANG)
    assert run_facts(run)["status"] == "running"
    assert thawslide.json("status", run)["state"] == "killed"
    (run / "kept").rename(run / "case.toml")
    printed = thawslide.ok("status", run)
    assert printed.startswith(f"{run}: {KILLED}\n") and printed.endswith(f"  to continue: thawslide resume {run}\n")
    assert thawslide.json("status", run)["state"] == "killed"


def test_a_second_process_in_a_folder_is_refused(
    thawslide: Program, running: Process, environment: dict[str, str], plain_environment: dict[str, str], tmp_path: Path
) -> None:
    run, given = tmp_path / "run", {"environment": environment}
    process = f"process {running.pid} on {socket.gethostname()}"
    remedy = f" Its file system has no locks: if that process is no run any more, remove {run / 'run.lock'}."
    locks = "" if environment == plain_environment else remedy
    message = f"error: {run} is being written by {process}. Wait until that has ended, or stop it.{locks}\n"
    for words in (["resume", run], ["run", LAMPLUGH, "--output", run, "--overwrite"]):
        assert thawslide.error(*words, **given) == message
    refused = thawslide.error("run", LAMPLUGH, "--output", run, **given)
    assert f"{run} is being written by {process}. Specify another" in refused
    assert running.poll() is None and (run / "history.csv").exists()
    assert thawslide.ok("status", run, **given).startswith(f"{run}: running, by {process}\n")
    running.kill()
    running.communicate(timeout=HANG)
    reported = thawslide.json("status", run, **given)
    assert (reported["state"], reported["process"]) == ("killed", "")
    assert run_facts(run)["parts"][0]["from_s"] == 0
    thawslide.ok("run", LAMPLUGH, "--output", run, "--overwrite", *sets(time__end=0.1), **given)


def test_a_stop_unlocks(thawslide: Program, running: Process, environment: dict[str, str], tmp_path: Path) -> None:
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=HANG)
    assert running.returncode == 4
    assert not (tmp_path / "run" / "run.lock").exists()
    assert thawslide.json("status", tmp_path / "run", environment=environment)["state"] == "stopped"


def test_a_second_signal_stops_at_once(thawslide: Program, small_case: Path, run: Path) -> None:
    # The last step and the files take long.
    fine = sets(grid__cell=0.1, body__block__particles_per_axis=8, time__step=0.0001, time__history_interval=0.0001)
    with thawslide.start("run", small_case, "--output", run, *fine, stdout=subprocess.DEVNULL) as process:
        while not (run / "history.csv").exists() or (run / "history.csv").read_text().count("\n") < 4:
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        while not re.search(r"^ShdPnd:\t0+$", Path(f"/proc/{process.pid}/status").read_text(), re.MULTILINE):
            time.sleep(0.001)  # the first one is still pending
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=HANG) == -signal.SIGINT
    assert thawslide.json("status", run)["state"] == "killed"


def test_runs_that_have_ended(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run, begin = tmp_path / "run", time.time()
    thawslide.ok("run", small_case, "--output", run)
    assert thawslide.ok("status", run) == f"{run}: done\n  0.2 of 0.2 s simulated\n"
    reported = thawslide.json("status", run)
    age = reported.pop("checkpoint_age_s")
    assert 0 <= age <= time.time() - begin + 1
    assert reported == {
        "state": "done", "message": "", "process": "", "simulated_time_s": pytest.approx(0.2), "end_s": 0.2,
        "time_left_s": None,
    }  # fmt: skip


def test_a_run_in_its_setup_is_running(thawslide: Program, tmp_path: Path) -> None:
    (tmp_path / "run.lock").write_text("process 7 on here\n")
    with (tmp_path / "run.lock").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        printed = thawslide.ok("status", tmp_path)
    assert printed.startswith(f"{tmp_path}: running, by process 7 on here\n")
    thawslide.error("status", tmp_path)


@pytest.mark.parametrize(("command", "remedy"), [("status", ""), ("resume", ", or run the case again")])
def test_a_folder_without_a_run_is_refused(thawslide: Program, tmp_path: Path, command: str, remedy: str) -> None:
    assert thawslide.error(command, tmp_path) == (
        f"error: {tmp_path} is not a run folder: run.json not found. Specify the folder that `thawslide run` printed"
        f"{remedy}.\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_a_run_does_not_replace_its_own_case(thawslide: Program, done: Path) -> None:
    assert thawslide.error("run", done, "--output", done, "--overwrite") == (
        f"error: {done / 'case.toml'} lies in the output folder {done}. Give another --output, or continue that run: "
        "thawslide resume.\n"
    )
    assert (done / "case.toml").exists() and (done / "history.csv").exists()


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
    _, errors = process.communicate(timeout=HANG)
    stop, run = run_facts(tmp_path / "run")["simulated_time_s"], tmp_path / "run"
    assert errors == f"interrupted by signal 15 at t = {stop:g} s. To continue: thawslide resume {run}\n"
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
