"""Kills and failing writes: a run that goes on ends with the files of one that nothing disturbed.

A sample; all of them are in scripts/reliability.
"""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest
from conftest import LAMPLUGH, Program, sets
from faults import FAILING_WRITES, Subject, calls_that_write, failing, killed, limited, on_small_disk, undisturbed

SHORT = tuple(sets(time__end=0.3, time__history_interval=0.07, time__output_interval=0.05, checkpoint__interval=0.04))


@pytest.mark.parametrize("case", ["lamplugh", "lamplugh-columns"])
def test_killed_runs_end_with_the_same_bits(binary: Path, tmp_path: Path, case: str) -> None:
    subject = Subject(case, LAMPLUGH.parent / case, SHORT)
    expected, span = undisturbed(binary, subject, tmp_path / "whole")
    chance = random.Random(20160628)
    for number in range(4):
        trial = killed(binary, subject, tmp_path / f"run{number}", expected, span, chance)
        assert trial.passed, trial


@pytest.mark.parametrize(("kind", "reason"), [("once", "io"), ("onwards", "full"), ("short", "full")])
def test_a_failing_write_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, kind: str, reason: str) -> None:
    if not FAILING_WRITES.exists():
        pytest.skip(f"there is no {FAILING_WRITES}: build it")
    subject = Subject("small", small_case, tuple(sets(checkpoint__interval=0.06)))
    expected, _ = undisturbed(binary, subject, tmp_path / "whole")
    calls = calls_that_write(binary, subject, tmp_path / "counted", tmp_path / "count")
    assert calls > 50
    codes = set()
    for number, at in enumerate(range(1, calls + 1, 11)):
        trial = failing(binary, subject, tmp_path / f"run{number}", expected, at, kind, reason)
        assert trial.passed, trial
        codes.add(trial.code)
    assert 5 in codes


@pytest.mark.parametrize("size", [1_000, 9_000, 20_000])
def test_a_limit_of_the_size_of_files_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, size: int) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "whole")
    trial = limited(binary, subject, tmp_path / "run", expected, size)
    assert trial.passed, trial


@pytest.mark.parametrize("size", [40, 100, 150])
def test_a_full_disk_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, size: int) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "whole")
    trial = on_small_disk(binary, subject, tmp_path / "disk", expected, (size, 10_000))
    if trial is None:
        pytest.skip("no disk of a chosen size can be made here: mount is not allowed")
    assert trial.passed, trial


def test_a_folder_that_is_read_only_is_reported_before_anything_is_computed(
    binary: Path, small_case: Path, tmp_path: Path
) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "whole")
    trial = failing(binary, subject, tmp_path / "run", expected, 1, "onwards", "denied")
    assert trial.code == 5 and "Permission denied" in trial.reported and trial.passed, trial


@pytest.mark.parametrize("size", [8, 60])
def test_a_disk_that_is_full_from_the_start(thawslide: Program, small_case: Path, tmp_path: Path, size: int) -> None:
    """The code is that of files; what is told to go on from is there."""
    disk = tmp_path / "disk"
    disk.mkdir()
    made = ["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", str(disk)]
    if subprocess.run(made, capture_output=True, check=False).returncode != 0:
        pytest.skip("no disk of a chosen size can be made here: mount is not allowed")
    try:
        outcome = thawslide("run", small_case, "--output", disk / "run")
        assert outcome.returncode == 5
        assert "continues from the last checkpoint" not in outcome.stderr
        assert not (disk / "run" / "checkpoint.bin").exists()
        assert ("starts it again" in outcome.stderr) == (disk / "run" / "run.json").exists()
    finally:
        subprocess.run(["umount", str(disk)], check=True)
