"""What run.json says of a run, and whether one that it calls running still is."""

from __future__ import annotations

import fcntl
import math
import os
import time
from contextlib import suppress
from enum import Enum
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError
from thawslide.text_files import MEGABYTE, is_number, read_json

LOCK = "run.lock"  # held with flock by the process that runs, for as long as it lives
STATUSES = ("running", "done", "stopped", "failed")
NUMBERS = (
    "simulated_time_s",
    "rest_since_s",
    "mean_velocity_m_s",
    "dilation_volume_m3",
    "dilation_share",
    "left_mass_kg",
    "covered_volume_m3",
    "covered_area_m2",
    "affected_area_m2",
    "travel_distance_m",
    "drop_height_m",
    "angle_of_reach_degrees",
)  # that figures and key numbers use; null: not known


class Ending(Enum):
    """How a run ended, or that it has not."""

    DONE = "done"
    STOPPED = "stopped"
    FAILED = "failed"
    RUNNING = "running"
    KILLED = "killed"  # run.json says running, and no process holds the lock
    UNTOLD = "running or killed"  # run.json says running, and the file system has no locks to tell by
    UNKNOWN = "unknown"  # there is no run.json


def read_facts(path: Path) -> dict[str, Any]:
    """Read run.json, nothing where there is none; ReportError when it is damaged."""
    if not os.path.lexists(path):
        return {}
    facts = read_json(path, 16 * MEGABYTE)
    if facts.get("status") not in STATUSES:
        raise ReportError(f"{path}: status must be {', '.join(STATUSES)}, found {str(facts.get('status'))[:60]}")
    for name in NUMBERS:
        value = facts.get(name)
        if value is not None and not is_number(value):
            raise ReportError(f"{path}: {name} must be a number, found {str(value)[:60]}")
    if not isinstance(facts.get("at_rest"), bool | None):
        raise ReportError(f"{path}: at_rest must be true, false or null, found {str(facts['at_rest'])[:60]}")
    warnings = facts.get("warnings", [])
    if not isinstance(warnings, list) or not all(isinstance(each, str) for each in warnings):
        raise ReportError(f"{path}: warnings must be a list of texts, found {str(warnings)[:60]}")
    return facts


def ending_of(folder: Path, facts: dict[str, Any]) -> Ending:
    """Return how a run ended. While a process holds its lock it runs, whatever run.json says: it may have resumed."""
    held = is_held(folder / LOCK)
    if held:
        return Ending.RUNNING
    if not facts:
        return Ending.UNKNOWN
    ending = Ending(facts["status"])
    if ending is not Ending.RUNNING:
        return ending
    return Ending.UNTOLD if held is None else Ending.KILLED


def last_write_age(folder: Path) -> float:
    """Return how long ago [s] the file of a run was written that was written last; nan where there is none."""
    ages = []
    for file in (*folder.glob("*"), *folder.glob("snapshots/*")):
        with suppress(OSError):  # a run that lives renames its files
            if file.is_file():
                ages.append(time.time() - file.stat().st_mtime)
    return min(ages, default=math.nan)


def is_held(lock: Path) -> bool | None:
    """Return whether a process holds a lock file; None where the file system has no locks, as some network disks.

    A shared lock is asked for, so that several can ask at once.
    """
    try:
        # Without O_NONBLOCK a pipe of that name would wait for ever.
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
        os.close(handle)  # which lets go of the lock
    return False
