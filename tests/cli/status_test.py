"""State and progress of a run, and how to continue; one process per folder; repeated signals."""

from __future__ import annotations

import fcntl
import json
import os
import re
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import LAMPLUGH, LIMIT, Program, run_facts
from faults import FAILING_WRITES, running_in


@pytest.fixture
def running(binary: Path, plain_environment: dict[str, str], tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Yield the process of a run into tmp_path / run."""
    with running_in(tmp_path / "run", binary, plain_environment) as process:
        yield process


def test_status_of_a_running_and_a_killed_run(
    thawslide: Program, running: subprocess.Popen[str], tmp_path: Path
) -> None:
    run = tmp_path / "run"
    outcome = thawslide("status", run)
    assert outcome.returncode == 0, outcome.stderr
    process = f"process {running.pid} on {socket.gethostname()}"
    assert re.fullmatch(
        rf"{re.escape(str(run))}: running, by {re.escape(process)}\n"
        r"  \S+ of 150 s simulated \(\d %\)(, about .* left)?\n"
        r"  last checkpoint .* ago\n",
        outcome.stdout,
    ), outcome.stdout
    facts = json.loads(thawslide("status", run, "--json").stdout)
    assert facts["state"] == "running" and facts["process"] == process
    assert 0.1 <= facts["simulated_time_s"] < facts["end_s"] == 150
    assert facts["time_left_s"] is None or facts["time_left_s"] > 0

    running.kill()
    running.communicate(timeout=LIMIT)
    assert run_facts(run)["status"] == "running"
    outcome = thawslide("status", run)
    assert outcome.returncode == 0
    assert outcome.stdout.startswith(
        f"{run}: terminated unexpectedly: the process was killed, the machine stopped, or the disk was full\n"
    )
    assert outcome.stdout.endswith(f"  to continue: thawslide resume {run}\n")
    assert json.loads(thawslide("status", run, "--json").stdout)["state"] == "killed"


def test_a_second_process_in_a_folder_is_refused(
    thawslide: Program, running: subprocess.Popen[str], tmp_path: Path
) -> None:
    run = tmp_path / "run"
    message = (
        f"error: {run} is being written by process {running.pid} on {socket.gethostname()}. Wait until that has ended, "
        "or stop it.\n"
    )
    for words in (["resume", run], ["run", LAMPLUGH, "--output", run, "--overwrite"]):
        outcome = thawslide(*words)
        assert outcome.returncode == 2
        assert outcome.stderr == message
    outcome = thawslide("run", LAMPLUGH, "--output", run)
    assert outcome.returncode == 2
    writer = f"process {running.pid} on {socket.gethostname()}"
    assert f"{run} is being written by {writer}. Specify another" in outcome.stderr
    assert running.poll() is None and (run / "history.csv").exists()


@pytest.mark.parametrize(("first", "second"), [(signal.SIGINT, signal.SIGINT), (signal.SIGTERM, signal.SIGINT)])
def test_a_second_signal_stops_at_once(
    thawslide: Program, running: subprocess.Popen[str], tmp_path: Path, first: signal.Signals, second: signal.Signals
) -> None:
    running.send_signal(signal.SIGSTOP)  # both are pending: the second arrives before the first is handled
    running.send_signal(first)
    if first != second:
        running.send_signal(second)
    running.send_signal(signal.SIGCONT)
    if first == second:
        running.send_signal(second)
    code = running.wait(timeout=LIMIT)
    assert code in (-second, -first, 4)  # 4: step and files were complete before the second signal
    if code != 4:
        assert json.loads(thawslide("status", tmp_path / "run", "--json").stdout)["state"] == "killed"


def test_without_locks_the_state_is_unknown(
    thawslide: Program, plain_environment: dict[str, str], small_case: Path, tmp_path: Path
) -> None:
    if not FAILING_WRITES.exists():
        pytest.skip(f"{FAILING_WRITES} is not built")
    without = plain_environment | {"LD_PRELOAD": str(FAILING_WRITES), "FAULT_LOCKS": "absent"}
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run, environment=without).returncode == 0
    facts = run_facts(run) | {"status": "running"}
    (run / "run.json").write_text(json.dumps(facts))
    (run / "run.lock").touch()
    long_ago = time.time() - 300
    for file in run.rglob("*"):
        os.utime(file, (long_ago, long_ago))
    status = thawslide("status", run, environment=without).stdout
    assert re.match(
        re.escape(
            f"{run}: it cannot be determined whether it runs, because its file system has no locks; its last file was "
            "written "
        )
        + r"5(\.\d)? min ago\n",
        status,
    ), status
    assert status.endswith(f"  if nothing writes there any more: thawslide resume {run}\n")
    reported = json.loads(thawslide("status", run, "--json", environment=without).stdout)
    assert reported["state"] == "unknown" and reported["last_write_age_s"] == pytest.approx(300, abs=60)
    assert json.loads(thawslide("status", run, "--json").stdout)["state"] == "killed"


def test_runs_that_have_ended(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    outcome = thawslide("status", run)
    assert outcome.stdout == f"{run}: done\n  0.2 of 0.2 s simulated\n"
    assert json.loads(thawslide("status", run, "--json").stdout) == {
        "state": "done",
        "message": "",
        "process": "",
        "simulated_time_s": pytest.approx(0.2),
        "end_s": 0.2,
        "last_write_age_s": pytest.approx(30, abs=30),
        "checkpoint_age_s": pytest.approx(30, abs=30),
        "time_left_s": None,
    }


def test_status_with_a_damaged_case_names_the_process(
    thawslide: Program, running: subprocess.Popen[str], tmp_path: Path
) -> None:
    run = tmp_path / "run"
    (run / "case.toml").write_text("[time\n")
    process = f"process {running.pid} on {socket.gethostname()}"
    outcome = thawslide("status", run)
    assert outcome.returncode == 0, outcome.stderr
    first, second, *_ = outcome.stdout.splitlines()
    assert first == f"{run}: running, by {process}"
    assert re.match(rf"  \S+ s simulated; its end is not known: {re.escape(str(run / 'case.toml'))}:1:", second), second
    facts = json.loads(thawslide("status", run, "--json").stdout)
    assert (facts["state"], facts["process"], facts["end_s"]) == ("running", process, None)
    running.kill()
    running.communicate(timeout=LIMIT)
    assert json.loads(thawslide("status", run, "--json").stdout)["state"] == "killed"


def test_a_run_in_its_setup_is_running(thawslide: Program, tmp_path: Path) -> None:
    (tmp_path / "run.lock").write_text("process 7 on here\n")
    with (tmp_path / "run.lock").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        outcome = thawslide("status", tmp_path)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(f"{tmp_path}: running, by process 7 on here\n")
    assert thawslide("status", tmp_path).returncode == 2


def test_status_without_a_run_is_an_error(thawslide: Program, tmp_path: Path) -> None:
    outcome = thawslide("status", tmp_path)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {tmp_path} is not a run folder: run.json not found. Specify the folder that `thawslide run` printed.\n"
    )


def test_a_run_does_not_replace_its_own_case(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    outcome = thawslide("run", run, "--output", run, "--overwrite")
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {run / 'case.toml'} lies in the output folder {run}. Give another --output, or continue that run: "
        "thawslide resume.\n"
    )
    assert (run / "case.toml").exists() and (run / "history.csv").exists()
