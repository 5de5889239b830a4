"""Kills and failing writes: a run that goes on ends with the files of one that nothing disturbed.

A sample; all of them are in scripts/reliability.
"""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from conftest import LAMPLUGH, sets
from faults import FAILING_WRITES, Subject, calls_that_write, failing, killed, undisturbed

SHORT = tuple(sets(time__end=0.3, time__history_interval=0.07, time__output_interval=0.05, checkpoint__interval=0.04))


@pytest.mark.parametrize("case", ["lamplugh", "lamplugh-columns"])
def test_killed_runs_end_with_the_same_bits(binary: Path, tmp_path: Path, case: str) -> None:
    subject = Subject(case, LAMPLUGH.parent / case, SHORT)
    expected, span = undisturbed(binary, subject, tmp_path / "whole")
    chance = random.Random(20160628)
    for number in range(4):
        trial = killed(binary, subject, tmp_path / f"run{number}", expected, span, chance)
        assert trial.sound, trial


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
        assert trial.sound, trial
        codes.add(trial.code)
    assert 5 in codes
