"""Runs on a file system without locks, like some network disks: the lock file names the running process."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import LAMPLUGH, LIMIT, Program, assert_bitwise_identical, run_facts, sets
from faults import FAILING_WRITES, mark_killed, running_in


@pytest.fixture
def without_locks(plain_environment: dict[str, str]) -> dict[str, str]:
    if not FAILING_WRITES.exists():
        pytest.skip(f"{FAILING_WRITES} is not built")
    return plain_environment | {"LD_PRELOAD": str(FAILING_WRITES), "FAULT_LOCKS": "absent"}


@pytest.fixture
def running(binary: Path, without_locks: dict[str, str], tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Yield the process of a run into tmp_path / run."""
    with running_in(tmp_path / "run", binary, without_locks) as process:
        yield process


def test_a_second_process_is_refused_while_the_first_runs(
    thawslide: Program, running: subprocess.Popen[str], without_locks: dict[str, str], tmp_path: Path
) -> None:
    run = tmp_path / "run"
    process = f"process {running.pid} on {socket.gethostname()}"
    message = (
        f"error: {run} is being written by {process}. Wait until that has ended, or stop it. Its file system has no "
        f"locks: if that process is no run any more, remove {run / 'run.lock'}.\n"
    )
    for words in (["resume", run], ["run", LAMPLUGH, "--output", run, "--overwrite"]):
        outcome = thawslide(*words, environment=without_locks)
        assert (outcome.returncode, outcome.stderr) == (2, message)
    outcome = thawslide("run", LAMPLUGH, "--output", run, environment=without_locks)
    assert outcome.returncode == 2 and f"{run} is being written by {process}. Specify another" in outcome.stderr
    assert running.poll() is None and (run / "history.csv").exists()
    assert thawslide("status", run, environment=without_locks).stdout.startswith(f"{run}: running, by {process}\n")

    running.kill()
    running.communicate(timeout=LIMIT)
    reported = json.loads(thawslide("status", run, "--json", environment=without_locks).stdout)
    assert (reported["state"], reported["process"]) == ("killed", "")
    end = run_facts(run)["parts"][0]
    assert end["from_s"] == 0
    outcome = thawslide(
        "run", LAMPLUGH, "--output", run, "--overwrite", *sets(time__end=0.1), environment=without_locks
    )
    assert outcome.returncode == 0, outcome.stderr


def test_a_stopped_run_removes_its_lock_file(
    thawslide: Program, running: subprocess.Popen[str], without_locks: dict[str, str], tmp_path: Path
) -> None:
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=LIMIT)
    assert running.returncode == 4
    assert not (tmp_path / "run" / "run.lock").exists()
    reported = json.loads(thawslide("status", tmp_path / "run", "--json", environment=without_locks).stdout)
    assert reported["state"] == "stopped"


def test_a_process_of_another_machine_counts_as_running(
    thawslide: Program, without_locks: dict[str, str], small_case: Path, done: Path, tmp_path: Path
) -> None:
    """It counts until a user removes the lock file; on file systems with locks, these decide."""
    mark_killed(done)
    lock = done / "run.lock"
    lock.write_text("process 12 on elsewhere\n")
    before = (done / "history.csv").read_bytes()
    message = (
        f"error: {done} may be being written by process 12 on elsewhere: its file system has no locks, and this "
        f"machine cannot determine whether that process exists. If it has surely ended, remove {lock}.\n"
    )
    for words in (["resume", done], ["run", small_case, "--output", done, "--overwrite"]):
        outcome = thawslide(*words, environment=without_locks)
        assert (outcome.returncode, outcome.stderr) == (2, message)
    assert (done / "history.csv").read_bytes() == before
    status = thawslide("status", done, environment=without_locks).stdout
    assert status.startswith(
        f"{done}: it cannot be determined whether it runs, because its file system has no locks and process 12 on "
        f"elsewhere has "
        "begun to write it; its last file was written "
    )
    assert status.endswith(f"  if that has surely ended: remove {lock}, then thawslide resume {done}\n")
    reported = json.loads(thawslide("status", done, "--json", environment=without_locks).stdout)
    assert (reported["state"], reported["process"]) == ("unknown", "process 12 on elsewhere")
    lock.unlink()
    outcome = thawslide("resume", done, environment=without_locks)
    assert outcome.returncode == 0, outcome.stderr
    assert not lock.exists()
    complete = tmp_path / "complete"
    assert thawslide("run", small_case, "--output", complete).returncode == 0
    assert_bitwise_identical(done, complete)
