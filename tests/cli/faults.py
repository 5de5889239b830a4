"""Runs that are killed or whose writing fails, and their results: for the tests and for the page of reliability."""

import hashlib
import json
import os
import random
import resource
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from conftest import LAMPLUGH, datasets, mark_killed, run_facts, sets

ROOT = Path(__file__).resolve().parents[2]
FAILING_WRITES = ROOT / "build" / "release" / "tests" / "failing_writes.so"
Outcome = subprocess.CompletedProcess[str]
Digest = dict[str, str]
LEFT_OUT = ("run.json", "run.lock")  # files about processes, not about the slide
LONG = sets(time__end=150, time__history_interval=0.05, time__output_interval=50)
NOT_BEGUN = "is not a run folder"
needs_failing_writes = pytest.mark.skipif(not FAILING_WRITES.exists(), reason=f"{FAILING_WRITES} is not built")


@dataclass(frozen=True)
class Subject:
    """A case to be tested, and the arguments of `run` after the case, without --output."""

    name: str
    case: Path
    words: tuple[str, ...] = ()


@dataclass
class Trial:
    """The result of one disturbed run."""

    subject: str
    disturbance: str
    code: int  # of the disturbed process
    reported: str  # its last line of errors
    same: bool  # whether it ended with the files of the undisturbed run
    remarks: list[str] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether nothing was lost and no error occurred."""
        return self.same and not self.remarks


def content(file: Path) -> bytes:
    """Return the bytes of a file; of an HDF5 file, in which unused ones differ, those of its datasets."""
    if file.suffix != ".vtkhdf":
        return file.read_bytes()
    return b"".join(name.encode() + values.tobytes() for name, values in sorted(datasets(file).items()))


def digest(run: Path) -> dict[str, str]:
    """Return SHA-256 of every file of a run, except files about processes."""
    return {
        str(file.relative_to(run)): hashlib.sha256(content(file)).hexdigest()
        for file in sorted(run.rglob("*"))
        if file.is_file() and file.name not in LEFT_OUT
    }


def before_its_first_checkpoint(run: Path) -> None:
    """Change a finished run to one that was killed just before its first checkpoint."""
    mark_killed(run)
    (run / "run.json").write_text(json.dumps(run_facts(run) | {"steps": 0, "simulated_time_s": 0.0}))
    for name in ("checkpoint.bin", "checkpoint.previous.bin"):
        (run / name).unlink()
    rows = (run / "history.csv").read_text().splitlines(keepends=True)
    (run / "history.csv").write_text("".join(rows[:2]))  # the header, and the row at t = 0


@contextmanager
def running_in(run: Path, program: Path, environment: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    """Yield the process of a long run into a folder after its first steps."""
    pipe = subprocess.PIPE
    command = [str(program), "run", str(LAMPLUGH), "--output", str(run), *LONG]
    with subprocess.Popen(command, env=environment, stdout=pipe, stderr=pipe, text=True) as process:
        history = run / "history.csv"
        while not history.exists() or history.read_text().count("\n") < 4:
            assert process.poll() is None
            time.sleep(0.01)
        yield process
        process.kill()


def command_of(program: Path, subject: Subject, run: Path) -> list[str]:
    """Return the command that runs the subject into a folder."""
    return [str(program), "run", str(subject.case), "--output", str(run), "--threads", "1", *subject.words]


def finish(command: list[str], **more: Any) -> Outcome:
    """Run a command to its end."""
    return subprocess.run(command, capture_output=True, text=True, check=False, **more)


def undisturbed(program: Path, subject: Subject, run: Path) -> tuple[dict[str, str], float]:
    """Run the subject; return the digest of its files and its duration [s]."""
    begin = time.monotonic()
    done = finish(command_of(program, subject, run))
    assert done.returncode == 0, done.stderr
    return digest(run), time.monotonic() - begin


def unreadable(run: Path) -> list[str]:
    """Return the files in the folder of a killed run that cannot be read."""
    found = []
    for file in [*(run / "snapshots").glob("[0-9]*.vtkhdf"), *run.glob("particles.vtkhdf")]:
        try:
            datasets(file)
        except (OSError, KeyError) as error:
            found.append(f"{file.name} cannot be read: {error}")
    for file in (run / "history.csv", run / "probes.csv"):
        rows = file.read_text().splitlines(keepends=True) if file.exists() else []
        if any(not row.endswith("\n") or row.count(",") != rows[0].count(",") for row in rows):
            found.append(f"{file.name} has a torn row")
    return found


def resume_or_restart(program: Path, subject: Subject, run: Path) -> list[str]:
    """Resume a run, or restart it if it had not begun; return errors."""
    outcome = finish([str(program), "resume", str(run), "--threads", "1"])
    if outcome.returncode == 2 and NOT_BEGUN in outcome.stderr:
        outcome = finish(command_of(program, subject, run))
    return [] if outcome.returncode == 0 else [f"resuming ended with {outcome.returncode}: {outcome.stderr.strip()}"]


def changed_files(expected: dict[str, str], found: dict[str, str]) -> list[str]:
    """Return the names of files that differ, except the previous checkpoint, whose time depends on wall-clock time."""
    names = (expected.keys() | found.keys()) - {"checkpoint.previous.bin"}
    return sorted(name for name in names if expected.get(name) != found.get(name))


def after_resuming(
    program: Path, subject: Subject, run: Path, expected: dict[str, str], disturbance: str, outcome: Outcome,
    remarks: list[str],
) -> Trial:  # fmt: skip
    """Resume the run of a disturbed process, or restart it, and return the comparison."""
    reported = outcome.stderr.strip().splitlines() or [""]
    remarks = remarks + resume_or_restart(program, subject, run)
    changed = changed_files(expected, digest(run))
    return Trial(subject.name, disturbance, outcome.returncode, reported[0], not changed, remarks + changed)


def killed(program: Path, subject: Subject, run: Path, expected: Digest, span: float, chance: random.Random) -> Trial:
    """Kill a run at a random time within `span` seconds, resume it and compare; repeat if it ended before."""
    quiet = subprocess.DEVNULL
    code = 0
    while code == 0:
        delay = chance.uniform(0.0, span)
        shutil.rmtree(run, ignore_errors=True)
        with subprocess.Popen(command_of(program, subject, run), stdout=quiet, stderr=quiet) as process:
            try:
                process.wait(timeout=delay)
            except subprocess.TimeoutExpired:
                process.kill()
            code = process.wait()
    outcome = Outcome([], code, "", "")
    return after_resuming(program, subject, run, expected, f"killed after {delay:.3f} s", outcome, unreadable(run))


def environment_of_fault(run: Path, at: int, kind: str, reason: str, count: Path | None = None) -> dict[str, str]:
    """Return the environment in which writing fails (tests/faults/failing_writes.cpp)."""
    return os.environ | {
        "LD_PRELOAD": str(FAILING_WRITES), "FAULT_FOLDER": str(run), "FAULT_AT": str(at), "FAULT_KIND": kind,
        "FAULT_REASON": reason, "FAULT_COUNT": str(count or ""),
    }  # fmt: skip


def calls_that_write(program: Path, subject: Subject, run: Path, count: Path) -> int:
    """Return how many calls of an undisturbed run change its folder."""
    environment = environment_of_fault(run, 0, "once", "full", count)
    done = finish(command_of(program, subject, run), env=environment)
    assert done.returncode == 0, done.stderr
    return int(count.read_text())


def failing(program: Path, subject: Subject, run: Path, expected: Digest, at: int, kind: str, reason: str) -> Trial:
    """Let the writing call number `at` fail, resume the run without failures and compare."""
    environment = environment_of_fault(run, at, kind, reason)
    outcome = finish(command_of(program, subject, run), env=environment)
    reported = outcome.stderr.strip().partition("\n")[0]
    remarks = []
    if outcome.returncode not in (0, 2, 5) or (outcome.returncode != 0 and not reported.startswith("error: ")):
        remarks.append(f"ended with {outcome.returncode}: {outcome.stderr.strip()}")
    if outcome.returncode != 0 and str(run) not in reported:
        remarks.append(f"the error names no file of the run: {reported}")
    return after_resuming(program, subject, run, expected, f"{kind}, {reason}, call {at}", outcome, remarks)


def limited(program: Path, subject: Subject, run: Path, expected: dict[str, str], size: int) -> Trial:
    """Run under a limit of the size of a file [bytes], resume without it and compare."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))

    outcome = finish(command_of(program, subject, run), preexec_fn=limit)
    remarks = [] if outcome.returncode in (2, 5) and "File too large" in outcome.stderr else [outcome.stderr]
    return after_resuming(program, subject, run, expected, f"files of {size} bytes at most", outcome, remarks)


@contextmanager
def mounted(disk: Path, size: int) -> Iterator[bool]:
    """Mount a disk of a size [kB] on a new folder; yield whether that is allowed."""
    disk.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", str(disk)]
    is_mounted = subprocess.run(command, capture_output=True, check=False).returncode == 0
    try:
        yield is_mounted
    finally:
        if is_mounted:
            subprocess.run(["umount", str(disk)], check=True)


def on_small_disk(
    program: Path, subject: Subject, disk: Path, expected: Digest, sizes: tuple[int, int]
) -> Trial | None:
    """Run on a disk of sizes[0] kB, resume with sizes[1] and compare; None if no disk can be mounted."""
    with mounted(disk, sizes[0]) as is_mounted:
        if not is_mounted:
            return None
        run = disk / "run"
        outcome = finish(command_of(program, subject, run))
        is_reported = "No space left" in outcome.stderr or "The disk may be full" in outcome.stderr
        remarks = [] if outcome.returncode in (2, 5) and is_reported else [outcome.stderr]
        subprocess.run(["mount", "-o", f"remount,size={sizes[1]}k", str(disk)], check=True)
        return after_resuming(program, subject, run, expected, f"a disk of {sizes[0]} kB", outcome, remarks)
