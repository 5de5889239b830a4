"""Changes of the case of an interrupted or finished run: allowed ones, and errors about the others."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from conftest import Program, content_of, run_facts, sets
from faults import before_its_first_checkpoint, mark_killed


def edit(run: Path, old: str, new: str) -> Path:
    file = run / "case.toml"
    text = file.read_text()
    assert text.count(old) == 1
    file.write_text(text.replace(old, new))
    return file


def test_a_case_changed_before_the_first_checkpoint_is_refused(thawslide: Program, done: Path) -> None:
    before_its_first_checkpoint(done)
    text = (done / "case.toml").read_text()
    file = edit(done, "\ncohesion = 100000.0 ", "\ncohesion = 200000.0 ")
    before = content_of(done)
    for words in ([], ["--end", "0.3"]):
        outcome = thawslide("resume", done, *words)
        assert outcome.returncode == 2
        assert outcome.stderr == (
            f"error: {file} has changed since the run began (run.json has its SHA-256), and no checkpoint holds its "
            f"content. Put back what was there, or run the case again.\n"
        )
    assert content_of(done) == before
    file.unlink()
    outcome = thawslide("resume", done)
    assert outcome.returncode == 2 and f"{file} is missing, and no checkpoint holds its content" in outcome.stderr
    # Changes on the command line are accepted.
    file.write_text(text)
    outcome = thawslide("resume", done, "--end", 0.3)
    assert outcome.returncode == 0, outcome.stderr
    assert [part["changes"] for part in run_facts(done)["parts"]] == [[], ["time.end=0.3"]]
    assert run_facts(done)["simulated_time_s"] == pytest.approx(0.3)


def test_a_change_interrupted_before_the_first_checkpoint_must_be_repeated(thawslide: Program, done: Path) -> None:
    text = (done / "case.toml").read_text()
    before_its_first_checkpoint(done)
    assert thawslide("resume", done, "--end", 0.3).returncode == 0
    before_its_first_checkpoint(done)
    (done / "case.toml").write_text(text)
    outcome = thawslide("resume", done)
    assert outcome.returncode == 2
    assert f"Specify it again: thawslide resume {done} --set time.end=0.3\n" in outcome.stderr
    assert thawslide("resume", done, "--end", 0.3).returncode == 0


@pytest.mark.parametrize("is_killed", [True, False])
def test_a_new_end_in_the_case_file_is_answered_with_the_command(
    thawslide: Program, done: Path, is_killed: bool
) -> None:
    if is_killed:
        mark_killed(done)
    file = edit(done, "\nend = 0.2 ", "\nend = 0.4 ")
    outcome = thawslide("resume", done)
    assert outcome.returncode == 2
    begin = (
        f"{file} has changed since the run wrote its checkpoint"
        if is_killed
        else f"{done} has reached its end at 0.2 s, and {file} has changed since"
    )
    command = f"thawslide resume {done} --end 0.4"
    assert outcome.stderr == (
        f"error: {begin}: time.end is 0.4, was 0.2. Specify a new end on the command line: {command}.\n"
    )
    edit(done, "\ncohesion = 100000.0 ", "\ncohesion = 200000.0 ")
    assert "Put that back, or r" in thawslide("resume", done).stderr
    edit(done, "\ncohesion = 200000.0 ", "\ncohesion = 100000.0 ")
    outcome = thawslide(*command.split()[1:])
    assert outcome.returncode == 0, outcome.stderr
    assert run_facts(done)["simulated_time_s"] == pytest.approx(0.4)
    assert run_facts(done)["parts"][1]["changes"] == ["time.end=0.4"]


def test_a_finished_run_without_checkpoints_cannot_be_extended(thawslide: Program, done: Path) -> None:
    for name in ("checkpoint.bin", "checkpoint.previous.bin", "history.csv"):
        (done / name).unlink()
    outcome = thawslide("resume", done)
    assert outcome.returncode == 0
    assert outcome.stdout == (
        f"{done} has reached its end at 0.2 s; nothing to do\n"
        f"note: {done} has no checkpoint, so --end cannot extend it\n"
    )
    edit(done, "\nend = 0.2 ", "\nend = 0.4 ")
    outcome = thawslide("resume", done)
    assert outcome.returncode == 2
    assert "its SHA-256 is not that of run.json. There is no checkpoint to continue from" in outcome.stderr


def test_a_finished_run_in_a_read_only_folder_needs_no_write_access(thawslide: Program, done: Path) -> None:
    if subprocess.run(["mount", "--bind", str(done), str(done)], capture_output=True, check=False).returncode != 0:
        pytest.skip("mount is not allowed: no read-only folder available")
    try:
        subprocess.run(["mount", "-o", "remount,bind,ro", str(done)], check=True)
        outcome = thawslide("resume", done)
        assert outcome.returncode == 0, outcome.stderr
        assert outcome.stdout == f"{done} has reached its end at 0.2 s; nothing to do\n"
        # Commands that need to write fail.
        outcome = thawslide("resume", done, "--end", 1)
        assert outcome.returncode == 5
        assert outcome.stderr == f"error: cannot write {done / 'run.lock'}: {os.strerror(30)}\n"
    finally:
        subprocess.run(["umount", str(done)], check=True)


def test_an_end_that_was_passed_before_the_kill_is_refused(thawslide: Program, done: Path) -> None:
    """The checkpoint is older, and later results would be removed."""
    mark_killed(done)
    (done / "checkpoint.previous.bin").rename(done / "checkpoint.bin")
    before = content_of(done)
    outcome = thawslide("resume", done, "--end", 0.1)
    assert outcome.returncode == 2
    assert outcome.stderr == "error: the end of 0.1 s has passed: the run had reached 0.2 s. Give a later one.\n"
    assert content_of(done) == before
    outcome = thawslide("resume", done, "--end", 0.25)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(
        "continuing from t = 0 s; it had reached 0.2 s: rows and snapshots after 0 s are written again\n"
    )


def test_guards_that_change_the_columns_of_the_history_are_refused(thawslide: Program, done: Path) -> None:
    outcome = thawslide("resume", done, "--end", 0.3, *sets(guards__volume="remove"))
    assert outcome.returncode == 2
    assert "a continued run cannot change this. Run the case again." in outcome.stderr
