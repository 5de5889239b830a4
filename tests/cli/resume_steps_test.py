"""Adaptive steps and resumed runs with other steps: rows, snapshots and times follow them."""

import shutil
import signal
from pathlib import Path

import conftest
import numpy as np
import pytest
from conftest import LAMPLUGH, Program, Ran, assert_identical, history, mark_killed, run_facts, sets, snapshot_files

END, ROWS, SNAPSHOTS = 3.0, 0.09, 0.45  # s; each snapshot has a row; steps end at snapshots only
WORDS = sets(time__safety=0.77, time__end=END, time__history_interval=ROWS, time__output_interval=SNAPSHOTS)


@pytest.fixture(scope="module")
def whole(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("runs") / "whole"
    thawslide.ok("run", LAMPLUGH, "--output", run, *WORDS)
    return run


def test_each_row_follows_the_first_step_that_reaches_its_time(ran: Ran, whole: Path) -> None:
    words = [*WORDS, *sets(time__history_interval=0)]
    every = ran(*words, case=LAMPLUGH, name="every")
    steps, rows = history(every)["time_s"], history(whole)["time_s"]
    due = [*np.arange(0.0, END, ROWS), END]
    round_off = 1e-9
    assert rows.tolist() == [steps[np.argmax(steps > due_time - round_off)] for due_time in due]
    assert np.any(rows > np.array(due) + 1e-4), "no row is late: the test has no effect"


def test_rows_change_no_step_and_snapshots_are_on_time(ran: Ran, whole: Path) -> None:
    words = [*WORDS, *sets(time__history_interval=1.1)]
    few = ran(*words, case=LAMPLUGH, name="few")
    assert run_facts(few)["steps"] == run_facts(whole)["steps"]
    for one, other in zip(snapshot_files(few), snapshot_files(whole), strict=True):
        first, second = conftest.datasets(one), conftest.datasets(other)
        assert all(values.tobytes() == second[key].tobytes() for key, values in first.items()), one.name
    rows = history(whole)["time_s"]
    late = [float(np.min(np.abs(rows - due_time))) for due_time in np.arange(0.0, END, SNAPSHOTS)]
    assert late == pytest.approx(np.zeros(len(late)), abs=1e-9), "each snapshot has a row of its time"


@pytest.mark.parametrize("percent", [10, 40])
def test_a_stopped_run_ends_bitwise_identical(
    thawslide: Program, interrupted: conftest.Interrupted, whole: Path, run: Path, percent: int
) -> None:
    assert interrupted(LAMPLUGH, run, WORDS, signal.SIGTERM, percent) == 4
    assert 0.0 < run_facts(run)["simulated_time_s"] < END
    thawslide.ok("resume", run, "--threads", 1)
    assert_identical(whole, run)
    assert run_facts(run)["steps"] == run_facts(whole)["steps"]


RESTS = sets(
    time__end=2, time__history_interval=0.05, time__output_interval=0.5, body__block__velocity="[3,0]",
    time__stop_at_rest=0.5, time__rest_time=0.0515,
)  # fmt: skip


@pytest.mark.parametrize(("step", "steps"), [(0.002, 25), (0.0005, 100), (0.0007, 71)])
def test_time_continues_from_the_end_with_other_steps(thawslide: Program, done: Path, step: float, steps: int) -> None:
    thawslide.ok("resume", done, "--end", 0.25, *sets(time__step=step, time__history_interval=0))
    rows = history(done)
    end = run_facts(done)["simulated_time_s"]
    assert end == pytest.approx(0.2 + steps * step, rel=1e-12) and abs(end - 0.25) <= 0.5 * step
    assert run_facts(done)["steps"] == 200 + steps
    times = rows["time_s"][rows["step"] >= 200]
    assert times[0] == 0.2 and len(times) == steps + 1
    assert np.diff(times) == pytest.approx(step, rel=1e-9)


def test_time_continues_when_steps_become_adaptive_and_fixed_again(thawslide: Program, done: Path) -> None:
    changes = sets(time__stepping="adaptive", time__history_interval=0)
    thawslide.ok("resume", done, "--end", 0.25, *changes)
    assert run_facts(done)["simulated_time_s"] == 0.25
    thawslide.ok("resume", done, "--end", 0.3, *sets(time__stepping="fixed"))
    rows = history(done)
    assert rows["time_s"][-1] == pytest.approx(0.3, abs=1e-12)
    assert np.all(np.diff(rows["time_s"]) > 0)
    assert np.diff(rows["time_s"][rows["time_s"] >= 0.25]) == pytest.approx(0.001, rel=1e-6)


def test_other_steps_are_bitwise_identical_after_a_kill(thawslide: Program, done: Path, tmp_path: Path) -> None:
    words = ["--end", 0.3, *sets(time__step=0.0007, checkpoint__interval=0.03)]
    twice = tmp_path / "twice"
    shutil.copytree(done, twice)
    thawslide.ok("resume", done, *words)
    thawslide.ok("resume", twice, *words)
    mark_killed(twice)
    (twice / "checkpoint.previous.bin").rename(twice / "checkpoint.bin")
    assert "continuing from t = 0.2" in thawslide.ok("resume", twice)
    assert_identical(done, twice)


def test_checkpoints_change_no_step(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    words = sets(time__stepping="adaptive", time__end=0.5, time__history_interval=0.07, body__block__velocity="[2,0]")
    runs = [tmp_path / name for name in ("without", "with")]
    for run, interval in zip(runs, (0, 0.013), strict=True):
        thawslide.ok("run", small_case, "--output", run, *words, *sets(checkpoint__interval=interval))
    assert_identical(*runs)


def test_the_guard_of_small_steps_acts_once_steps_are_adaptive(thawslide: Program, done: Path) -> None:
    """Later steps are compared with the first adaptive step."""
    changes = sets(time__stepping="adaptive", time__step=1, guards__smallest_step=0.9)
    thawslide.ok("resume", done, "--end", 0.25, *changes)
    message = thawslide.error("resume", done, "--end", 0.3, *sets(time__safety=0.4), code=3)
    assert "where guards.smallest_step allows 0.9" in message


@pytest.mark.parametrize("interval", [0.001, 10.0])
def test_last_row_and_snapshot_precede_the_checkpoint(ran: Ran, thawslide: Program, interval: float) -> None:
    """Therefore a kill between them loses no results."""
    run = ran(*RESTS, *sets(checkpoint__interval=interval))
    rest = run_facts(run)["simulated_time_s"]
    rows, names = (run / "history.csv").read_bytes(), [file.name for file in snapshot_files(run)]
    assert history(run)["time_s"][-1] == rest
    mark_killed(run)
    thawslide.ok("resume", run)
    assert (run / "history.csv").read_bytes() == rows
    assert [file.name for file in snapshot_files(run)] == names
    assert run_facts(run)["message"].startswith("the slide is at rest")
