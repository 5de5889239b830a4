"""Interrupted sweeps: members whose files cannot be written, Ctrl-C in a terminal, and kills at random moments.

Ctrl-C reaches all processes of a sweep, also workers that are just starting.
"""

import contextlib
import errno
import fcntl
import os
import random
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

import thawslide
from thawslide import Case
from thawslide.errors import ReportError
from thawslide.sweeps.folder import DONE, RUNNING, SweepFolder
from thawslide.sweeps.member import MemberInterruptedError, Task, perform

# Python ignores SIGXFSZ: a write beyond the limit is an error, as on a full disk.
ON_FULL_DISK = """
import resource, sys
from pathlib import Path
from thawslide import Case
from thawslide.sweeps.member import MemberInterruptedError, Task, perform
resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
try:
    perform(Task(0, Path(sys.argv[1]), Case(sys.argv[2])))
except MemberInterruptedError as error:
    print(error)
"""


def test_a_run_on_a_full_disk_continues_later(slope: Path, tmp_path: Path) -> None:
    folder = SweepFolder(tmp_path / "sweep")
    (folder.path / "members").mkdir(parents=True)
    command = [sys.executable, "-c", ON_FULL_DISK, str(folder.path), str(slope)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "File too large" in done.stdout, done.stderr
    assert folder.record(0)["status"] == RUNNING
    record = perform(Task(0, folder.path, Case(slope)))
    assert record["status"] == DONE and record["starts"] == 2


def test_a_sweep_ends_with_an_error_if_a_member_cannot_write(slope: Path, tmp_path: Path) -> None:
    folder = SweepFolder(tmp_path / "sweep")
    vary = {"basal.friction_angle": [20.0, 30.0, 40.0]}

    def sweep() -> list[int]:
        table = thawslide.sweep(slope, folder.path, vary=vary, block=True, workers=1, progress=False)
        return list(table["starts"])

    assert sweep() == [1, 1, 1]
    for number in (1, 2):
        folder.record_file(number).unlink()
    series = folder.series_file(1)
    series.unlink()
    series.mkdir()  # a file cannot replace it
    with pytest.raises(ReportError, match=r"member 1: interrupted: .*directory.* To continue, repeat the command"):
        sweep()
    assert folder.record(1)["status"] == RUNNING
    series.rmdir()
    assert sweep()[1] == 2


def test_without_locks_the_named_process_decides(slope: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_locks(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", no_locks)
    folder = SweepFolder(tmp_path / "sweep")
    lock = folder.run_folder(0) / "run.lock"
    lock.parent.mkdir(parents=True)
    task = Task(0, folder.path, Case(slope))
    for process in (f"process {os.getppid()} on {socket.gethostname()}", "process 1 on another-machine"):
        lock.write_text(f"{process}\n")
        with pytest.raises(MemberInterruptedError, match=f"written by {process}, .* remove .*run.lock"):
            perform(task)
    assert folder.record(0)["starts"] == 0
    with subprocess.Popen(["true"]) as ended:
        ended.wait()
    lock.write_text(f"process {ended.pid} on {socket.gethostname()}\n")
    assert perform(task)["status"] == DONE


SEED, KILLS, MEMBERS = 1, 10, 40
MOST_WAIT = 3.0  # seconds from the start of a member to a kill
DURING_START = 0.2  # fraction of the kills that do not wait for a member
SLOW = '[case]\nbased_on = "case.toml"\n[time]\nend = {end}\nstep = {step}\n[checkpoint]\ninterval = 0.1\n'


def start(case: Path, sweep: Path) -> subprocess.Popen[bytes]:
    """Start or continue the sweep in a session of its own."""
    angles = ",".join(str(15 + number) for number in range(MEMBERS))
    command = [sys.executable, "-m", "thawslide.sweeps.command", str(case), "--vary", f"basal.friction_angle={angles}"]
    command += ["--workers", "2", "--output", str(sweep)]
    return subprocess.Popen(command, stderr=subprocess.DEVNULL, start_new_session=True)


def workers_of(driver: int) -> list[int]:
    try:
        files = list(Path(f"/proc/{driver}/task").glob("*/children"))
        return [int(number) for file in files for number in file.read_text().split()]
    except OSError:  # a thread of the driver has ended
        return []


@pytest.mark.parametrize("delay", [0.0, 1.0, 4.0])
def test_ctrl_c_prints_one_line_and_the_sweep_continues(slope: Path, tmp_path: Path, delay: float) -> None:
    case, folder = slope.with_name("slow.toml"), SweepFolder(tmp_path / "sweep")
    case.write_text(SLOW.format(end=3.0, step=0.00005))
    words = [str(case), "--vary", "basal.friction_angle=20,25,30,35", "--workers", "2", "--quiet"]
    command = [sys.executable, "-m", "thawslide.sweeps.command", *words, "--output", str(folder.path)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        while len(workers_of(process.pid)) < 3:  # two workers, and the tracker of resources
            assert process.poll() is None
            time.sleep(0.02)
        time.sleep(delay)
        os.killpg(process.pid, signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
    assert "Traceback" not in errors and process.returncode == 4, errors
    assert errors.endswith("interrupted. All finished members are kept. To continue, repeat the command.\n")
    assert not any(folder.record(number)["status"] == "failed" for number in range(4))


def is_running(folder: SweepFolder, driver: int) -> bool:
    workers = workers_of(driver)
    records = [folder.record(number) for number in range(MEMBERS)]
    return any(record["status"] == RUNNING and record["process"] in workers for record in records)


def done_starts(folder: SweepFolder) -> dict[int, int]:
    records = {number: folder.record(number) for number in range(MEMBERS)}
    return {number: record["starts"] for number, record in records.items() if record["status"] == DONE}


@pytest.mark.long
def test_ten_kills_at_random_moments_do_not_change_the_table(slope: Path, tmp_path: Path) -> None:
    case = slope.with_name("slow.toml")
    case.write_text(SLOW.format(end=6.0, step=0.0001))
    whole, killed = SweepFolder(tmp_path / "whole"), SweepFolder(tmp_path / "killed")
    assert start(case, whole.path).wait(1800) == 0

    moments = random.Random(SEED)
    finished: dict[int, int] = {}
    process, kills = start(case, killed.path), {"driver": 0, "worker": 0, "all": 0}
    while sum(kills.values()) < KILLS:
        waits = moments.random() > DURING_START
        while waits and process.poll() is None and not is_running(killed, process.pid):
            time.sleep(0.1)
        time.sleep(moments.uniform(0.0, MOST_WAIT))
        target = moments.choice(list(kills))
        assert process.poll() is None, f"the sweep ended after {kills}"
        workers = workers_of(process.pid)
        if target == "worker" and not workers:
            continue  # they have not started yet
        with contextlib.suppress(ProcessLookupError):
            if target == "all":
                os.killpg(process.pid, signal.SIGKILL)
            else:
                os.kill(moments.choice(workers) if target == "worker" else process.pid, signal.SIGKILL)
        kills[target] += 1
        if target != "worker":
            process.wait()
            process = start(case, killed.path)
        now = done_starts(killed)
        assert finished.items() <= now.items()
        finished = now
    assert process.wait(1800) == 0
    assert finished.items() <= done_starts(killed).items()  # no finished member started again

    found, expected = (pd.read_parquet(each.path / "members.parquet") for each in (killed, whole))
    assert list(expected["starts"]) == [1] * MEMBERS and found["starts"].sum() > MEMBERS
    pd.testing.assert_frame_equal(found.drop(columns=["starts", "wall_s"]), expected.drop(columns=["starts", "wall_s"]))
    print(f"\nkills: {kills}; starts: {list(found['starts'])}; done before the last kill: {len(finished)}")
