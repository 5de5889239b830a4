"""Changes of an interrupted or finished run: allowed ones, refused ones, and those that an interruption cut off."""

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import Program, Ran, content_of, edit, history, mark_killed, run_facts, sets
from faults import before_its_first_checkpoint

# Leaves the domain at about 1 s.
LEAVES = sets(time__end=3, grid__max="[17,10]", body__block__velocity="[3,0]", basal__friction_angle=1)
CHECKPOINTS = ("checkpoint.bin", "checkpoint.previous.bin")
Prepare = Callable[[Path], object]


def refused(thawslide: Program, run: Path, *words: object) -> str:
    """Return the error of a resume, which changes no file."""
    before = content_of(run)
    message = thawslide.error("resume", run, *words)
    assert content_of(run) == before
    return message


def changed_case(*changes: tuple[str, str]) -> Prepare:
    """Return a function that edits the case of a killed run."""

    def prepare(run: Path) -> None:
        mark_killed(run)
        for old, new in changes:
            edit(run / "case.toml", old, new)

    return prepare


def without_last_checkpoint(run: Path) -> None:
    mark_killed(run)
    (run / "checkpoint.previous.bin").rename(run / "checkpoint.bin")


def without_checkpoints(run: Path) -> None:
    for name in CHECKPOINTS:
        (run / name).unlink()


def changed_before_checkpoint(run: Path) -> None:
    before_its_first_checkpoint(run)
    edit(run / "case.toml", *COHESION)


def changed_without_checkpoints(run: Path) -> None:
    without_checkpoints(run)
    (run / "history.csv").unlink()
    edit(run / "case.toml", *END)


def foreign_copy(run: Path) -> None:
    inputs = [{"path": "/nowhere", "copy": "../../../etc/hostname", "sha256": "0" * 64, "bytes": 1}]
    (run / "run.json").write_text(json.dumps(run_facts(run) | {"inputs": inputs}))


def unchanged(run: Path) -> None:
    pass


END, COHESION = ("\nend = 0.2 ", "\nend = 0.4 "), ("\ncohesion = 100000.0 ", "\ncohesion = 200000.0 ")
SINCE_START = (
    "{run}/case.toml has changed since the run began (run.json has its SHA-256), and no checkpoint holds its content. "
    "Put back what was there, or run the case again.\n"
)
SINCE_CHECKPOINT = "{run}/case.toml has changed since the run wrote its checkpoint: "
LOST = (
    "{run} had reached 0.2 s, but checkpoint.bin and checkpoint.previous.bin are missing. A new start would overwrite "
    "its results. Put one of them back, or run the case again in another folder: thawslide run {run} --output OTHER.\n"
)


@pytest.mark.parametrize(
    ("prepare", "words", "message"),
    [
        (unchanged, "--set grid.cell=2 --set body.block.porosity=0.1 --end 1",
         "grid.cell, body.block.porosity cannot be changed on resume, because earlier results depend on it. "
         "Allowed: [time], [checkpoint], [guards], grid.leaving, "),
        (unchanged, "--end 0.1", "the end of 0.1 s has passed: the run had reached 0.2 s. Give a later one."),
        (unchanged, "--end 2 --set time.end=3", "--end is short for --set time.end: give one of the two."),
        (unchanged, "--end -1", "-1 found; allowed: above 0"),
        (unchanged, "--set grid.cel=2", "key 'grid.cel' is not known in [grid]; did you mean 'cell'?"),
        (unchanged, "--set basal.friction_angle=5",
         "{run} has reached its end at 0.2 s: no step is left that could take basal.friction_angle=5. Give a later "
         "end too: --end T.\n"),
        (unchanged, "--end 0.3 --set guards.volume=remove", "a continued run cannot change this. Run the case again."),
        # Results after the older checkpoint would be removed.
        (without_last_checkpoint, "--end 0.1",
         "the end of 0.1 s has passed: the run had reached 0.2 s. Give a later one."),
        (changed_case(END, COHESION), "",
         SINCE_CHECKPOINT + "material.rock.cohesion is 200000.0, was 100000.0; time.end is 0.4, was 0.2. Put that "
         "back, or remove the file, which is then written again. Specify changes on the command line: "
         "thawslide resume {run} --set KEY=VALUE, or --end T.\n"),
        (changed_case(END), "",
         SINCE_CHECKPOINT + "time.end is 0.4, was 0.2. Put that back, or remove the file, "),
        (lambda run: edit(run / "case.toml", *END), "",
         "{run} has reached its end at 0.2 s, and {run}/case.toml has changed since: time.end is 0.4, was 0.2. "
         "Put that back, or specify changes on the command line: thawslide resume {run} --set KEY=VALUE --end T.\n"),
        (changed_before_checkpoint, "", SINCE_START),
        (changed_before_checkpoint, "--end 0.3", SINCE_START),
        (changed_without_checkpoints, "",
         "its SHA-256 is not that of run.json. There is no checkpoint to continue from"),
        (without_checkpoints, "--end 0.3", LOST),
        (lambda run: (mark_killed(run), without_checkpoints(run)), "--end 0.3", LOST),
        (foreign_copy, "--end 0.3",
         "{run}/run.json: damaged: it names ../../../etc/hostname as the copy of an input; those lie in inputs/.\n"),
    ],
)  # fmt: skip
def test_a_change_is_refused(thawslide: Program, done: Path, prepare: Prepare, words: str, message: str) -> None:
    """The error is complete if it ends with a new line."""
    prepare(done)
    found, expected = refused(thawslide, done, *words.format(run=done).split()), message.format(run=done)
    assert found == f"error: {expected}" if message.endswith("\n") else expected in found


def test_a_changed_case_is_restored_or_put_back(thawslide: Program, killed: Path) -> None:
    """A missing file is written again; changes of [report] and title do not affect a run."""
    file = killed / "case.toml"
    text = file.read_text()
    file.unlink()
    assert f"note: {file} was missing. It was written again from the checkpoint\n" in thawslide.ok("resume", killed)
    assert file.read_text() == text
    mark_killed(killed)
    edit(file, "\ntimes = []", "\ntimes = [0.1]")
    thawslide.ok("resume", killed)
    assert file.read_text() == text.replace("\ntimes = []", "\ntimes = [0.1]")


def test_a_case_before_the_first_checkpoint_changes_by_the_command_line_only(thawslide: Program, done: Path) -> None:
    before_its_first_checkpoint(done)
    file = done / "case.toml"
    text = file.read_text()
    file.unlink()
    assert f"{file} is missing, and no checkpoint holds its content" in refused(thawslide, done)
    file.write_text(text)
    thawslide.ok("resume", done, "--end", 0.3)
    assert [part["changes"] for part in run_facts(done)["parts"]] == [[], ["time.end=0.3"]]
    assert run_facts(done)["simulated_time_s"] == pytest.approx(0.3)
    # The change was interrupted before the first checkpoint.
    before_its_first_checkpoint(done)
    file.write_text(text)
    assert f"Specify it again: thawslide resume {done} --set time.end=0.3\n" in refused(thawslide, done)
    thawslide.ok("resume", done, "--end", 0.3)


def test_a_finished_run_is_not_changed_and_needs_checkpoints_to_continue(thawslide: Program, done: Path) -> None:
    before = content_of(done)
    for words in ([], ["--end", 0.2]):
        assert thawslide.ok("resume", done, *words) == f"{done} has reached its end at 0.2 s; nothing to do\n"
    assert content_of(done) == before
    for name in (*CHECKPOINTS, "history.csv"):
        (done / name).unlink()
    assert thawslide.ok("resume", done) == (
        f"{done} has reached its end at 0.2 s; nothing to do\n"
        f"note: {done} has no checkpoint, so --end cannot extend it\n"
    )


def test_a_finished_run_in_a_read_only_folder_needs_no_write_access(thawslide: Program, done: Path) -> None:
    if subprocess.run(["mount", "--bind", str(done), str(done)], capture_output=True, check=False).returncode != 0:
        pytest.skip("mount is not allowed: no read-only folder available")
    try:
        subprocess.run(["mount", "-o", "remount,bind,ro", str(done)], check=True)
        assert thawslide.ok("resume", done) == f"{done} has reached its end at 0.2 s; nothing to do\n"
        # Commands that need to write fail.
        message = thawslide.error("resume", done, "--end", 1, code=5)
        assert message == f"error: cannot write {done / 'run.lock'}: {os.strerror(30)}\n"
    finally:
        subprocess.run(["umount", str(done)], check=True)


def test_a_later_end_continues_from_an_older_checkpoint(thawslide: Program, done: Path) -> None:
    without_last_checkpoint(done)
    assert thawslide.ok("resume", done, "--end", 0.25).startswith(
        "continuing from t = 0 s; it had reached 0.2 s: rows and snapshots after 0 s are written again\n"
    )


def test_a_failed_run_can_end_before_its_failure(thawslide: Program, failed: Path) -> None:
    assert run_facts(failed)["simulated_time_s"] > 0.5
    thawslide.ok("resume", failed, "--end", 0.5)
    assert history(failed)["time_s"][-1] == pytest.approx(0.5)
    assert run_facts(failed)["status"] == "done"


@pytest.fixture
def failed(thawslide: Program, small_case: Path, tmp_path: Path) -> Path:
    run = tmp_path / "failed"
    assert "left the domain" in thawslide.error("run", small_case, "--output", run, *LEAVES, code=3)
    return run


def test_resuming_a_failed_run_without_a_change_has_a_warning(thawslide: Program, failed: Path) -> None:
    advice = f"If the key may change during a run, continue: thawslide resume {failed} --set KEY=VALUE\n"
    assert advice in thawslide.ok("status", failed)
    outcome = thawslide("resume", failed)
    assert outcome.returncode == 3
    assert "warning: the run failed, and resume changes nothing: it will probably fail again" in outcome.stdout
    assert "the run failed" not in thawslide.ok("resume", failed, *sets(grid__leaving="remove", time__end=1.2))


def test_a_contradiction_with_a_change_is_resolved_on_the_command_line(thawslide: Program, ran: Ran) -> None:
    run = ran(*sets(time__stepping="adaptive", time__step=0.05))
    message = thawslide.error("resume", run, "--end", 0.3, *sets(time__stepping="fixed"))
    assert "time.step is 0.05 s, above the limit of" in message
    assert message.endswith(f"on the command line: thawslide resume {run} --set KEY=VALUE.\n")
    thawslide.ok("resume", run, "--end", 0.3, *sets(time__stepping="fixed", time__step=0.001))


def test_a_run_without_particles_cannot_continue(thawslide: Program, ran: Ran) -> None:
    run = ran(*sets(time__end=4, body__block__velocity="[30,0]", grid__leaving="remove"))
    message = refused(thawslide, run, "--end", 8)
    assert message.startswith(f"error: {run} has ended, and no particles are left to continue with: the whole slide ")
    assert message.endswith(". Run the case again, in a larger domain.\n")
    thawslide.ok("resume", run)


def test_the_checkpoint_of_another_run_is_refused(thawslide: Program, ran: Ran, killed: Path) -> None:
    other = ran(*sets(basal__friction_angle=5), name="other")
    for name in CHECKPOINTS:
        shutil.copy(other / name, killed / name)
    assert refused(thawslide, killed) == (
        f"error: the checkpoint of {killed} was not written by this run: run.json lists no part with its case, in "
        "which basal.friction_angle is 5.0, was 10.0. Put back the run's own checkpoint.bin or "
        "checkpoint.previous.bin, or run the case again.\n"
    )


def interrupt(thawslide: Program, run: Path, *words: object, files: tuple[str, ...] = ("run.json",)) -> None:
    """Change a run as a resume that is killed after it recorded its changes in `files`, and before its checkpoint.

    In case.toml, the changes have taken effect.
    """
    resumed = run.with_name(run.name + "-resumed")
    shutil.copytree(run, resumed)
    thawslide.ok("resume", resumed, *words)
    mark_killed(resumed)
    for name in files:
        shutil.copy(resumed / name, run / name)
    shutil.rmtree(resumed)


def requested_changes(thawslide: Program, run: Path, *words: object) -> str:
    message = refused(thawslide, run, *words)
    start = (
        f"error: the last resume was interrupted before its change took effect. Specify it again: thawslide resume "
        f"{run} --set "
    )
    assert message.startswith(start), message
    return message[len(start) : -1]


TWO_CHANGES = sets(basal__friction_angle=5, time__end=0.3)


def test_an_interrupted_change_is_not_lost_by_another(thawslide: Program, done: Path) -> None:
    interrupt(thawslide, done, *TWO_CHANGES)
    assert requested_changes(thawslide, done) == "basal.friction_angle=5 --set time.end=0.3"
    requested = requested_changes(thawslide, done, "--end", 0.25)
    assert requested == "basal.friction_angle=5 --set time.end=0.25"
    thawslide.ok("resume", done, "--set", *requested.split())
    text = (done / "case.toml").read_text()
    assert "friction_angle = 5.0 " in text and "end = 0.25 " in text
    assert run_facts(done)["simulated_time_s"] == 0.25


def test_an_interrupted_change_can_be_withdrawn(thawslide: Program, done: Path) -> None:
    interrupt(thawslide, done, *TWO_CHANGES)
    thawslide.ok("resume", done, *sets(basal__friction_angle=10, time__end=0.25))
    assert "friction_angle = 10.0 " in (done / "case.toml").read_text()


def test_only_the_last_of_two_changes_must_be_repeated(thawslide: Program, done: Path) -> None:
    """The first change has taken effect, but is not yet in a checkpoint."""
    interrupt(thawslide, done, *TWO_CHANGES, files=("run.json", "case.toml"))
    changed = (done / "case.toml").read_text()
    interrupt(thawslide, done, "--end", 0.4)
    assert requested_changes(thawslide, done) == "time.end=0.4"
    # Without the file, which is written again from the checkpoint, both must be repeated.
    (done / "case.toml").unlink()
    assert thawslide.error("resume", done, "--end", 0.4).endswith(" --set basal.friction_angle=5 --set time.end=0.4\n")
    (done / "case.toml").write_text(changed)
    thawslide.ok("resume", done, "--end", 0.4)
    assert "friction_angle = 5.0 " in (done / "case.toml").read_text()


def test_a_change_interrupted_twice_before_a_checkpoint_must_be_repeated(thawslide: Program, done: Path) -> None:
    facts = run_facts(done)
    part = {**facts["parts"][0], "changes": ["basal.friction_angle=5"], "case_sha256": "0" * 64}
    facts["parts"] += [part, part]
    facts.update(status="running", steps=0, simulated_time_s=0.0)
    (done / "run.json").write_text(json.dumps(facts))
    without_checkpoints(done)
    (done / "history.csv").unlink()
    assert requested_changes(thawslide, done) == "basal.friction_angle=5"
    printed = thawslide.ok("resume", done, *sets(basal__friction_angle=5))
    assert printed.startswith(f"{done} was cut off before its first checkpoint; it starts again\n")
