"""Facts of a run in run.json, and whether a run with the status running still runs."""

from __future__ import annotations

import fcntl
import math
import os
import re
import socket
import time
from contextlib import suppress
from enum import Enum
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError
from thawslide.text_files import MEGABYTE, is_number, read_json

_REPEAT = "Repeat the run."
LOCK = "run.lock"  # held with flock by the running process
_LONGEST_LINE = 512  # characters of a lock
STATUSES = ("running", "done", "stopped", "failed")
NUMBERS = (
    "simulated_time_s",
    "rest_since_s",
    "mean_velocity_m_s",
    "dilation_volume_m3",
    "dilation_fraction",
    "left_mass_kg",
    "covered_volume_m3",
    "covered_area_m2",
    "affected_area_m2",
    "deposit_area_m2",
    "inundated_area_m2",
    "travel_distance_m",
    "drop_height_m",
    "reach_angle_degrees",
)  # used by figures and key numbers; null: unknown


class Ending(Enum):
    """Ending of a run."""

    DONE = "done"
    STOPPED = "stopped"
    FAILED = "failed"
    RUNNING = "running"
    KILLED = "killed"  # run.json says running, and no process holds the lock
    UNDETERMINED = "running or killed"  # run.json says running, and the file system has no locks
    UNKNOWN = "unknown"  # there is no run.json


def read_facts(path: Path) -> dict[str, Any]:
    """Read run.json, nothing if it does not exist; ReportError if it is damaged."""
    if not os.path.lexists(path):
        return {}
    facts = read_json(path, 16 * MEGABYTE)
    if facts.get("status") not in STATUSES:
        found = str(facts.get("status"))[:60]
        raise ReportError(f"{path}: status: invalid value (found {found}; allowed {', '.join(STATUSES)}). {_REPEAT}")
    for name in NUMBERS:
        value = facts.get(name)
        if value is not None and not is_number(value):
            raise ReportError(f"{path}: {name}: not a number (found {str(value)[:60]}). {_REPEAT}")
    if not isinstance(facts.get("at_rest"), bool | None):
        raise ReportError(
            f"{path}: at_rest: invalid value (found {str(facts['at_rest'])[:60]}; allowed true, false, null). {_REPEAT}"
        )
    warnings = facts.get("warnings", [])
    if not isinstance(warnings, list) or not all(isinstance(each, str) for each in warnings):
        raise ReportError(f"{path}: warnings: not a list of texts (found {str(warnings)[:60]}). {_REPEAT}")
    return facts


def ending_of(folder: Path, facts: dict[str, Any]) -> Ending:
    """Return the ending of a run. It runs while a process holds its lock, because it can have been resumed."""
    held = is_held(folder / LOCK)
    if held:
        return Ending.RUNNING
    if not facts:
        return Ending.UNKNOWN
    ending = Ending(facts["status"])
    if ending is not Ending.RUNNING:
        return ending
    return Ending.UNDETERMINED if held is None else Ending.KILLED


def last_write_age(folder: Path) -> float:
    """Return the time [s] since the last write to a file of a run; nan without files."""
    ages = []
    for file in (*folder.glob("*"), *folder.glob("snapshots/*")):
        with suppress(OSError):  # a running process renames its files
            if file.is_file():
                ages.append(time.time() - file.stat().st_mtime)
    return min(ages, default=math.nan)


def process_named_in(lock: Path) -> str:
    """Return the process that can be working in a run folder, by the text of its lock; "" if there is none.

    On a file system without locks, the simulator decides in the same way (src/io/run_lock.cpp): a process of this
    machine is tested, and one of another machine counts as running.
    """
    try:
        with lock.open(encoding="utf-8", errors="replace") as file:
            line = file.read(_LONGEST_LINE).rstrip("\n")
    except OSError:
        return ""
    named = re.fullmatch(r"process (\d{1,9}) on (.*)", line)
    if not named or named[2] != socket.gethostname():
        return line
    if int(named[1]) == os.getpid():  # left by an earlier process
        return ""
    try:
        os.kill(int(named[1]), 0)
    except ProcessLookupError:
        return ""
    except PermissionError:
        pass
    return line


def is_held(lock: Path) -> bool | None:
    """Return whether a process holds a lock file; None if the file system has no locks, as some network disks.

    The request is for a shared lock, which several processes can hold at once.
    """
    try:
        # Without O_NONBLOCK, opening a pipe of that name would block forever.
        handle = os.open(lock, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return None
    finally:
        os.close(handle)  # releases the lock
    return False
