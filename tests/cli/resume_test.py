"""Interrupted and resumed runs: results are bitwise identical to those of uninterrupted runs.

Also with other steps and adaptive steps.
"""

import re
import shutil
import signal
import subprocess
from pathlib import Path

import conftest
import numpy as np
import pytest
from conftest import LAMPLUGH, Interrupted, Program, Ran, assert_identical, history, mark_killed, run_facts, sets
from faults import before_its_first_checkpoint, digest

# Rows, snapshots and checkpoints have different times.
WORDS = sets(time__end=3, time__history_interval=0.07, time__output_interval=0.45, checkpoint__interval=0.4)


@pytest.fixture(scope="module")
def complete(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("runs") / "complete"
    thawslide.ok("run", LAMPLUGH, "--output", run, *WORDS)
    return run


@pytest.mark.parametrize(("number", "percent"), [(signal.SIGTERM, 10), (signal.SIGINT, 30)])
def test_a_stopped_run_ends_bitwise_identical(
    thawslide: Program, interrupted: Interrupted, complete: Path, run: Path, number: int, percent: int
) -> None:
    assert interrupted(LAMPLUGH, run, WORDS, number, percent) == 4
    facts = run_facts(run)
    assert facts["status"] == "stopped" and facts["message"] == f"signal {int(number)}"
    stop = facts["simulated_time_s"]
    assert 3 * percent / 100 <= stop < 3.0
    assert history(run)["time_s"][-1] <= stop
    assert thawslide.ok("resume", run, "--threads", 1).startswith(f"continuing from t = {stop:g} s\n")
    assert_identical(complete, run)
    assert (run / "checkpoint.bin").read_bytes() == (complete / "checkpoint.bin").read_bytes()
    after, expected = run_facts(run), run_facts(complete)
    assert after["status"] == "done" and after["steps"] == expected["steps"] == 600
    assert after["inputs"] == expected["inputs"]
    # Command and start are those of the first part; wall-clock time and particle steps are sums of both.
    first, second = after["parts"]
    assert after["command"] == facts["command"] == first["command"] and after["started"] == facts["started"]
    assert second["command"].endswith(f"resume {run} --threads 1") and second["threads"] == 1
    assert (first["from_s"], second["from_s"]) == (0, stop)
    assert first["wall_s"] == facts["wall_s"] and after["wall_s"] == first["wall_s"] + second["wall_s"]
    assert first["particle_steps"] + second["particle_steps"] == after["particles"] * 600
    assert after["particle_steps_per_second"] == pytest.approx(after["particles"] * 600 / after["wall_s"])


def test_a_killed_run_continues(thawslide: Program, interrupted: Interrupted, complete: Path, run: Path) -> None:
    assert interrupted(LAMPLUGH, run, WORDS, signal.SIGKILL, 30) == -signal.SIGKILL
    assert run_facts(run)["status"] == "running"
    rows = history(run)["time_s"]
    torn = run / "snapshots" / ".000007.vtkhdf.17.thawslide-part"
    torn.write_bytes(b"half a file")
    printed = thawslide.ok("resume", run)
    assert not torn.exists()
    reported = re.match(
        r"continuing from t = (\S+) s; it had reached (\S+) s: rows and snapshots after (\S+) s are written again\n",
        printed,
    )
    assert reported and reported[1] == reported[3] and float(reported[2]) == pytest.approx(rows[-1], rel=1e-5)
    checkpoint = float(reported[1])
    assert 0.8 <= checkpoint <= rows[-1] + 0.07 and checkpoint / 0.4 == pytest.approx(round(checkpoint / 0.4))
    assert_identical(complete, run)


def test_a_finished_run_continues_when_its_end_is_moved(ran: Ran, thawslide: Program) -> None:
    # 11 steps of 0.9 ms end at 9.9 ms, when the row and the snapshot of 10 ms are due: they must not be written twice.
    words = sets(time__step=0.0009, time__history_interval=0.01, time__output_interval=0.01)
    complete = ran(*sets(time__end=0.05), *words, name="complete")
    longer = ran(*sets(time__end=0.0099), *words, name="longer")
    printed = thawslide.ok("resume", longer, "--end", 0.05)
    assert printed.startswith("continuing from t = 0.0099 s\nchanged: time.end=0.05\n")
    assert_identical(complete, longer)
    assert (longer / "case.toml").read_text() == (complete / "case.toml").read_text()
    first, second = run_facts(longer)["parts"]
    assert first["changes"] == [] and second["changes"] == ["time.end=0.05"]
    assert first["case_sha256"] != second["case_sha256"] == run_facts(complete)["parts"][0]["case_sha256"]


def test_a_run_that_particles_have_left_continues(ran: Ran, thawslide: Program) -> None:
    words = sets(grid__leaving="remove", grid__max=[15.0, 10.0], body__block__velocity=[20.0, 0.0])
    complete = ran(*words, name="complete")
    longer = ran(*sets(time__end=0.1), *words, name="longer")
    left = history(longer)["left_mass_kg"][-1]
    assert 0 < left < history(complete)["left_mass_kg"][-1]
    thawslide.ok("resume", longer, "--set", "time.end=0.2")
    assert_identical(complete, longer)
    assert (longer / "checkpoint.bin").read_bytes() == (complete / "checkpoint.bin").read_bytes()
    assert run_facts(longer)["particles"] == run_facts(complete)["particles"]


def test_a_previous_checkpoint_replaces_a_damaged_one(ran: Ran, thawslide: Program, tmp_path: Path) -> None:
    run = ran(*sets(checkpoint__interval=0.15))
    complete = Path(shutil.copytree(run, tmp_path / "complete"))
    mark_killed(run)
    file = run / "checkpoint.bin"
    size = file.stat().st_size // 2
    file.write_bytes(file.read_bytes()[:size])
    before = shutil.copy(run / "checkpoint.previous.bin", tmp_path / "before.bin")
    printed = thawslide.ok("resume", run)
    assert printed.startswith(
        f"warning: {file} is damaged: its checksum does not fit its {size} bytes; it is kept as "
        "checkpoint.damaged.bin, and the run continues from the previous checkpoint\n"
        "continuing from t = 0.15 s; it had reached 0.2 s: rows and snapshots after 0.15 s are written again\n"
    )
    # The intact checkpoint is unchanged, with the damaged one next to it.
    assert (run / "checkpoint.previous.bin").read_bytes() == before.read_bytes()
    assert run_facts(run)["parts"][1]["warnings"] == [printed.splitlines()[0].removeprefix("warning: ")]
    assert_identical(complete, run)
    assert file.read_bytes() == (complete / "checkpoint.bin").read_bytes()


def test_checkpoints_are_also_written_by_wall_clock_time(thawslide: Program, run: Path) -> None:
    """A second checkpoint exists long before the end, at which the next one would be due otherwise."""
    often = sets(checkpoint__wall_interval=0.2)
    with thawslide.start("run", LAMPLUGH, "--output", run, *often, stdout=subprocess.DEVNULL) as process:
        while not (run / "checkpoint.previous.bin").exists():
            assert process.poll() is None
        process.kill()
    assert run_facts(run)["status"] == "running"


def test_a_run_killed_at_its_very_end_is_completed(thawslide: Program, finished: Path, killed: Path) -> None:
    """The last checkpoint exists, the index does not."""
    (killed / "particles.vtkhdf").unlink()
    assert thawslide.ok("resume", killed).startswith("continuing from t = 0.2 s\n")
    assert run_facts(killed)["status"] == "done"
    assert digest(killed) == digest(finished)


def test_a_run_killed_before_its_first_checkpoint_starts_again(thawslide: Program, finished: Path, done: Path) -> None:
    before_its_first_checkpoint(done)
    (done / "terrain.csv").unlink()
    assert thawslide.ok("resume", done).startswith(f"{done} was cut off before its first checkpoint; it starts again\n")
    assert_identical(finished, done)
    assert [part["from_s"] for part in run_facts(done)["parts"]] == [0, 0]
    assert run_facts(done)["inputs"] == run_facts(finished)["inputs"]


def test_a_run_killed_before_its_case_can_be_repeated(thawslide: Program, small_case: Path, run: Path) -> None:
    (run / "inputs").mkdir(parents=True)
    (run / "run.lock").write_text("process 1 on elsewhere\n")
    (run / "inputs" / ".case.toml.12.thawslide-part").write_text("half")
    thawslide.ok("run", small_case, "--output", run)
    assert sorted(file.name for file in (run / "inputs").iterdir()) == ["case.toml"]
    assert not (run / "run.lock").exists()


ADAPTIVE_END, ROWS, SNAPSHOTS = 3.0, 0.09, 0.45  # s; each snapshot has a row; steps end at snapshots only
ADAPTIVE = sets(time__safety=0.77, time__end=ADAPTIVE_END, time__history_interval=ROWS, time__output_interval=SNAPSHOTS)


@pytest.fixture(scope="module")
def whole(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("runs") / "whole"
    thawslide.ok("run", LAMPLUGH, "--output", run, *ADAPTIVE)
    return run


def test_rows_follow_their_steps_and_change_none(ran: Ran, whole: Path) -> None:
    every = ran(*ADAPTIVE, *sets(time__history_interval=0), case=LAMPLUGH, name="every")
    steps, rows = history(every)["time_s"], history(whole)["time_s"]
    due = [*np.arange(0.0, ADAPTIVE_END, ROWS), ADAPTIVE_END]
    round_off = 1e-9
    assert rows.tolist() == [steps[np.argmax(steps > due_time - round_off)] for due_time in due]
    assert np.any(rows > np.array(due) + 1e-4), "no row is late: the test has no effect"
    few = ran(*ADAPTIVE, *sets(time__history_interval=1.1), case=LAMPLUGH, name="few")
    assert run_facts(few)["steps"] == run_facts(whole)["steps"]
    for one, other in zip(conftest.snapshot_files(few), conftest.snapshot_files(whole), strict=True):
        first, second = conftest.datasets(one), conftest.datasets(other)
        assert all(values.tobytes() == second[key].tobytes() for key, values in first.items()), one.name
    late = [float(np.min(np.abs(rows - due_time))) for due_time in np.arange(0.0, ADAPTIVE_END, SNAPSHOTS)]
    assert late == pytest.approx(np.zeros(len(late)), abs=1e-9), "each snapshot has a row of its time"


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
    rows, names = (run / "history.csv").read_bytes(), [file.name for file in conftest.snapshot_files(run)]
    assert history(run)["time_s"][-1] == rest
    mark_killed(run)
    thawslide.ok("resume", run)
    assert (run / "history.csv").read_bytes() == rows
    assert [file.name for file in conftest.snapshot_files(run)] == names
    assert run_facts(run)["message"].startswith("the slide is at rest")
