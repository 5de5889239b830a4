"""Cost that `check` states, beside other processes."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from conftest import Program, sets

COLUMNS = (Path(__file__).resolve().parents[2] / "cases" / "lamplugh-columns", *sets(grid__cell=20))
CORE = min(os.sched_getaffinity(0))


@contextmanager
def busy(processes: int) -> Iterator[None]:
    """Occupy the core with processes that compute without an end."""
    loops = [
        subprocess.Popen(["taskset", "-c", str(CORE), sys.executable, "-c", "while True: pass"])
        for _ in range(processes)
    ]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def test_the_cost_does_not_depend_on_other_processes_and_says_that_there_are_some(thawslide: Program) -> None:
    check = f'taskset -c {CORE} "$@"'
    alone = json.loads(thawslide.shell(check, "check", *COLUMNS, "--json").stdout)
    with busy(8):
        beside = json.loads(thawslide.shell(check, "check", *COLUMNS, "--json").stdout)
        printed = thawslide.shell(check, "check", *COLUMNS).stdout
    assert 1 / 3 < beside["processor_s"] / alone["processor_s"] < 3
    assert beside["slowdown"] > 3 * min(alone["slowdown"], 1.5)
    assert "of processor time (this machine is busy: " in printed
