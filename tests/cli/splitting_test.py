"""Splitting of stretched particles: areas of a slide one cell thick, particle files, and the warning at the limit."""

import signal
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Interrupted, Program, assert_identical, datasets, run_facts, sets, snapshot_files

sys.path.append(str(ROOT))

from reproduction.studies import refinement

SPLITS = sets(mechanics__split_stretched="true")


def particles(run: Path, snapshot: int) -> dict[str, np.ndarray]:
    group = "VTKHDF/PointData/"
    found = datasets(snapshot_files(run)[snapshot])
    return {name.removeprefix(group): values for name, values in found.items() if name.startswith(group)}


@pytest.fixture
def plane(tmp_path: Path) -> list[str]:
    """Write the slide on a plane that runs out (docs/refinement.md); return its arguments, with cells of 40 m."""
    refinement.write_case(refinement.PLANE, "refined-plane", tmp_path, tmp_path)
    return [str(tmp_path / "plane" / "refined-plane.toml"), *sets(grid__cell=40)]


def test_a_slide_one_cell_thick_covers_its_area(thawslide: Program, plane: list[str], tmp_path: Path) -> None:
    # 145,350 and 491,950 m2 without splitting
    thawslide.ok("run", *plane, *SPLITS, "--output", tmp_path / "run")
    facts = run_facts(tmp_path / "run")
    assert facts["covered_area_m2"] == pytest.approx(240_000.0, rel=0.1)
    assert facts["affected_area_m2"] == pytest.approx(600_000.0, rel=0.1)
    assert facts["travel_distance_m"] == pytest.approx(1_335.0, rel=0.02)
    assert 0.0 < facts["dilation_fraction"] < 0.05


@pytest.mark.long
def test_a_split_tail_has_no_gap_larger_than_a_cell(thawslide: Program, tmp_path: Path) -> None:
    # up to 145 m, and 41 gaps of more than 10 m at the end, without splitting
    thawslide.ok("run", ROOT / "cases" / "lamplugh-columns", *SPLITS, "--output", tmp_path / "run")
    files = snapshot_files(tmp_path / "run")
    assert len(files) > 5
    for file in files:
        along = np.sort(datasets(file)["VTKHDF/Points"][:, 0])
        assert np.diff(along).max() < 10.0


def test_particle_files_name_the_particle_that_was_split(thawslide: Program, plane: list[str], tmp_path: Path) -> None:
    thawslide.ok("run", *plane, *SPLITS, "--output", tmp_path / "split")
    thawslide.ok("run", *plane, *sets(time__end=1), "--output", tmp_path / "whole")
    first, last = (particles(tmp_path / "split", place) for place in (0, -1))
    start, number, parent = first["id"].size, last["id"], last["parent_id"]
    assert number.tolist() == list(range(number.size))
    assert number.size > 1.5 * start
    assert np.array_equal(parent[:start], number[:start])
    assert np.all(parent[start:] < number[start:])
    assert last["mass"].sum() == pytest.approx(first["mass"].sum(), rel=1e-13)
    assert "parent_id" not in particles(tmp_path / "whole", -1)


def test_an_interrupted_run_continues_bitwise_identically(
    thawslide: Program, interrupted: Interrupted, plane: list[str], tmp_path: Path, run: Path
) -> None:
    case, *words = [plane[0], *SPLITS, *sets(grid__cell=20)]
    thawslide.ok("run", case, *words, "--output", tmp_path / "complete", "--threads", 1)
    assert interrupted(Path(case), run, words, signal.SIGINT, 40) == 4
    assert run_facts(run)["simulated_time_s"] < 45.0
    thawslide.ok("resume", run)
    assert_identical(run, tmp_path / "complete")


def test_the_limit_is_reported_once(thawslide: Program, plane: list[str], tmp_path: Path) -> None:
    limited = [*plane, *SPLITS, *sets(mechanics__split_limit=1.2)]
    printed = thawslide.ok("run", *limited, "--output", tmp_path / "run")
    assert printed.count("splitting has made 240 particles of 200, and mechanics.split_limit is 1.2.") == 1
    assert particles(tmp_path / "run", -1)["id"].size == 240
    resumed = thawslide.ok("resume", tmp_path / "run", "--end", 51)
    assert "splitting has made" not in resumed
    thawslide.ok("resume", tmp_path / "run", "--end", 52, *sets(mechanics__split_limit=3))
    assert particles(tmp_path / "run", -1)["id"].size > 300
