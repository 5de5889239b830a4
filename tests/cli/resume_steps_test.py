"""Simulated time of resumed runs with other steps, and the last row of a run that ends at rest."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, assert_bitwise_identical, history, run_facts, sets, snapshot_files
from faults import mark_killed

RESTS = sets(
    time__end=2,
    time__history_interval=0.05,
    time__output_interval=0.5,
    body__block__velocity="[3,0]",
    time__stop_at_rest=0.5,
    time__rest_time=0.0515,
)


@pytest.mark.parametrize(("step", "steps"), [(0.002, 25), (0.0005, 100), (0.0007, 71)])
def test_time_continues_from_the_end_with_other_steps(thawslide: Program, done: Path, step: float, steps: int) -> None:
    outcome = thawslide("resume", done, "--end", 0.25, *sets(time__step=step, time__history_interval=0))
    assert outcome.returncode == 0, outcome.stderr
    rows = history(done)
    end = run_facts(done)["simulated_time_s"]
    assert end == pytest.approx(0.2 + steps * step, rel=1e-12) and abs(end - 0.25) <= 0.5 * step
    assert run_facts(done)["steps"] == 200 + steps
    times = rows["time_s"][rows["step"] >= 200]
    assert times[0] == 0.2 and len(times) == steps + 1
    assert np.diff(times) == pytest.approx(step, rel=1e-9)


def test_time_continues_when_steps_become_adaptive_and_fixed_again(thawslide: Program, done: Path) -> None:
    changes = sets(time__stepping="adaptive", time__history_interval=0)
    assert thawslide("resume", done, "--end", 0.25, *changes).returncode == 0
    assert run_facts(done)["simulated_time_s"] == 0.25
    assert thawslide("resume", done, "--end", 0.3, *sets(time__stepping="fixed")).returncode == 0
    rows = history(done)
    assert rows["time_s"][-1] == pytest.approx(0.3, abs=1e-12)
    assert np.all(np.diff(rows["time_s"]) > 0)
    assert np.diff(rows["time_s"][rows["time_s"] >= 0.25]) == pytest.approx(0.001, rel=1e-6)


def test_later_times_include_a_shorter_last_step(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert (
        thawslide("run", small_case, "--output", run, *sets(time__end=0.2007, time__history_interval=0)).returncode == 0
    )
    assert history(run)["time_s"][-1] == 0.2007
    assert thawslide("resume", run, "--end", 0.2107).returncode == 0
    times = history(run)["time_s"]
    assert times[-1] == pytest.approx(0.2107, abs=1e-12)
    assert times[202] - times[201] == pytest.approx(0.001, rel=1e-9)


def test_other_steps_are_bitwise_identical_after_a_kill(thawslide: Program, done: Path, tmp_path: Path) -> None:
    words = ["--end", 0.3, *sets(time__step=0.0007, checkpoint__interval=0.03)]
    twice = tmp_path / "twice"
    shutil.copytree(done, twice)
    assert thawslide("resume", done, *words).returncode == 0
    assert thawslide("resume", twice, *words).returncode == 0
    mark_killed(twice)
    (twice / "checkpoint.previous.bin").rename(twice / "checkpoint.bin")
    outcome = thawslide("resume", twice)
    assert outcome.returncode == 0 and "continuing from t = 0.2" in outcome.stdout, outcome.stderr
    assert_bitwise_identical(done, twice)


def test_checkpoints_change_no_step(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    words = sets(time__stepping="adaptive", time__end=0.5, time__history_interval=0.07, body__block__velocity="[2,0]")
    runs = [tmp_path / name for name in ("without", "with")]
    for run, interval in zip(runs, (0, 0.013), strict=True):
        outcome = thawslide("run", small_case, "--output", run, *words, *sets(checkpoint__interval=interval))
        assert outcome.returncode == 0, outcome.stderr
    assert_bitwise_identical(*runs)


def test_the_guard_of_small_steps_acts_once_steps_are_adaptive(thawslide: Program, done: Path) -> None:
    """Later steps are compared with the first adaptive step."""
    changes = sets(time__stepping="adaptive", time__step=1, guards__smallest_step=0.9)
    assert thawslide("resume", done, "--end", 0.25, *changes).returncode == 0
    outcome = thawslide("resume", done, "--end", 0.3, *sets(time__safety=0.4))
    assert outcome.returncode == 3
    assert "where guards.smallest_step allows 0.9" in outcome.stderr


@pytest.mark.parametrize("interval", [0.001, 10.0])
def test_the_last_row_and_snapshot_at_rest_precede_the_checkpoint(
    thawslide: Program, small_case: Path, tmp_path: Path, interval: float
) -> None:
    """Therefore a kill between them loses no results."""
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run, *RESTS, *sets(checkpoint__interval=interval)).returncode == 0
    rest = run_facts(run)["simulated_time_s"]
    rows, names = (run / "history.csv").read_bytes(), [file.name for file in snapshot_files(run)]
    assert history(run)["time_s"][-1] == rest
    mark_killed(run)
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    assert (run / "history.csv").read_bytes() == rows
    assert [file.name for file in snapshot_files(run)] == names
    assert run_facts(run)["message"].startswith("the slide is at rest")
