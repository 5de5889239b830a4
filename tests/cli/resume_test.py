"""Interrupted and resumed runs: results are bitwise identical to those of uninterrupted runs."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
from pathlib import Path

import pytest
from conftest import (
    LAMPLUGH,
    LIMIT,
    Interrupted,
    Program,
    assert_bitwise_identical,
    content_of,
    history,
    run_facts,
    sets,
    snapshot_files,
)
from faults import before_its_first_checkpoint, digest, mark_killed

# Rows, snapshots and checkpoints have different times.
WORDS = sets(time__end=3, time__history_interval=0.07, time__output_interval=0.45, checkpoint__interval=0.4)


@pytest.fixture(scope="module")
def complete(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of an uninterrupted run."""
    run = tmp_path_factory.mktemp("runs") / "complete"
    assert thawslide("run", LAMPLUGH, "--output", run, *WORDS).returncode == 0
    return run


@pytest.mark.parametrize(("number", "percent"), [(signal.SIGTERM, 10), (signal.SIGINT, 30)])
def test_a_stopped_run_ends_bitwise_identical(
    thawslide: Program, interrupted: Interrupted, complete: Path, tmp_path: Path, number: int, percent: int
) -> None:
    run = tmp_path / "run"
    assert interrupted(LAMPLUGH, run, WORDS, number, percent) == 4
    facts = run_facts(run)
    assert facts["status"] == "stopped" and facts["message"] == f"signal {int(number)}"
    stop = facts["simulated_time_s"]
    assert 3 * percent / 100 <= stop < 3.0
    assert history(run)["time_s"][-1] <= stop
    outcome = thawslide("resume", run, "--threads", 1)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(f"continuing from t = {stop:g} s\n")
    assert_bitwise_identical(complete, run)
    assert (run / "checkpoint.bin").read_bytes() == (complete / "checkpoint.bin").read_bytes()
    after, expected = run_facts(run), run_facts(complete)
    assert after["status"] == "done" and after["steps"] == expected["steps"] == 300
    assert after["inputs"] == expected["inputs"]
    # Command and start are those of the first part; wall-clock time and particle steps are sums of both.
    first, second = after["parts"]
    assert after["command"] == facts["command"] == first["command"] and after["started"] == facts["started"]
    assert second["command"].endswith(f"resume {run} --threads 1") and second["threads"] == 1
    assert (first["from_s"], second["from_s"]) == (0, stop)
    assert first["wall_s"] == facts["wall_s"] and after["wall_s"] == first["wall_s"] + second["wall_s"]
    assert first["particle_steps"] + second["particle_steps"] == after["particles"] * 300
    assert after["particle_steps_per_second"] == pytest.approx(after["particles"] * 300 / after["wall_s"])


def test_a_stopped_run_on_band_columns_ends_bitwise_identical(
    thawslide: Program, interrupted: Interrupted, tmp_path: Path
) -> None:
    case, complete, run = LAMPLUGH.parent / "lamplugh-columns", tmp_path / "complete", tmp_path / "run"
    assert thawslide("run", case, "--output", complete, *WORDS).returncode == 0
    assert interrupted(case, run, WORDS, signal.SIGTERM, 30) == 4
    assert thawslide("resume", run, "--threads", 1).returncode == 0
    assert_bitwise_identical(complete, run)
    assert (run / "checkpoint.bin").read_bytes() == (complete / "checkpoint.bin").read_bytes()


def test_a_killed_run_continues_from_its_last_checkpoint(
    thawslide: Program, interrupted: Interrupted, complete: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    assert interrupted(LAMPLUGH, run, WORDS, signal.SIGKILL, 30) == -signal.SIGKILL
    assert run_facts(run)["status"] == "running"
    rows = history(run)["time_s"]
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    reported = re.match(
        r"continuing from t = (\S+) s; it had reached (\S+) s: rows and snapshots after (\S+) s are written again\n",
        outcome.stdout,
    )
    assert reported and reported[1] == reported[3] and float(reported[2]) == pytest.approx(rows[-1], rel=1e-5)
    checkpoint = float(reported[1])
    assert 0.8 <= checkpoint <= rows[-1] + 0.07 and checkpoint / 0.4 == pytest.approx(round(checkpoint / 0.4))
    assert_bitwise_identical(complete, run)


def test_a_stopped_run_prints_the_command_to_continue(
    binary: Path, plain_environment: dict[str, str], tmp_path: Path
) -> None:
    run = tmp_path / "run"
    command = [str(binary), "run", str(LAMPLUGH), "--output", str(run), *WORDS]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=plain_environment, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout
        while "%" not in process.stdout.readline():
            assert process.poll() is None
        process.terminate()
        _, errors = process.communicate(timeout=LIMIT)
    stop = run_facts(run)["simulated_time_s"]
    assert errors == f"interrupted by signal 15 at t = {stop:g} s. To continue: thawslide resume {run}\n"


def test_a_finished_run_continues_when_its_end_is_moved(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    # 11 steps of 0.9 ms end at 9.9 ms, when the row and the snapshot of 10 ms are due: they must not be written twice.
    words = sets(time__step=0.0009, time__history_interval=0.01, time__output_interval=0.01)
    complete, longer = tmp_path / "complete", tmp_path / "longer"
    assert thawslide("run", small_case, "--output", complete, *sets(time__end=0.05), *words).returncode == 0
    assert thawslide("run", small_case, "--output", longer, *sets(time__end=0.0099), *words).returncode == 0
    outcome = thawslide("resume", longer, "--end", 0.05)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith("continuing from t = 0.0099 s\nchanged: time.end=0.05\n")
    assert_bitwise_identical(complete, longer)
    assert (longer / "case.toml").read_text() == (complete / "case.toml").read_text()
    first, second = run_facts(longer)["parts"]
    assert first["changes"] == [] and second["changes"] == ["time.end=0.05"]
    assert first["case_sha256"] != second["case_sha256"] == run_facts(complete)["parts"][0]["case_sha256"]


def test_a_run_that_particles_have_left_continues(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    words = sets(grid__leaving="remove", grid__max=[15.0, 10.0], body__block__velocity=[20.0, 0.0])
    complete, longer = tmp_path / "complete", tmp_path / "longer"
    assert thawslide("run", small_case, "--output", complete, *words).returncode == 0
    assert thawslide("run", small_case, "--output", longer, *sets(time__end=0.1), *words).returncode == 0
    left = history(longer)["left_mass_kg"][-1]
    assert 0 < left < history(complete)["left_mass_kg"][-1]
    outcome = thawslide("resume", longer, "--set", "time.end=0.2")
    assert outcome.returncode == 0, outcome.stderr
    assert_bitwise_identical(complete, longer)
    assert (longer / "checkpoint.bin").read_bytes() == (complete / "checkpoint.bin").read_bytes()
    assert run_facts(longer)["particles"] == run_facts(complete)["particles"]


def test_resume_does_not_change_a_finished_run(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    before = content_of(run)
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0
    assert outcome.stdout == f"{run} has reached its end at 0.2 s; nothing to do\n"
    assert content_of(run) == before


def test_resume_without_a_run_is_refused(thawslide: Program, tmp_path: Path) -> None:
    outcome = thawslide("resume", tmp_path)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {tmp_path} is not a run folder: run.json not found. Specify the folder that `thawslide run` printed, "
        "or run the case again.\n"
    )
    assert list(tmp_path.iterdir()) == []


def damaged(content: bytes, damage: str) -> bytes:
    if damage == "a lost end":
        return content[: len(content) // 2]
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


@pytest.mark.parametrize("damage", ["a changed byte", "a lost end"])
def test_a_damaged_checkpoint_is_replaced_by_the_previous_one(
    thawslide: Program, small_case: Path, tmp_path: Path, damage: str
) -> None:
    run, complete = tmp_path / "run", tmp_path / "complete"
    words = sets(checkpoint__interval=0.15)
    assert thawslide("run", small_case, "--output", run, *words).returncode == 0
    assert thawslide("run", small_case, "--output", complete, *words).returncode == 0
    mark_killed(run)
    file = run / "checkpoint.bin"
    file.write_bytes(damaged(file.read_bytes(), damage))
    size = file.stat().st_size
    before = shutil.copy(run / "checkpoint.previous.bin", tmp_path / "before.bin")
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(
        f"warning: {file} is damaged: its checksum does not fit its {size} bytes; it is kept as "
        f"checkpoint.damaged.bin, "
        "and the run continues from the previous checkpoint\n"
        "continuing from t = 0.15 s; it had reached 0.2 s: rows and snapshots after 0.15 s are written again\n"
    )
    # The intact checkpoint is unchanged, with the damaged one next to it.
    assert (run / "checkpoint.previous.bin").read_bytes() == before.read_bytes()
    assert run_facts(run)["parts"][1]["warnings"] == [outcome.stdout.splitlines()[0].removeprefix("warning: ")]
    assert_bitwise_identical(complete, run)
    assert file.read_bytes() == (complete / "checkpoint.bin").read_bytes()


@pytest.mark.parametrize("damage", ["a changed byte", "a lost end"])
def test_two_damaged_checkpoints_are_refused(thawslide: Program, small_case: Path, tmp_path: Path, damage: str) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    mark_killed(run)
    files = [run / "checkpoint.bin", run / "checkpoint.previous.bin"]
    for file in files:
        file.write_bytes(damaged(file.read_bytes(), damage))
    rows, snapshots = (run / "history.csv").read_bytes(), len(snapshot_files(run))
    outcome = thawslide("resume", run)
    assert outcome.returncode == 2
    for file in files:
        assert f"{file} is damaged" in outcome.stderr
    assert (run / "history.csv").read_bytes() == rows and len(snapshot_files(run)) == snapshots


def test_a_run_killed_after_its_initial_checkpoint_ends_bitwise_identical(
    thawslide: Program, binary: Path, plain_environment: dict[str, str], tmp_path: Path
) -> None:
    run = tmp_path / "run"
    words = sets(time__end=3, time__history_interval=0.07, time__output_interval=0.45)
    command = [str(binary), "run", str(LAMPLUGH), "--output", str(run), *words]
    with subprocess.Popen(command, env=plain_environment, stdout=subprocess.DEVNULL) as process:
        while not (run / "checkpoint.bin").exists():
            assert process.poll() is None
        process.kill()
    torn = run / "snapshots" / ".000007.vtkhdf.17.thawslide-part"
    torn.write_bytes(b"half a file")
    outcome = thawslide("resume", run, "--threads", 1)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith("continuing from t = 0 s")
    assert not torn.exists()
    twin = tmp_path / "twin"
    assert thawslide("run", LAMPLUGH, "--output", twin, *words).returncode == 0
    assert_bitwise_identical(twin, run)


def test_checkpoints_are_also_written_by_wall_clock_time(
    binary: Path, plain_environment: dict[str, str], tmp_path: Path
) -> None:
    """A second checkpoint exists long before the end, at which the next one would be due otherwise."""
    run = tmp_path / "run"
    command = [str(binary), "run", str(LAMPLUGH), "--output", str(run), *sets(checkpoint__wall_interval=0.2)]
    with subprocess.Popen(command, env=plain_environment, stdout=subprocess.DEVNULL) as process:
        while not (run / "checkpoint.previous.bin").exists():
            assert process.poll() is None
        process.kill()
    assert run_facts(run)["status"] == "running"


def test_a_run_killed_at_its_very_end_is_completed(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    """The last checkpoint exists, the index does not."""
    run, complete = tmp_path / "run", tmp_path / "complete"
    for folder in (run, complete):
        assert thawslide("run", small_case, "--output", folder).returncode == 0
    mark_killed(run)
    (run / "particles.vtkhdf").unlink()
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith("continuing from t = 0.2 s\n")
    assert run_facts(run)["status"] == "done"
    assert digest(run) == digest(complete)


def test_a_run_killed_before_its_first_checkpoint_starts_again(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run, complete = tmp_path / "run", tmp_path / "complete"
    for folder in (run, complete):
        assert thawslide("run", small_case, "--output", folder).returncode == 0
    before_its_first_checkpoint(run)
    (run / "terrain.csv").unlink()
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(f"{run} was cut off before its first checkpoint; it starts again\n")
    assert_bitwise_identical(complete, run)
    assert [part["from_s"] for part in run_facts(run)["parts"]] == [0, 0]
    assert run_facts(run)["inputs"] == run_facts(complete)["inputs"]


def test_a_run_killed_before_it_wrote_its_case_can_be_run_again(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    (run / "inputs").mkdir(parents=True)
    (run / "run.lock").write_text("process 1 on elsewhere\n")
    (run / "inputs" / ".case.toml.12.thawslide-part").write_text("half")
    outcome = thawslide("run", small_case, "--output", run)
    assert outcome.returncode == 0, outcome.stderr
    assert sorted(file.name for file in (run / "inputs").iterdir()) == ["case.toml"]
    assert not (run / "run.lock").exists()


def test_a_changed_case_is_refused(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    mark_killed(run)
    file = run / "case.toml"
    text = file.read_text()
    changed = text.replace("\nend = 0.2 ", "\nend = 0.3 ").replace("\ncohesion = 100000.0 ", "\ncohesion = 200000.0 ")
    file.write_text(changed)
    before = content_of(run)
    outcome = thawslide("resume", run)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {file} has changed since the run wrote its checkpoint: material.rock.cohesion is 200000.0, was "
        "100000.0; time.end is 0.3, was 0.2. Put that back, or remove the file, which is then written again. Specify "
        f"changes on the command line: thawslide resume {run} --set KEY=VALUE, or --end T.\n"
    )
    assert content_of(run) == before
    file.unlink()
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    assert f"note: {file} was missing. It was written again from the checkpoint\n" in outcome.stdout
    assert file.read_text() == text


def test_a_changed_report_table_does_not_prevent_resuming(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    """[report] and the title do not affect a run."""
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    mark_killed(run)
    file = run / "case.toml"
    text = file.read_text().replace("\ntimes = []", "\ntimes = [0.1]")
    assert "times = [0.1]" in text
    file.write_text(text)
    assert thawslide("resume", run).returncode == 0
    assert file.read_text() == text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--set", "grid.cell=2", "--set", "body.block.porosity=0.1", "--end", "1"],
            "grid.cell, body.block.porosity cannot be changed on resume, because earlier results depend on it. "
            "Allowed: [time], [checkpoint], [guards], grid.leaving, ",
        ),
        (["--end", "0.1"], "the end of 0.1 s has passed: the run had reached 0.2 s. Give a later one."),
        (["--end", "2", "--set", "time.end=3"], "--end is short for --set time.end: give one of the two."),
        (["--end", "-1"], "-1 found; allowed: above 0"),
        (["--set", "time.ende=3"], "--set time.ende=3: key 'time.ende' is not known in [time]; did you mean 'end'?"),
    ],
)
def test_invalid_changes_are_refused(
    thawslide: Program, small_case: Path, tmp_path: Path, words: list[str], message: str
) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    before = content_of(run)
    outcome = thawslide("resume", run, *words)
    assert outcome.returncode == 2
    assert message in outcome.stderr
    assert content_of(run) == before


def test_an_interrupted_change_must_be_repeated(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    """run.json contains the change, case.toml does not yet."""
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    text = (run / "case.toml").read_text()
    checkpoint = (run / "checkpoint.bin").read_bytes()
    assert thawslide("resume", run, "--end", 0.3).returncode == 0
    mark_killed(run)
    (run / "case.toml").write_text(text)
    (run / "checkpoint.bin").write_bytes(checkpoint)
    outcome = thawslide("resume", run)
    assert outcome.returncode == 2
    assert f"Specify it again: thawslide resume {run} --set time.end=0.3\n" in outcome.stderr
    assert thawslide("resume", run, "--set", "time.end=0.3").returncode == 0
    assert run_facts(run)["simulated_time_s"] == pytest.approx(0.3)
