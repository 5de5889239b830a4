"""Slides on cells of several sizes: a plane with a level runout, on cells that follow it, and a slope of the Alps.

The jobs are those of the study `refinement`, whose page has finer cells and explains the differences. On small cells
(docs/refinement.md), areas and travel distance on the plane are 234,800 m2, 597,200 m2 and 1,336 m; areas are thicker
than 0.5 m on map cells of 20 m. If the slide is one cell thick, stretched particles split.
"""

import signal
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Interrupted, Program, assert_identical, columns_of, datasets, run_facts, sets, snapshot_files

from reproduction.studies import refinement
from reproduction.studies.refinement_page import friction_rows
from reproduction.study import Job, Place
from thawslide.maps import read_map

ALR = ROOT.parent / "shared" / "data" / "alr"
FOLLOWING = ('time.stepping="adaptive"', "maps.cell=20")
# Transfer, cell [m], and the largest deviations of deposit area, inundated area and travel, and of the growth of the
# volume.
BOUNDS = [
    pytest.param("flip", 20.0, 0.12, 0.11, 0.02, 0.07),
    pytest.param("apic", 20.0, 0.08, 0.08, 0.02, 0.03),
    pytest.param("flip", 10.0, 0.06, 0.04, 0.02, 0.06, marks=pytest.mark.long),
    pytest.param("apic", 10.0, 0.03, 0.03, 0.02, 0.04, marks=pytest.mark.long),
    pytest.param("flip", 5.0, 0.03, 0.02, 0.02, 0.05, marks=pytest.mark.long),
]


@pytest.mark.parametrize(("transfer", "cell", "deposit", "inundated", "travel", "growth"), BOUNDS)
def test_areas_on_coarse_cells_are_those_of_fine_ones(
    binary: Path, tmp_path: Path, transfer: str, cell: float, deposit: float, inundated: float, travel: float,
    growth: float,
) -> None:  # fmt: skip
    refinement.write_case(refinement.PLANE, "refined-plane", tmp_path, tmp_path)
    level = refinement.plane_job(cell, tmp_path)
    sets = (*level.sets, *FOLLOWING, f'mechanics.transfer="{transfer}"')
    Place(binary, tmp_path, tmp_path).perform([Job(level.key, "", sets, level.case)])
    facts = run_facts(tmp_path / level.key)
    assert facts["deposit_area_m2"] == pytest.approx(234_800.0, rel=deposit)
    assert facts["inundated_area_m2"] == pytest.approx(597_200.0, rel=inundated)
    assert facts["travel_distance_m"] == pytest.approx(1_336.0, rel=travel)
    assert 0.0 < facts["dilation_fraction"] < growth
    numerical = columns_of(tmp_path / level.key / "history.csv")["numerical_J"][-1]
    assert abs(numerical) < 1.2e10  # of 1.6e13 J of potential energy


def perform(binary: Path, runs: Path, job: Job) -> refinement.Found:
    Place(binary, runs, runs).perform([job])
    return refinement.read_found(runs / job.key)


@pytest.mark.long
def test_travel_on_a_plane_converges(binary: Path, tmp_path: Path) -> None:
    """Travel distance, centre and width of the deposit are those of finer cells (docs/refinement.md)."""
    refinement.write_case(refinement.PLANE, "refined-plane", tmp_path, ALR)
    jobs = [refinement.plane_job(cell, tmp_path) for cell in (20.0, 10.0)]
    found = [perform(binary, tmp_path, job) for job in jobs]
    assert refinement.spread([each.centre for each in found]) < 0.01
    assert refinement.spread([each.travel for each in found]) < 0.02
    assert refinement.spread([each.reach_angle for each in found]) < 0.015
    widths = [refinement.read_deposit(tmp_path / job.key).width for job in jobs]
    assert widths == pytest.approx([134.0, 134.0], rel=0.02)
    # A point mass on this terrain travels 1,007 m (docs/comparison.md).
    assert found[-1].centre == pytest.approx(1007.0, rel=0.01)


@pytest.mark.long
@pytest.mark.skipif(not ALR.is_dir(), reason=f"no folder {ALR}")
def test_travel_on_a_slope_of_the_alps_does_not_depend_on_the_cell(binary: Path, tmp_path: Path) -> None:
    """With the same filter on both cells. Friction on the terrain is that of the wedge factor within 10 %."""
    refinement.write_inputs(tmp_path, ALR)
    found = []
    for cell in (10.0, 6.6):
        job = refinement.alr_job(cell, tmp_path, refinement.WIDE)
        found.append(perform(binary, tmp_path, job))
        rows = friction_rows(tmp_path / job.key, read_map(tmp_path / job.key / "maps" / "terrain.tif"))
        assert len(rows) >= 8
        for each in rows:
            assert each.ground / each.wedge == pytest.approx(1.0, abs=0.1), (cell, each)
            # Yielding in the gully and at the end: 1.16 on cells of 6.6 m (docs/refinement.md).
            assert (each.ground + each.inside) / each.wedge < 1.25, (cell, each)
    assert refinement.spread([each.travel for each in found]) < 0.05
    assert refinement.spread([each.centre for each in found]) < 0.05
    assert found[-1].travel > 2600.0  # without the filter: 1,849 m


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


def test_split_particles_cover_their_area_and_name_their_parents(
    thawslide: Program, plane: list[str], tmp_path: Path
) -> None:
    # 145,350 and 491,950 m2 without splitting
    thawslide.ok("run", *plane, *SPLITS, "--output", tmp_path / "run")
    facts = run_facts(tmp_path / "run")
    assert facts["covered_area_m2"] == pytest.approx(240_000.0, rel=0.1)
    assert facts["affected_area_m2"] == pytest.approx(600_000.0, rel=0.1)
    assert facts["travel_distance_m"] == pytest.approx(1_335.0, rel=0.02)
    assert 0.0 < facts["dilation_fraction"] < 0.05
    thawslide.ok("run", *plane, *sets(time__end=1), "--output", tmp_path / "whole")
    first, last = (particles(tmp_path / "run", place) for place in (0, -1))
    start, number, parent = first["id"].size, last["id"], last["parent_id"]
    assert number.size > 1.5 * start and np.array_equal(parent[:start], number[:start])
    assert np.all(parent[start:] < number[start:])
    assert "parent_id" not in particles(tmp_path / "whole", -1)


@pytest.mark.long
def test_a_split_tail_has_no_gap_larger_than_a_cell(thawslide: Program, tmp_path: Path) -> None:
    # up to 145 m, and 41 gaps of more than 10 m at the end, without splitting
    thawslide.ok("run", ROOT / "cases" / "lamplugh-columns", *SPLITS, "--output", tmp_path / "run")
    files = snapshot_files(tmp_path / "run")
    assert len(files) > 5
    for file in files:
        along = np.sort(datasets(file)["VTKHDF/Points"][:, 0])
        assert np.diff(along).max() < 10.0


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
