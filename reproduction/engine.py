"""Execution of runs, several at a time on one thread each; finished runs of the same program and inputs are reused."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from pathlib import Path

from thawslide.errors import ReportError

Report = Callable[[str], None]
FAILED_RUN = 3  # exit code of `thawslide run` for a run that failed and kept its results
REST = 10.0  # s: duration of no motion for rest
REST_FRACTION, REST_SPEED = 0.002, 0.02  # of the peak; m/s
NEVER_MOVED = 100.0  # s: time without 1 m/s after which the mass will not start
MOVED = 1.0  # m/s: below this maximum the mass has only settled


@dataclass(frozen=True)
class Task:
    """A process with results: its name, command, and the file or folder that it writes.

    `inputs` are files that run.json does not list, `cost` is the relative run time, `program` identifies the version.
    """

    key: str
    command: tuple[str, ...]
    results: Path
    program: str = ""
    inputs: tuple[Path, ...] = ()
    cost: float = 1.0
    until_rest: bool = False
    environment: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Record:
    """What the engine writes next to the results of a task."""

    command: list[str]
    program: str
    inputs: dict[str, str]  # SHA-256 of each file
    code: int
    message: str  # of a failure
    processor_s: float
    wall_s: float

    @property
    def is_done(self) -> bool:
        """Whether the process reached its end, or rest."""
        return not self.message


def record_file(results: Path) -> Path:
    """Return the file of the record of a task."""
    return results.with_name(f"{results.stem if results.suffix == '.csv' else results.name}.record.json")


def log_file(results: Path) -> Path:
    """Return the file with the output of a task."""
    return results.with_name(f"{results.name}.log")


def read_record(results: Path) -> Record | None:
    """Return the record of a task, None if it did not run."""
    try:
        return Record(**json.loads(record_file(results).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None


def is_done(results: Path) -> bool:
    """Return whether a task reached its end, or rest."""
    record = read_record(results)
    return record is not None and record.is_done


def failure(results: Path) -> str:
    """Return the message of a failed task, "not run" without a record, "" for a complete one."""
    record = read_record(results)
    return record.message if record else "not run"


def processor_time(results: Path) -> float:
    """Return the processor time [s] of a task, with its start and its output."""
    record = read_record(results)
    return record.processor_s if record else float("nan")


def commit_of(program: Path) -> str:
    """Return the commit of a program."""
    done = subprocess.run([program, "version"], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise ReportError(f"{program} version: exit code {done.returncode}. Build it with ./run --setup.")
    found = re.search(r"commit ([^,\s)]+)", done.stdout)
    return found[1] if found else ""


def version_of(program: Path) -> str:
    """Return what identifies the code of a program: its commit, or its digest if the tree had changes."""
    commit = commit_of(program)
    return commit if commit and not commit.endswith("-dirty") else digest(program)


def digest(path: Path) -> str:
    """Return the SHA-256 of a file, "" if it does not exist."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


def is_current(task: Task) -> bool:
    """Return whether results of this command, this program and the present inputs exist; failed runs count."""
    record = read_record(task.results)
    return (
        record is not None
        and (record.is_done or record.code == FAILED_RUN)
        and task.results.exists()
        and (record.program, record.command) == (task.program, list(task.command))
        and record.inputs.keys() >= {str(path) for path in task.inputs}
        and all(digest(Path(path)) == found for path, found in record.inputs.items())
    )


def at_rest(times: Sequence[float], speeds: Sequence[float]) -> bool:
    """Return whether a mass that moved has been at rest for REST seconds, or has not moved by NEVER_MOVED."""
    if not times or times[-1] <= REST:
        return False
    peak = max(speeds)
    if peak < MOVED:
        return times[-1] >= NEVER_MOVED
    low = max(REST_FRACTION * peak, REST_SPEED)
    return all(speed < low for when, speed in zip(times, speeds, strict=True) if when > times[-1] - REST)


def is_at_rest(folder: Path) -> bool:
    """Return whether the history of a run ends at rest."""
    try:
        with (folder / "history.csv").open(newline="") as file:
            rows = [(float(row["time_s"]), float(row["mean_velocity_m_s"])) for row in csv.DictReader(file)]
    except (OSError, ValueError, KeyError, TypeError):  # missing, or its last row is being written
        return False
    return at_rest([when for when, _ in rows], [speed for _, speed in rows])


def _inputs_of(task: Task) -> dict[str, str]:
    found = {str(path): digest(path) for path in task.inputs}
    try:
        listed = json.loads((task.results / "run.json").read_text(encoding="utf-8")).get("inputs", ())
    except (OSError, ValueError):
        return found
    return found | {each["path"]: each["sha256"] for each in listed}


def _wait(process: subprocess.Popen[bytes], task: Task) -> float:
    """Wait for the end of a process, and stop it at rest if requested; return its processor time [s]."""
    pause, checked = 0.01, time.monotonic()
    while True:
        found, status, used = os.wait4(process.pid, os.WNOHANG)
        if found:
            process.returncode = os.waitstatus_to_exitcode(status)
            return used.ru_utime + used.ru_stime
        time.sleep(pause)
        pause = min(1.2 * pause, 0.5)
        if task.until_rest and time.monotonic() - checked > 2.0:
            checked = time.monotonic()
            if is_at_rest(task.results):
                os.kill(process.pid, signal.SIGTERM)


def execute(task: Task) -> Record:
    """Run a task; write its record, and its output into a log. Earlier results are removed."""
    task.results.parent.mkdir(parents=True, exist_ok=True)
    record_file(task.results).unlink(missing_ok=True)
    if task.results.is_dir():
        shutil.rmtree(task.results)
    task.results.unlink(missing_ok=True)
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"} | dict(task.environment)
    started = time.monotonic()
    with log_file(task.results).open("wb") as log, tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(task.command, stdin=subprocess.DEVNULL, stdout=log, stderr=errors, env=environment)
        processor_s = _wait(process, task)
        errors.seek(0)
        text = errors.read()
        log.write(text)
    is_complete = process.returncode == 0 or (task.until_rest and is_at_rest(task.results))
    message = "" if is_complete else text.decode(errors="replace").strip() or f"exit code {process.returncode}"
    if is_complete and not task.results.exists():
        message = f"{task.results.name} was not written"
    record = Record(
        list(task.command), task.program, _inputs_of(task), process.returncode, message, processor_s,
        time.monotonic() - started,
    )  # fmt: skip
    record_file(task.results).write_text(json.dumps(asdict(record), indent=1) + "\n", encoding="utf-8")
    return record


def perform(tasks: Sequence[Task], at_a_time: int, report: Report) -> list[str]:
    """Execute the missing tasks, the most expensive first; report each with the remaining time.

    Return a message for each task that failed, now or before.
    """
    keys = [task.key for task in tasks]
    if len(set(keys)) < len(keys):
        raise ValueError(f"runs with the same name: {sorted(key for key in set(keys) if keys.count(key) > 1)}")
    waiting = sorted((task for task in tasks if not is_current(task)), key=lambda task: -task.cost)
    report(f"{len(tasks)} runs, {len(tasks) - len(waiting)} of them complete")
    started, done, cost, total = time.monotonic(), 0, 0.0, sum(task.cost for task in waiting)
    pool = ThreadPoolExecutor(max_workers=at_a_time)
    try:
        futures = {pool.submit(execute, task): task for task in waiting}
        for future in as_completed(futures):
            task, record = futures[future], future.result()
            done, cost = done + 1, cost + task.cost
            left = (time.monotonic() - started) / cost * (total - cost)
            why = f": {record.message}" if record.message else f" ({record.processor_s:.0f} s)"
            report(f"{done} of {len(waiting)}, about {left / 60:.0f} min left: {task.key}{why}")
    finally:
        pool.shutdown(cancel_futures=True)
    return [f"{task.key}: {why}" for task in tasks if (why := failure(task.results))]
