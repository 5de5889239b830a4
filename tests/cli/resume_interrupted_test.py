"""Resumes that were interrupted before their changes took effect, runs without checkpoints, and the end at rest."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from conftest import Program, content_of, run_facts, sets
from faults import mark_killed

RESTS = sets(
    time__end=5,
    time__history_interval=0.1,
    time__output_interval=1,
    body__block__velocity="[3,0]",
    time__stop_at_rest=0.1,
    time__rest_time=0.4,
)


def interrupt_before_changes(thawslide: Program, run: Path, *words: object) -> None:
    """Change a run as a resume that is killed after recording its changes and before applying them."""
    resumed = run.with_name(run.name + "-resumed")
    shutil.copytree(run, resumed)
    outcome = thawslide("resume", resumed, *words)
    assert outcome.returncode == 0, outcome.stderr
    mark_killed(resumed)
    shutil.copy(resumed / "run.json", run / "run.json")
    shutil.rmtree(resumed)


def interrupt_after_changes(thawslide: Program, run: Path, *words: object) -> None:
    """Change a run as a resume that is killed after its changes are in case.toml, before its first checkpoint."""
    resumed = run.with_name(run.name + "-resumed")
    shutil.copytree(run, resumed)
    assert thawslide("resume", resumed, *words).returncode == 0
    mark_killed(resumed)
    for name in ("run.json", "case.toml"):
        shutil.copy(resumed / name, run / name)
    shutil.rmtree(resumed)


def requested_changes(thawslide: Program, run: Path, *words: object) -> str:
    before = content_of(run)
    outcome = thawslide("resume", run, *words)
    assert outcome.returncode == 2
    start = (
        f"error: the last resume was interrupted before its change took effect. Specify it again: thawslide resume "
        f"{run} --set "
    )
    assert outcome.stderr.startswith(start), outcome.stderr
    assert content_of(run) == before
    return outcome.stderr[len(start) : -1]


def test_an_interrupted_change_is_not_lost_by_another(thawslide: Program, done: Path) -> None:
    interrupt_before_changes(thawslide, done, *sets(basal__friction_angle=5, time__end=0.3))
    assert requested_changes(thawslide, done) == "basal.friction_angle=5 --set time.end=0.3"
    requested = requested_changes(thawslide, done, "--end", 0.25)
    assert requested == "basal.friction_angle=5 --set time.end=0.25"
    words = requested.split(" --set ")
    outcome = thawslide("resume", done, "--set", words[0], "--set", words[1])
    assert outcome.returncode == 0, outcome.stderr
    text = (done / "case.toml").read_text()
    assert "friction_angle = 5.0 " in text and "end = 0.25 " in text
    assert run_facts(done)["simulated_time_s"] == 0.25


def test_an_interrupted_change_can_be_withdrawn(thawslide: Program, done: Path) -> None:
    interrupt_before_changes(thawslide, done, *sets(basal__friction_angle=5, time__end=0.3))
    outcome = thawslide("resume", done, *sets(basal__friction_angle=10, time__end=0.25))
    assert outcome.returncode == 0, outcome.stderr
    assert "friction_angle = 10.0 " in (done / "case.toml").read_text()


def test_only_the_last_of_two_changes_must_be_repeated(thawslide: Program, done: Path) -> None:
    """The first change has taken effect, but is not yet in a checkpoint."""
    interrupt_after_changes(thawslide, done, *sets(basal__friction_angle=5, time__end=0.3))
    changed = (done / "case.toml").read_text()
    resumed = done.with_name("second")
    shutil.copytree(done, resumed)
    assert thawslide("resume", resumed, "--end", 0.4).returncode == 0
    mark_killed(resumed)
    shutil.copy(resumed / "run.json", done / "run.json")
    assert requested_changes(thawslide, done) == "time.end=0.4"
    # Without the file, which is written again from the checkpoint, both must be repeated.
    (done / "case.toml").unlink()
    outcome = thawslide("resume", done, "--end", 0.4)
    assert outcome.returncode == 2
    assert outcome.stderr.endswith(" --set basal.friction_angle=5 --set time.end=0.4\n")
    (done / "case.toml").write_text(changed)
    outcome = thawslide("resume", done, "--end", 0.4)
    assert outcome.returncode == 0, outcome.stderr
    assert "friction_angle = 5.0 " in (done / "case.toml").read_text()


def test_a_change_interrupted_twice_before_the_first_checkpoint_must_be_repeated(
    thawslide: Program, done: Path
) -> None:
    facts = json.loads((done / "run.json").read_text())
    part = {**facts["parts"][0], "changes": ["basal.friction_angle=5"], "case_sha256": "0" * 64}
    facts["parts"] += [part, part]
    facts.update(status="running", steps=0, simulated_time_s=0.0)
    (done / "run.json").write_text(json.dumps(facts))
    for name in ("checkpoint.bin", "checkpoint.previous.bin", "history.csv"):
        (done / name).unlink()
    assert requested_changes(thawslide, done) == "basal.friction_angle=5"
    outcome = thawslide("resume", done, *sets(basal__friction_angle=5))
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(f"{done} was cut off before its first checkpoint; it starts again\n")


@pytest.mark.parametrize("killed", [True, False])
def test_a_run_that_lost_its_checkpoints_is_not_restarted(thawslide: Program, done: Path, killed: bool) -> None:
    if killed:
        mark_killed(done)
    for name in ("checkpoint.bin", "checkpoint.previous.bin"):
        (done / name).unlink()
    before = content_of(done)
    outcome = thawslide("resume", done, "--end", 0.3)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {done} had reached 0.2 s, but checkpoint.bin and checkpoint.previous.bin are missing. A new start "
        f"would overwrite its results. Put one of them back, or run the case again in another "
        f"folder: thawslide run {done} --output OTHER.\n"
    )
    assert content_of(done) == before
    other = done.with_name("other")
    assert thawslide("run", done, "--output", other).returncode == 0
    assert (other / "history.csv").read_bytes() == (done / "history.csv").read_bytes()


def test_the_advice_for_a_run_at_rest_works(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run, *RESTS).returncode == 0
    rest = run_facts(run)["simulated_time_s"]
    resumed = thawslide("resume", run, "--end", 5.5).stdout
    assert resumed.endswith("nothing to do. To continue it, add --set time.stop_at_rest=0\n")
    outcome = thawslide("resume", run, "--end", rest + 0.5, "--set", "time.stop_at_rest=0")
    assert outcome.returncode == 0, outcome.stderr
    assert run_facts(run)["simulated_time_s"] == pytest.approx(rest + 0.5)
    assert run_facts(run)["message"] == ""
    text = (run / "case.toml").read_text()
    assert "stop_at_rest = 0.0 " in text and "rest_time = 0.4 " in text


def test_a_run_at_rest_accepts_another_rest_time(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run, *RESTS).returncode == 0
    rest = run_facts(run)["simulated_time_s"]
    outcome = thawslide("resume", run, *sets(time__rest_time=0.6))
    assert outcome.returncode == 0, outcome.stderr
    assert run_facts(run)["simulated_time_s"] == pytest.approx(rest + 0.2, abs=0.02)
    assert run_facts(run)["message"].startswith("the slide is at rest")


def test_a_run_at_rest_without_its_last_checkpoint_ends_at_the_same_rest(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    words = [*RESTS, *sets(checkpoint__interval=0.3)]
    assert thawslide("run", small_case, "--output", run, *words).returncode == 0
    rows = (run / "history.csv").read_bytes()
    (run / "checkpoint.bin").unlink()
    outcome = thawslide("resume", run, "--end", 5.5)
    assert outcome.returncode == 0, outcome.stderr
    assert (run / "history.csv").read_bytes() == rows
