"""Interrupted and resumed runs: results are bitwise identical to those of uninterrupted runs."""

import re
import shutil
import signal
import subprocess
from pathlib import Path

import pytest
from conftest import HANG, LAMPLUGH, Interrupted, Program, Ran, assert_identical, history, mark_killed, run_facts, sets
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


def test_a_stopped_run_prints_the_command_to_continue(thawslide: Program, run: Path) -> None:
    with thawslide.start("run", LAMPLUGH, "--output", run, *WORDS) as process:
        assert process.stdout
        while "%" not in process.stdout.readline():
            assert process.poll() is None
        process.terminate()
        _, errors = process.communicate(timeout=HANG)
    stop = run_facts(run)["simulated_time_s"]
    assert errors == f"interrupted by signal 15 at t = {stop:g} s. To continue: thawslide resume {run}\n"


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
