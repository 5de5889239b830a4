"""Adaptive steps: rows of the history follow them, snapshots end them, and a resumed run is bitwise identical."""

from __future__ import annotations

import signal
from pathlib import Path

import numpy as np
import pytest
from conftest import (
    LAMPLUGH,
    Interrupted,
    Program,
    assert_bitwise_identical,
    datasets,
    history,
    run_facts,
    sets,
    snapshot_files,
)

END, ROWS, SNAPSHOTS = 3.0, 0.09, 0.45  # s; each snapshot has a row; steps end at snapshots only
WORDS = sets(time__stepping="adaptive", time__end=END, time__history_interval=ROWS, time__output_interval=SNAPSHOTS)


@pytest.fixture(scope="module")
def whole(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a run without interruption."""
    run = tmp_path_factory.mktemp("runs") / "whole"
    assert thawslide("run", LAMPLUGH, "--output", run, *WORDS).returncode == 0
    return run


def test_each_row_follows_the_first_step_that_reaches_its_time(thawslide: Program, whole: Path, tmp_path: Path) -> None:
    every = tmp_path / "every"
    words = [*WORDS, *sets(time__history_interval=0)]
    assert thawslide("run", LAMPLUGH, "--output", every, *words).returncode == 0
    steps, rows = history(every)["time_s"], history(whole)["time_s"]
    due = [*np.arange(0.0, END, ROWS), END]
    round_off = 1e-9
    assert rows.tolist() == [steps[np.argmax(steps > due_time - round_off)] for due_time in due]
    assert np.any(rows > np.array(due) + 1e-4), "no row is late: the test has no effect"


def test_rows_change_no_step_and_snapshots_are_on_time(thawslide: Program, whole: Path, tmp_path: Path) -> None:
    few = tmp_path / "few"
    words = [*WORDS, *sets(time__history_interval=1.1)]
    assert thawslide("run", LAMPLUGH, "--output", few, *words).returncode == 0
    assert run_facts(few)["steps"] == run_facts(whole)["steps"]
    for one, other in zip(snapshot_files(few), snapshot_files(whole), strict=True):
        first, second = datasets(one), datasets(other)
        assert all(values.tobytes() == second[key].tobytes() for key, values in first.items()), one.name
    rows = history(whole)["time_s"]
    late = [float(np.min(np.abs(rows - due_time))) for due_time in np.arange(0.0, END, SNAPSHOTS)]
    assert late == pytest.approx(np.zeros(len(late)), abs=1e-9), "each snapshot has a row of its time"


@pytest.mark.parametrize("percent", [10, 40])
def test_a_stopped_run_ends_bitwise_identical(
    thawslide: Program, interrupted: Interrupted, whole: Path, tmp_path: Path, percent: int
) -> None:
    run = tmp_path / "run"
    assert interrupted(LAMPLUGH, run, WORDS, signal.SIGTERM, percent) == 4
    assert 0.0 < run_facts(run)["simulated_time_s"] < END
    outcome = thawslide("resume", run, "--threads", 1)
    assert outcome.returncode == 0, outcome.stderr
    assert_bitwise_identical(whole, run)
    assert run_facts(run)["steps"] == run_facts(whole)["steps"]
