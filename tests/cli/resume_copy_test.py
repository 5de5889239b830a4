"""`resume --output`: a copy of a run continues, and the run itself stays unchanged."""

import signal
import time
from pathlib import Path

from conftest import HANG, Program, content_of, history, run_facts, sets
from faults import environment_of_fault, needs_failing_writes

MEGABYTE = 2**20


def test_a_copy_continues_as_the_run_itself_would(thawslide: Program, done: Path, tmp_path: Path) -> None:
    before, branch = content_of(done), tmp_path / "new" / "branch"
    printed = thawslide.ok("resume", done, "--output", branch, "--end", 0.3, *sets(basal__friction_angle=5))
    assert f"{done} is copied to {branch}\n" in printed
    assert content_of(done) == before
    assert history(branch)["time_s"][-1] == 0.3
    assert [part["changes"] for part in run_facts(branch)["parts"]] == [[], ["basal.friction_angle=5", "time.end=0.3"]]
    thawslide.ok("resume", done, "--end", 0.3, *sets(basal__friction_angle=5))
    assert (branch / "history.csv").read_bytes() == (done / "history.csv").read_bytes()
    names = [{path.name for path in (run / "snapshots").iterdir()} for run in (done, branch)]
    assert names[0] == names[1]


def test_a_change_that_is_refused_leaves_no_copy(thawslide: Program, done: Path, tmp_path: Path) -> None:
    before, branch = content_of(done), tmp_path / "branch"
    for words, message in (
        (sets(grid__cell=2), "grid.cell cannot be changed on resume"),
        (sets(time__ende=2), "key 'time.ende' is not known in [time]"),
        (sets(basal__friction_angle=5), "has reached its end at 0.2 s: no step is left"),
    ):
        assert message in thawslide.error("resume", done, "--output", branch, *words)
        assert not branch.exists()
    assert content_of(done) == before


@needs_failing_writes
def test_a_copy_that_fails_is_removed_and_the_run_unchanged(thawslide: Program, done: Path, tmp_path: Path) -> None:
    before, branch = content_of(done), tmp_path / "branch"
    words = ("resume", done, "--output", branch, "--end", 0.3)
    failures = 0
    for at in range(1, 100):
        outcome = thawslide(*words, environment=environment_of_fault(branch, at, "once", "full"))
        if "is copied to" in outcome.stdout:
            break
        failures += 1
        assert outcome.returncode == 5, outcome.stderr
        assert "No space left on device" in outcome.stderr
        assert not branch.exists()
        assert content_of(done) == before
    assert failures > 5  # folders and files of the copy


@needs_failing_writes
def test_a_copy_that_fails_in_an_empty_folder_leaves_it_empty(thawslide: Program, done: Path, tmp_path: Path) -> None:
    branch = tmp_path / "branch"
    branch.mkdir()
    words = ("resume", done, "--output", branch, "--end", 0.3)
    assert thawslide(*words, environment=environment_of_fault(branch, 4, "once", "full")).returncode == 5
    assert list(branch.iterdir()) == []
    thawslide.ok(*words)


def test_a_run_is_locked_while_it_is_copied(thawslide: Program, done: Path, tmp_path: Path) -> None:
    with (done / "terrain.csv").open("ab") as file:
        file.truncate(200 * MEGABYTE)
    before, branch = {path: path.stat().st_size for path in done.rglob("*")}, tmp_path / "branch"
    with thawslide.start("resume", done, "--output", branch, "--end", 0.3) as process:
        while process.poll() is None and not (branch / "terrain.csv").exists():
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        assert not (branch / "run.json").exists(), "the copy was complete before the test could stop it"
        message = thawslide.error("resume", done, "--end", 0.3)
        process.send_signal(signal.SIGCONT)
        process.communicate(timeout=HANG)
        assert process.returncode == 0
    assert f"{done} is being written by process {process.pid} on " in message
    assert {path: path.stat().st_size for path in done.rglob("*")} == before
