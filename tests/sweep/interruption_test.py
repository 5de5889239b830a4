"""Interrupted sweeps: members whose files cannot be written, and Ctrl-C in a terminal.

Ctrl-C reaches all processes of a sweep, also workers that are just starting.
"""

import errno
import fcntl
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

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


SLOW = '[case]\nbased_on = "case.toml"\n[time]\nend = {end}\nstep = {step}\n[checkpoint]\ninterval = 0.1\n'


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
