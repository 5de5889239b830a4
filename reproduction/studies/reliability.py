"""Reliability: runs that are killed, writing that fails, damaged files, and fuzzed readers.

scripts/site makes the page docs/reliability.md from the committed results.

Most of the time is fuzzing (scripts/fuzz). Parts that are not selected keep the results of their last run. The part
fuzzing/TARGET selects one target.
"""

from __future__ import annotations

import shutil
import sys
from functools import partial
from pathlib import Path

from reproduction.engine import Task
from reproduction.studies.reliability_page import TEXTS
from reproduction.study import ROOT, Place, Study

SCRIPT = Path(__file__).resolve().parent / "reliability_parts.py"
SLOW = ("fuzzing",)  # not with --quick


def part(place: Place, name: str) -> list[Task]:
    """Return the process of a part, which uses all simultaneous runs."""
    if place.is_quick and name in SLOW:
        return []
    targets = [each.partition("/")[2] for each in place.parts if each.startswith(f"{name}/")]
    results = place.runs / f"{name}.json"
    words = [sys.executable, str(SCRIPT), name, "--results", str(results), "--jobs", str(place.at_a_time)]
    words += ["--quick"] if place.is_quick else []
    words += [word for target in targets for word in ("--target", target)]
    return [
        Task(
            f"{name}/{targets[0]}" if targets else name,
            tuple(words),
            results,
            place.version,
            (SCRIPT,),
            environment={"THAWSLIDE_BINARY": str(place.program)},
        )
    ]


def write(place: Place) -> None:
    """Copy the last results of all parts to the folder of committed results."""
    for name in TEXTS:
        if (made := place.runs / f"{name}.json").is_file():
            shutil.copy(made, place.page(f"docs/reliability/{name}.json"))


def needs(place: Place) -> list[Path]:
    """Return the library that makes writes fail."""
    return [] if place.draws_only else [ROOT / "build" / "release" / "tests" / "failing_writes.so"]


STUDY = Study(
    "reliability",
    ("docs/reliability (results)",),
    600.0,
    write,
    tuple(partial(part, name=name) for name in TEXTS),
    needs,
    "Build it with cmake --build build/release.",
)
