"""Inputs that have changed since a run began: copies must be unchanged, originals need not."""

from __future__ import annotations

from pathlib import Path

from conftest import Program
from faults import mark_killed


def require_refused(thawslide: Program, run: Path, copy: Path) -> None:
    outcome = thawslide("resume", run)
    assert outcome.returncode == 2
    assert outcome.stderr == (
        f"error: {copy} has changed. A run continues with the inputs of its start (run.json has their SHA-256): put "
        "them back, or run the case again.\n"
    )


def test_a_changed_input_is_refused_and_a_changed_original_reported(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    mark_killed(run)
    original, copy = small_case / "case.toml", run / "inputs" / "case.toml"
    original.write_text(original.read_text() + "# a remark\n")
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    warning = f"{original} has changed since the run began. The run continues with its copy, inputs/case.toml\n"
    assert f"warning: {warning}" in outcome.stdout
    mark_killed(run)
    copy.write_text("other")
    require_refused(thawslide, run, copy)


def test_a_changed_input_that_is_no_longer_valid_is_reported_as_changed(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    file, run = small_case / "case.toml", tmp_path / "run"
    text = file.read_text()
    file.write_text(text.replace('type = "flat"\nelevation = 0.0', 'type = "profile"\nfile = "profile.csv"'))
    (small_case / "profile.csv").write_text("distance_m,terrain_elevation_m\n0,0\n20,0\n")
    assert thawslide("run", small_case, "--output", run).returncode == 0
    mark_killed(run)
    copy = run / "inputs" / "profile.csv"
    copy.write_text("no profile")
    require_refused(thawslide, run, copy)
