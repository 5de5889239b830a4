"""Advice and estimates of `check`: a case that follows the advice is valid, and a run agrees with the estimates."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT, Program, run_facts, sets, snapshot_files

VALLEY = ROOT / "cases" / "valley3d"
# A heap 5 m long and 8 m high, with a blanket 25 m long and 1 m thick in front of it.
HEAP_AND_BLANKET = sets(
    grid__max="[40,20]", body__block__shape="polygon", body__block__vertices="[[5,0],[35,0],[35,1],[10,1],[10,8],[5,8]]"
)


@pytest.mark.parametrize("modulus", [1e7, 1.2e7])
def test_the_advised_modulus_is_sufficient(thawslide: Program, small_case: Path, modulus: float) -> None:
    tall = sets(grid__max="[60,40]", body__block__max="[34,30]")
    text = thawslide("check", small_case, *tall, *sets(material__rock__youngs_modulus=modulus)).stdout
    reported = re.search(r"compresses it by \d % there\. Give it (\S+) Pa or more\.\n", text)
    assert reported and float(reported[1]) > modulus, text
    enough = thawslide("check", small_case, *tall, *sets(material__rock__youngs_modulus=reported[1]))
    assert enough.returncode == 0 and "compresses it" not in enough.stdout


def test_the_median_and_its_warning_are_weighted_by_area(thawslide: Program, small_case: Path) -> None:
    text = thawslide("check", small_case, *HEAP_AND_BLANKET).stdout
    assert "; 2.17 m thick on average, 1 m in the median and 8 m at most (vertical)\n" in text
    assert "; 2 across in the median and 16 at most; " in text
    assert "median thickness of body block, 1 m, there are too few particles to resolve shear and thinning (" in text


@pytest.mark.parametrize(("end", "steps", "rows"), [(0.2005, 200, 5), (0.2006, 201, 6), (0.2503, 250, 6)])
def test_a_run_performs_the_reported_steps(
    thawslide: Program, small_case: Path, tmp_path: Path, end: float, steps: int, rows: int
) -> None:
    """A fixed step that would end more than half a step after the end is omitted."""
    reported = json.loads(thawslide("check", small_case, "--json", *sets(time__end=end)).stdout)
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run, *sets(time__end=end)).returncode == 0
    assert reported["steps"] == run_facts(run)["steps"] == steps
    assert reported["disk"]["snapshots"] == len(snapshot_files(run)) == rows


def test_the_reported_checkpoint_size_includes_maps_and_columns(thawslide: Program, tmp_path: Path) -> None:
    """Cells are coarse, so that particles are few; the first step creates the columns."""
    run = tmp_path / "run"
    words = sets(grid__cell=40, maps__cell=10, body__slide__particles_per_axis=1, time__end=0.1)
    case = VALLEY / "columns.toml"
    text = thawslide("check", case, *words).stdout
    reported = re.search(
        r", 3 checkpoints of (\S+) ([kM])B at the start and about (\S+) ([kM])B after spreading, ", text
    )
    assert reported, text
    assert thawslide("run", case, "--output", run, *words).returncode == 0
    units = {"k": 1e3, "M": 1e6}
    at_start, spread = (float(reported[k]) * units[reported[k + 1]] for k in (1, 3))
    assert at_start == pytest.approx((run / "checkpoint.bin").stat().st_size, rel=0.15)
    assert spread > 2.5 * at_start


def test_the_memory_error_names_the_cell_and_not_the_terrain(binary: Path, plain_environment: dict[str, str]) -> None:
    """The limit is too small even for terrain and program alone."""
    words = ["bash", "-c", 'ulimit -v 300000; exec "$@"', "bash", str(binary), "check", str(VALLEY)]
    environment = plain_environment | {"OMP_NUM_THREADS": "1"}
    outcome = subprocess.run(
        [*words, *sets(grid__cell=2)], env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert outcome.returncode == 2, outcome.stderr
    assert "terrain.file" not in outcome.stderr
    assert re.search(
        r"(grid\.cell is 2 m, which makes 52,000,000 particles: the run needs about 8[23] GB|memory of this machine)",
        outcome.stderr,
    ), outcome.stderr
