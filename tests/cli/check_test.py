"""What `check` and `run` report before a computation: errors and costs."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import FALL, ROOT, Program, Ran, run_facts, sets, snapshot_files, with_profile


def test_rows_and_snapshots_are_at_most_one_per_step(ran: Ran, thawslide: Program, small_case: Path) -> None:
    words = sets(time__end=0.02, time__output_interval=1e-7, time__history_interval=1e-9, checkpoint__interval=1e-10)
    disk = thawslide.json("check", small_case, *words)["disk"]
    assert (disk["snapshots"], disk["history_rows"]) == (21, 21)
    run = ran(*words)
    assert len(snapshot_files(run)) == 21
    assert len((run / "history.csv").read_text().splitlines()) == 1 + 21
    assert run_facts(run)["steps"] == 20


@pytest.mark.parametrize("kind", ["a folder", "a pipe"])
def test_folders_and_pipes_are_named_as_such(thawslide: Program, small_case: Path, kind: str) -> None:
    place = small_case / "case.toml"
    place.unlink()
    place.mkdir() if kind == "a folder" else os.mkfifo(place)
    remedy = "Give a case file, or a folder with a case.toml."
    assert thawslide("check", small_case).stderr == f"error: {place} is {kind}. {remedy}\n"


def test_no_output_replaces_an_input(thawslide: Program, small_case: Path) -> None:
    for place in (with_profile(small_case), small_case / "case.toml"):
        before = place.read_bytes()
        for words in (["block", small_case, "--output", place], ["check", small_case, "--picture", place]):
            problem = "is an input of the case, which it would replace. Give another file."
            assert thawslide.error(*words) == f"error: {words[-2]} {place} {problem}\n"
        assert place.read_bytes() == before
    thawslide.ok("block", small_case, "--output", small_case / "rows.csv")


def test_check_reports_facts_of_a_case_that_fails_in_its_first_steps(thawslide: Program, small_case: Path) -> None:
    words = sets(**FALL)
    reported = thawslide("check", small_case, "--json", *words)
    assert reported.returncode == 3
    facts = json.loads(reported.stdout)
    assert facts["particles"] == 64 and len(facts["warnings"]) > 1
    assert facts["processor_s"] is None and facts["gpu"] is None
    assert reported.stderr == f"error: {facts['error']}\n" and "the run failed at t = " in facts["error"]
    outcome = thawslide("check", small_case, *words)
    assert outcome.returncode == 3
    assert "case.toml: the run fails in its first steps\n" in outcome.stdout and "  particles   64\n" in outcome.stdout
    valid = thawslide.json("check", small_case)
    assert valid["error"] is None
    assert (valid["gpu"]["unavailable_reason"] is None) == (valid["gpu"]["wall_s"] is not None)


COLUMNS = (ROOT / "cases" / "lamplugh-columns", *sets(grid__cell=20))
CORE = min(os.sched_getaffinity(0))


@contextmanager
def busy(processes: int) -> Iterator[None]:
    """Occupy the core with processes that compute without an end."""
    command = ["taskset", "-c", str(CORE), sys.executable, "-c", "while True: pass"]
    loops = [subprocess.Popen(command) for _ in range(processes)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def test_the_cost_does_not_depend_on_other_processes_and_says_that_there_are_some(thawslide: Program) -> None:
    check = f'taskset -c {CORE} "$@"'
    alone = json.loads(thawslide.shell(check, "check", *COLUMNS, "--json").stdout)
    with busy(8):
        beside = json.loads(thawslide.shell(check, "check", *COLUMNS, "--json").stdout)
        printed = thawslide.shell(check, "check", *COLUMNS).stdout
    assert 1 / 3 < beside["processor_s"] / alone["processor_s"] < 3
    assert beside["slowdown"] > 3 * min(alone["slowdown"], 1.5)
    assert "of processor time (this machine is busy: " in printed
