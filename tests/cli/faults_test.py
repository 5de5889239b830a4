"""Killed runs and failing writes: a resumed run has the files of an undisturbed one.

These are samples; scripts/pages --only reliability performs all tests.
"""

import random
from pathlib import Path

import faults
import pytest
from conftest import LAMPLUGH, Program, sets
from faults import Subject, mounted, needs_failing_writes, undisturbed

SHORT = tuple(sets(time__end=0.3, time__history_interval=0.07, time__output_interval=0.05, checkpoint__interval=0.04))


@pytest.mark.parametrize("case", ["lamplugh", "lamplugh-columns"])
def test_killed_runs_end_bitwise_identical(binary: Path, tmp_path: Path, case: str) -> None:
    subject = Subject(case, LAMPLUGH.parent / case, SHORT)
    expected, span = undisturbed(binary, subject, tmp_path / "undisturbed")
    chance = random.Random(20160628)
    for number in range(4):
        trial = faults.killed(binary, subject, tmp_path / f"run{number}", expected, span, chance)
        assert trial.passed, trial


@needs_failing_writes
@pytest.mark.parametrize(("kind", "reason"), [("once", "io"), ("onwards", "full"), ("short", "full")])
def test_a_failing_write_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, kind: str, reason: str) -> None:
    subject = Subject("small", small_case, tuple(sets(checkpoint__interval=0.06)))
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    calls = faults.calls_that_write(binary, subject, tmp_path / "counted", tmp_path / "count")
    assert calls > 50
    codes = set()
    for number, at in enumerate(range(1, calls + 1, 11)):
        trial = faults.failing(binary, subject, tmp_path / f"run{number}", expected, at, kind, reason)
        assert trial.passed, trial
        codes.add(trial.code)
    assert 5 in codes


@needs_failing_writes
@pytest.mark.parametrize(
    ("reason", "words"), [("std", "a call of the system failed?[31m"), ("other", "an exception of unknown type")]
)
def test_exceptions_are_reported(thawslide: Program, small_case: Path, tmp_path: Path, reason: str, words: str) -> None:
    """Any exception that no code expects: here one that opening the lock of the run throws."""
    command = ["run", small_case, "--output", tmp_path / "run"]
    environment = faults.environment_of_fault(tmp_path / "run", 2, "once", reason)
    message = thawslide.error(*command, code=1, environment=environment)
    assert message.startswith("error: internal error of thawslide ")
    assert message.endswith(f", please report it with the command line: {words}\n")


@pytest.mark.parametrize("size", [1_000, 9_000, 20_000])
def test_a_limit_of_file_sizes_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, size: int) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    trial = faults.limited(binary, subject, tmp_path / "run", expected, size)
    assert trial.passed, trial


@pytest.mark.parametrize("size", [40, 100, 150])
def test_a_full_disk_loses_nothing(binary: Path, small_case: Path, tmp_path: Path, size: int) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    trial = faults.on_small_disk(binary, subject, tmp_path / "disk", expected, (size, 10_000))
    if trial is None:
        pytest.skip("mount is not allowed: no small disk available")
    assert trial.passed, trial


def test_a_read_only_folder_is_reported_before_a_computation(binary: Path, small_case: Path, tmp_path: Path) -> None:
    subject = Subject("small", small_case)
    expected, _ = undisturbed(binary, subject, tmp_path / "undisturbed")
    trial = faults.failing(binary, subject, tmp_path / "run", expected, 1, "onwards", "denied")
    assert trial.code == 5 and "Permission denied" in trial.reported and trial.passed, trial


@pytest.mark.parametrize("size", [8, 60])
def test_a_disk_full_at_the_start_exits_with_5(thawslide: Program, small_case: Path, tmp_path: Path, size: int) -> None:
    run = tmp_path / "disk" / "run"
    with mounted(run.parent, size) as is_mounted:
        if not is_mounted:
            pytest.skip("mount is not allowed: no small disk available")
        outcome = thawslide("run", small_case, "--output", run)
        assert outcome.returncode == 5
        assert "continues from the last checkpoint" not in outcome.stderr
        assert not (run / "checkpoint.bin").exists()
        assert ("starts it again" in outcome.stderr) == (run / "run.json").exists()
