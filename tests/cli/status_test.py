"""State and progress of a run, with and without file locks; one process per folder; repeated signals."""

import fcntl
import os
import re
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import HANG, LAMPLUGH, Program, Ran, assert_identical, mark_killed, run_facts, sets
from faults import FAILING_WRITES, running_in

Process = subprocess.Popen[str]
KILLED = "terminated unexpectedly: the process was killed, the machine stopped, or the disk was full"
NO_LOCKS = "it cannot be determined whether it runs, because its file system has no locks"


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


@with_locks
@pytest.mark.parametrize(("first", "second"), [(signal.SIGINT, signal.SIGINT), (signal.SIGTERM, signal.SIGINT)])
def test_a_second_signal_stops_at_once(
    thawslide: Program, running: Process, tmp_path: Path, first: signal.Signals, second: signal.Signals
) -> None:
    running.send_signal(signal.SIGSTOP)  # both are pending: the second arrives before the first is handled
    running.send_signal(first)
    if first != second:
        running.send_signal(second)
    running.send_signal(signal.SIGCONT)
    if first == second:
        running.send_signal(second)
    code = running.wait(timeout=HANG)
    assert code in (-second, -first, 4)  # 4: step and files were complete before the second signal
    if code != 4:
        assert thawslide.json("status", tmp_path / "run")["state"] == "killed"


def test_without_locks_the_state_is_unknown(thawslide: Program, without_locks: dict[str, str], ran: Ran) -> None:
    run, given = ran(), {"environment": without_locks}
    mark_killed(run)
    (run / "run.lock").touch()
    long_ago = time.time() - 300
    for file in run.rglob("*"):
        os.utime(file, (long_ago, long_ago))
    status = thawslide.ok("status", run, **given)
    start = re.escape(f"{run}: {NO_LOCKS}; its last file was written ")
    assert re.match(start + r"[5-9](\.\d)? min ago\n", status), status
    assert status.endswith(f"  if nothing writes there any more: thawslide resume {run}\n")
    reported = thawslide.json("status", run, **given)
    assert reported["state"] == "unknown" and 0 <= reported["last_write_age_s"] - 300 <= time.time() - long_ago - 299
    assert thawslide.json("status", run)["state"] == "killed"


def test_a_process_of_another_machine_counts_as_running(
    thawslide: Program, without_locks: dict[str, str], small_case: Path, finished: Path, killed: Path
) -> None:
    """It counts until a user removes the lock file; on file systems with locks, these decide."""
    lock, given = killed / "run.lock", {"environment": without_locks}
    lock.write_text("process 12 on elsewhere\n")
    before = (killed / "history.csv").read_bytes()
    message = (
        f"error: {killed} may be being written by process 12 on elsewhere: its file system has no locks, and this "
        f"machine cannot determine whether that process exists. If it has surely ended, remove {lock}.\n"
    )
    for words in (["resume", killed], ["run", small_case, "--output", killed, "--overwrite"]):
        assert thawslide.error(*words, **given) == message
    assert (killed / "history.csv").read_bytes() == before
    status = thawslide.ok("status", killed, **given)
    start = f"{NO_LOCKS} and process 12 on elsewhere has begun to write it; its last file was written "
    assert status.startswith(f"{killed}: {start}")
    assert status.endswith(f"  if that has surely ended: remove {lock}, then thawslide resume {killed}\n")
    reported = thawslide.json("status", killed, **given)
    assert (reported["state"], reported["process"]) == ("unknown", "process 12 on elsewhere")
    lock.unlink()
    thawslide.ok("resume", killed, **given)
    assert not lock.exists()
    assert_identical(killed, finished)


def test_runs_that_have_ended(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run, begin = tmp_path / "run", time.time()
    thawslide.ok("run", small_case, "--output", run)
    assert thawslide.ok("status", run) == f"{run}: done\n  0.2 of 0.2 s simulated\n"
    reported = thawslide.json("status", run)
    ages = {name: reported[name] for name in ("last_write_age_s", "checkpoint_age_s")}
    assert all(0 <= age <= time.time() - begin + 1 for age in ages.values())
    assert reported == {
        "state": "done", "message": "", "process": "", "simulated_time_s": pytest.approx(0.2), "end_s": 0.2,
        "time_left_s": None, **ages,
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
