"""Killed runs and failing writes: a resumed run has the files of an undisturbed one.

These are samples; scripts/pages --only reliability performs all tests.
"""

import random
import subprocess
from pathlib import Path

import pytest
from conftest import LAMPLUGH, Program, sets
from faults import FAILING_WRITES, Subject, calls_that_write, failing, killed, limited, on_small_disk, undisturbed

SHORT = tuple(sets(time__end=0.3, time__history_interval=0.07, time__output_interval=0.05, checkpoint__interval=0.04))


@pytest.mark.parametrize("case", ["lamplugh", "lamplugh-columns"])
def test_killed_runs_end_bitwise_identical(binary: Path, tmp_path: Path, case: str) -> None:
    subject = Subject(case, LAMPLUGH.parent / case, SHORT)
    expected, span = undisturbed(binary, subject, tmp_path / "undisturbed")
    chance = random.Random(20160628)
    for number in range(4):
        trial = killed(binary, subject, tmp_path / f"run{number}", expected, span, chance)
        assert trial.passed, trial


@pytest.mark.parametrize(("kind", "reason"), [("once", "io"), ("onwards", "full"), ("short", "full")])
def test_a_failing_write_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, kind: str, reason: str) -> None:
    if not FAILING_WRITES.exists():
        pytest.skip(f"{FAILING_WRITES} is not built")
    subject = Subject("small", small_case, tuple(sets(checkpoint__interval=0.06)))
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    calls = calls_that_write(binary, subject, tmp_path / "counted", tmp_path / "count")
    assert calls > 50
    codes = set()
    for number, at in enumerate(range(1, calls + 1, 11)):
        trial = failing(binary, subject, tmp_path / f"run{number}", expected, at, kind, reason)
        assert trial.passed, trial
        codes.add(trial.code)
    assert 5 in codes


@pytest.mark.parametrize("size", [1_000, 9_000, 20_000])
def test_a_limit_of_file_sizes_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, size: int) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    trial = limited(binary, subject, tmp_path / "run", expected, size)
    assert trial.passed, trial


@pytest.mark.parametrize("size", [40, 100, 150])
def test_a_full_disk_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, size: int) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    trial = on_small_disk(binary, subject, tmp_path / "disk", expected, (size, 10_000))
    if trial is None:
        pytest.skip("mount is not allowed: no small disk available")
    assert trial.passed, trial


def test_a_read_only_folder_is_reported_before_a_computation(binary: Path, small_case: Path, tmp_path: Path) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    trial = failing(binary, subject, tmp_path / "run", expected, 1, "onwards", "denied")
    assert trial.code == 5 and "Permission denied" in trial.reported and trial.passed, trial


@pytest.mark.parametrize("size", [8, 60])
def test_a_disk_full_from_the_start_exits_with_5(
    thawslide: Program, small_case: Path, tmp_path: Path, size: int
) -> None:
    """The message proposes to resume only if there is a run to resume."""
    disk = tmp_path / "disk"
    disk.mkdir()
    made = ["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", str(disk)]
    if subprocess.run(made, capture_output=True, check=False).returncode != 0:
        pytest.skip("mount is not allowed: no small disk available")
    try:
        outcome = thawslide("run", small_case, "--output", disk / "run")
        assert outcome.returncode == 5
        assert "continues from the last checkpoint" not in outcome.stderr
        assert not (disk / "run" / "checkpoint.bin").exists()
        assert ("starts it again" in outcome.stderr) == (disk / "run" / "run.json").exists()
    finally:
        subprocess.run(["umount", str(disk)], check=True)
