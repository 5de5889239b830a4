"""Messages of resume about failed runs, and about changes that contradict the rest of the case."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import Program, history, run_facts, sets

# Leaves the domain at about 1 s.
LEAVES = sets(time__end=3, grid__max="[17,10]", body__block__velocity="[3,0]", basal__friction_angle=1)


@pytest.fixture
def failed(thawslide: Program, small_case: Path, tmp_path: Path) -> Path:
    run = tmp_path / "failed"
    outcome = thawslide("run", small_case, "--output", run, *LEAVES)
    assert outcome.returncode == 3 and "left the domain" in outcome.stderr
    return run


def test_a_failed_run_can_end_before_its_failure(thawslide: Program, failed: Path) -> None:
    assert run_facts(failed)["simulated_time_s"] > 0.5
    outcome = thawslide("resume", failed, "--end", 0.5)
    assert outcome.returncode == 0, outcome.stderr
    assert history(failed)["time_s"][-1] == pytest.approx(0.5)
    assert run_facts(failed)["status"] == "done"


def test_resuming_a_failed_run_without_a_change_has_a_warning(thawslide: Program, failed: Path) -> None:
    assert (
        f"If the key may change during a run, continue: thawslide resume {failed} --set KEY=VALUE\n"
        in thawslide("status", failed).stdout
    )
    outcome = thawslide("resume", failed)
    assert outcome.returncode == 3
    assert "warning: the run failed, and resume changes nothing: it will probably fail again" in outcome.stdout
    outcome = thawslide("resume", failed, *sets(grid__leaving="remove", time__end=1.2))
    assert outcome.returncode == 0 and "the run failed" not in outcome.stdout, outcome.stderr


def test_a_contradiction_with_a_change_is_resolved_on_the_command_line(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    adaptive = sets(time__stepping="adaptive", time__step=0.05)
    assert thawslide("run", small_case, "--output", run, *adaptive).returncode == 0
    outcome = thawslide("resume", run, "--end", 0.3, *sets(time__stepping="fixed"))
    assert outcome.returncode == 2
    assert "time.step is 0.05 s, above the limit of" in outcome.stderr
    assert outcome.stderr.endswith(f"on the command line: thawslide resume {run} --set KEY=VALUE.\n")
    words = sets(time__stepping="fixed", time__step=0.001)
    assert thawslide("resume", run, "--end", 0.3, *words).returncode == 0
