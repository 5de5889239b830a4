"""Memory of a member, estimated by `thawslide check`, and the number of workers that fit."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping, Sequence
from typing import Any

from thawslide.case import toml_text
from thawslide.program import find_program
from thawslide.sweeps.design import Member
from thawslide.text_files import is_number

_TABLES_OF_SIZE = ("grid.", "body.", "maps.")  # tables whose keys change the memory of a run
_LIBRARIES = 400e6  # bytes of a worker without a run: Python, NumPy, Matplotlib and Dask
_MARGIN = 1.2
_TIMEOUT = 600.0  # seconds


def bytes_of_worker(members: Sequence[Member]) -> float | None:
    """Return the memory of a worker during the largest member [bytes]; None without the program.

    The estimate is the largest one of `thawslide check` for the first member of each case, for the extremes of each
    key that changes the size, and for those extremes of all keys together that need the most. The extremes are applied
    to the case whose first member needs the most. Their combination need not be a member, and is an upper limit for
    this case if each key changes the memory in one direction.
    """
    path = find_program()
    if path is None:
        return None
    firsts = {member.case_file: member for member in reversed(members)}
    needs = {member.case_file: _need(path, member.case_file, member.changes) for member in firsts.values()}
    if None in needs.values():
        return None
    case_file = max(needs, key=lambda each: needs[each] or 0.0)
    changes = dict(firsts[case_file].changes)
    found = [needs[case_file]]
    worst = dict(changes)
    for key, extremes in _extremes(members).items():
        of_key = {value: _need(path, case_file, changes | {key: value}) for value in extremes}
        worst[key] = max(extremes, key=lambda value: of_key[value] or 0.0)
        found += of_key.values()
    if worst != changes:
        found.append(_need(path, case_file, worst))
    return _LIBRARIES + _MARGIN * max(need for need in found if need is not None)


def workers_that_fit(cores: int, need: float | None) -> int:
    """Return the number of workers, at most one per core, that fit into the available memory."""
    if need is None:
        return cores
    return max(1, min(cores, int(available_bytes() / need)))


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def available_bytes() -> float:
    """Return the available memory of this machine, or of the control group of this process [bytes]."""
    from dask.utils import parse_bytes
    from distributed.system import MEMORY_LIMIT

    with open("/proc/meminfo", encoding="ascii") as file:  # noqa: PTH123  # a file of the kernel
        free = next(parse_bytes(line.split(":")[1].strip()) for line in file if line.startswith("MemAvailable"))
    return float(min(free, MEMORY_LIMIT))


def _extremes(members: Sequence[Member]) -> dict[str, tuple[float, float]]:
    """Return the extremes of the varied numbers that change the size of a run."""
    found = {}
    for key in members[0].changes:
        values = [member.changes[key] for member in members]
        if key.startswith(_TABLES_OF_SIZE) and all(is_number(value) for value in values) and min(values) < max(values):
            found[key] = (min(values), max(values))
    return found


def _need(path: str, case_file: str, changes: Mapping[str, Any]) -> float | None:
    """Return the estimate of `thawslide check` [bytes]; None if it fails, as for values that exclude each other."""
    sets = [part for key, value in changes.items() for part in ("--set", f"{key}={toml_text(value)}")]
    command = [path, "check", case_file, "--json", "--threads", "1", *sets]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_TIMEOUT, check=False)
        return float(json.loads(done.stdout)["memory"]["need_bytes"])
    except (OSError, subprocess.TimeoutExpired, ValueError, KeyError, TypeError):
        return None
