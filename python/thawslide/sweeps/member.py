"""One member: starts or resumes its run, evaluates it, and writes its record. Workers call `perform`."""

from __future__ import annotations

import math
import os
import platform
import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from thawslide import _core
from thawslide.atomic_file import atomic_file
from thawslide.case import Case
from thawslide.errors import ReportError, printable
from thawslide.run_facts import LOCK, Ending, ending_of, is_held, process_named_in, read_facts
from thawslide.run_folder import Run
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.folder import DONE, FAILED, FINISHED, RUNNING, SweepFolder
from thawslide.sweeps.numbers import numbers_of_block, numbers_of_run, series_of

KEEPS = ("maps", "all", "none")
_KEPT = ("case.toml", "history.csv", "probes.csv", "run.json", "maps")  # files that --keep maps keeps
_CHECKPOINTS = ("checkpoint.bin", "checkpoint.previous.bin")
_LOCK_INTERVAL = 0.5  # seconds between two checks of a lock
Report = Callable[[int, float], None]  # receives member and the simulated fraction


class MemberInterruptedError(Exception):
    """A member that has neither finished nor failed: a repeated sweep continues it."""


@dataclass(frozen=True)
class Task:
    """Input of a worker for one member; all workers share the file system of its paths."""

    number: int
    folder: Path
    case: Case
    is_block: bool = False
    expressions: dict[str, str] = field(default_factory=dict)
    keep: str = "maps"


class MemberObserver(_core.Observer):
    """Reports the progress of a run, and stores the reason if the run ends early."""

    def __init__(self, report: Callable[[float], None]) -> None:
        super().__init__()
        self.reason = ""
        self._report = report

    def text(self, line: str) -> None:
        """Ignore warnings and notes, because run.json contains them."""

    def error(self, line: str) -> None:
        """Store the reason of an early end."""
        self.reason = line.removeprefix("error: ")

    def progress(self, state: _core.ProgressState) -> None:
        """Report the simulated fraction."""
        self._report(state.time / state.end if state.end > 0.0 else 1.0)


def perform(task: Task, report: Report = lambda number, fraction: None) -> dict[str, Any]:
    """Run a member to its end unless it has finished, and return its record.

    The record is written last: a member that is killed before continues from the checkpoint of its run.
    MemberInterruptedError if a file cannot be written, as on a full disk, or another process can be writing its run.
    """
    try:
        return _perform(task, report)
    except (OSError, _core.WriteError) as error:
        reason = printable(str(error).partition("\n")[0])
        raise MemberInterruptedError(f"{reason}. Free disk space, or correct the permissions.") from error


def _perform(task: Task, report: Report) -> dict[str, Any]:
    folder = SweepFolder(task.folder)
    run_folder = folder.run_folder(task.number)
    _await(run_folder / LOCK)
    record = folder.record(task.number)
    if record["status"] in FINISHED:
        tidy(task, run_folder)
        return record
    began = time.time()
    record = {"status": RUNNING, "starts": record["starts"] + 1, "wall_s": record.get("wall_s", 0.0)}
    record |= {"host": platform.node(), "process": os.getpid()}
    folder.write_record(task.number, record)
    try:
        record |= _evaluated(task, folder, run_folder, lambda fraction: report(task.number, fraction))
        record["status"] = DONE
    except _core.WriteError:  # a UserError, but no error of the case
        raise
    except (_core.UserError, _core.RunError, _core.DeviceError, ReportError, MemoryError) as error:
        record |= {"status": FAILED, "error": str(error) or type(error).__name__}
    record["wall_s"] = round(record["wall_s"] + time.time() - began, 3)
    folder.write_record(task.number, record)
    tidy(task, run_folder)
    return record


def _await(lock: Path) -> None:
    """Wait until no process holds a lock, such as a worker that lost its scheduler.

    MemberInterruptedError if the file system has no locks, and the lock names a process that can still be running.
    """
    while held := is_held(lock):
        time.sleep(_LOCK_INTERVAL)
    if held is None and (process := process_named_in(lock)):
        raise MemberInterruptedError(
            f"{lock.parent} may be being written by {printable(process)}, and its file system has no locks. Wait until "
            f"that process has ended, or remove {lock}."
        )


def _evaluated(task: Task, folder: SweepFolder, run_folder: Path, report: Callable[[float], None]) -> dict[str, Any]:
    """Run a member to its end, write its series, and return seed and numbers."""
    case = task.case
    expressions = [Expression(name, text) for name, text in task.expressions.items()]
    if task.is_block:
        columns = {
            name: np.asarray(values) for name, values in _core.block(case._core, MemberObserver(report), 1).items()
        }
        numbers = numbers_of_block(columns, expressions, case["time.end"])
        series = series_of(columns)
    else:
        _complete_run(case, run_folder, MemberObserver(report))
        run = Run(run_folder, skip_damaged=True)
        numbers = numbers_of_run(run, expressions)
        series = series_of(run.series)
    with atomic_file(folder.series_file(task.number)) as temporary:
        np.savez(temporary, **{name: values.astype(np.float32) for name, values in series.items()})  # type: ignore[arg-type]
    finite = {name: value if math.isfinite(value) else None for name, value in numbers.items()}
    return {"seed": _seed_of(case), "numbers": finite}


def _complete_run(case: Case, run_folder: Path, observer: MemberObserver) -> None:
    """Start or resume a run unless it is complete; raise the error of a run that ended early."""
    facts = _facts_of(run_folder)
    ending = ending_of(run_folder, facts)
    if ending is Ending.DONE:
        return
    # A run that is killed while it replaces its checkpoint has the previous one only.
    if facts and any((run_folder / name).is_file() for name in _CHECKPOINTS):
        code = _core.resume_run(str(run_folder), [], "cpu", 1, observer)
    else:
        shutil.rmtree(run_folder, ignore_errors=True)  # killed before its first checkpoint
        code = _core.start_run(case._core, str(run_folder), False, "cpu", 1, observer)
    if code is _core.ExitCode.RUN_FAILED:
        raise _core.RunError(observer.reason)
    if code is _core.ExitCode.NOT_WRITTEN:
        raise _core.WriteError(observer.reason)
    if code is not _core.ExitCode.DONE:
        raise _core.UserError(observer.reason)


def _facts_of(run_folder: Path) -> dict[str, Any]:
    try:
        return read_facts(run_folder / "run.json")
    except ReportError:  # damaged by a power failure: the run starts again
        return {}


def _seed_of(case: Case) -> int | None:
    try:
        return int(case["initial.seed"])
    except KeyError:
        return None


def tidy(task: Task, run_folder: Path) -> None:
    """Remove the files of a finished run that are not kept; those of a failed one remain for diagnosis.

    Maps remain until the sweep has ended, because the probability maps are computed from them.
    """
    if task.keep == "all" or not run_folder.is_dir() or _facts_of(run_folder).get("status") != DONE:
        return
    for path in run_folder.iterdir():
        if path.name in _KEPT:
            continue
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)
