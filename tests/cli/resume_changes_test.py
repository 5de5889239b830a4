"""Changes of a run that has ended, and foreign files in the folder of a run."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from conftest import Program, content_of, run_facts, sets
from faults import mark_killed

RESTS = sets(
    time__end=5,
    body__block__velocity="[2,0]",
    material__rock__viscosity_time=0.0005,
    time__stop_at_rest=0.1,
    time__rest_time=0.4,
)
LEAVES = sets(time__end=4, body__block__velocity="[30,0]", grid__leaving="remove")


def test_a_change_without_remaining_steps_is_refused(thawslide: Program, done: Path) -> None:
    before = content_of(done)
    outcome = thawslide("resume", done, *sets(basal__friction_angle=5))
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {done} has reached its end at 0.2 s: no step is left that could take basal.friction_angle=5. Give a "
        "later end too: --end T.\n"
    )
    assert content_of(done) == before
    assert thawslide("resume", done, "--end", 0.2).stdout.endswith("has reached its end at 0.2 s; nothing to do\n")
    assert thawslide("resume", done, "--end", 0.3, *sets(basal__friction_angle=5)).returncode == 0
    assert run_facts(done)["parts"][-1]["changes"] == ["basal.friction_angle=5", "time.end=0.3"]


def test_a_run_at_rest_continues_with_a_changed_case(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run, *RESTS).returncode == 0
    rest = run_facts(run)["simulated_time_s"]
    outcome = thawslide("resume", run, "--end", 6)
    assert outcome.returncode == 0
    assert outcome.stdout == (
        f"{run} has come to rest at {rest:g} s; nothing to do. To continue it, add --set time.stop_at_rest=0\n"
    )
    assert thawslide("resume", run, *sets(basal__friction_angle=5)).returncode == 0
    again = run_facts(run)
    assert again["simulated_time_s"] == pytest.approx(rest + 0.4, abs=0.03)
    assert again["parts"][-1]["changes"] == ["basal.friction_angle=5"]


def test_a_run_without_particles_cannot_continue(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    outcome = thawslide("run", small_case, "--output", run, *LEAVES)
    assert outcome.returncode == 0 and "the whole slide has left" in outcome.stdout
    before = content_of(run)
    outcome = thawslide("resume", run, "--end", 8)
    assert outcome.returncode == 2
    assert outcome.stderr.startswith(
        f"error: {run} has ended, and no particles are left to continue with: the whole slide has left the domain"
    )
    assert outcome.stderr.endswith(". Run the case again, in a larger domain.\n")
    assert content_of(run) == before
    assert thawslide("resume", run).returncode == 0


def test_the_checkpoint_of_another_run_is_refused(
    thawslide: Program, small_case: Path, done: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other"
    assert thawslide("run", small_case, "--output", other, *sets(basal__friction_angle=5)).returncode == 0
    mark_killed(done)
    before = content_of(done)
    for name in ("checkpoint.bin", "checkpoint.previous.bin"):
        shutil.copy(other / name, done / name)
    outcome = thawslide("resume", done)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: the checkpoint of {done} was not written by this run: run.json lists no part with its case, in "
        "which basal.friction_angle is 5.0, was 10.0. Put back the run's own checkpoint.bin or "
        "checkpoint.previous.bin, or run the case again.\n"
    )
    for file, bytes_before in before.items():
        file.write_bytes(bytes_before)
    assert thawslide("resume", done).returncode == 0


@pytest.mark.parametrize("name", ["snapshots", "inputs"])
def test_a_link_in_place_of_a_folder_of_a_run_is_refused(
    thawslide: Program, done: Path, tmp_path: Path, name: str
) -> None:
    elsewhere = tmp_path / "elsewhere"
    (done / name).rename(elsewhere)
    (done / name).symlink_to(elsewhere)
    before = content_of(elsewhere)
    outcome = thawslide("resume", done, "--end", 0.3)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {done / name} is a link; a run writes and reads its files in its own folder alone. Put the folder "
        "itself there.\n"
    )
    assert content_of(elsewhere) == before


def test_run_json_with_copies_outside_the_run_is_refused(thawslide: Program, done: Path) -> None:
    facts = run_facts(done)
    facts["inputs"] = [{"path": "/nowhere", "copy": "../../../etc/hostname", "sha256": "0" * 64, "bytes": 1}]
    (done / "run.json").write_text(json.dumps(facts))
    outcome = thawslide("resume", done, "--end", 0.3)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {done / 'run.json'}: damaged: it names ../../../etc/hostname as the copy of an input; those lie in "
        "inputs/.\n"
    )


def test_an_empty_name_of_the_output_folder_is_refused(thawslide: Program, small_case: Path) -> None:
    outcome = thawslide("run", small_case, "--output", "")
    assert outcome.returncode == 2 and "--output: name a folder" in outcome.stderr
