"""Slides on cells of several sizes: a plane with a level runout, on cells that follow it, and a slope of the Alps.

The jobs are those of the study `refinement`, whose page has finer cells and explains the differences. On small cells
(docs/refinement.md), areas and travel distance on the plane are 234,800 m2, 597,200 m2 and 1,336 m; areas are thicker
than 0.5 m on map cells of 20 m.
"""

import sys
from pathlib import Path

import pytest
from conftest import ROOT, columns_of, run_facts

sys.path.append(str(ROOT))

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


def run(binary: Path, runs: Path, job: Job) -> refinement.Found:
    Place(binary, runs, runs).perform([job])
    return refinement.read_found(runs / job.key)


@pytest.mark.long
def test_travel_on_a_plane_converges(binary: Path, tmp_path: Path) -> None:
    """Travel distance, centre and width of the deposit are those of finer cells (docs/refinement.md)."""
    refinement.write_case(refinement.PLANE, "refined-plane", tmp_path, ALR)
    jobs = [refinement.plane_job(cell, tmp_path) for cell in (20.0, 10.0)]
    found = [run(binary, tmp_path, job) for job in jobs]
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
        found.append(run(binary, tmp_path, job))
        rows = friction_rows(tmp_path / job.key, read_map(tmp_path / job.key / "maps" / "terrain.tif"))
        assert len(rows) >= 8
        for each in rows:
            assert each.ground / each.wedge == pytest.approx(1.0, abs=0.1), (cell, each)
            # Yielding in the gully and at the end: 1.16 on cells of 6.6 m (docs/refinement.md).
            assert (each.ground + each.inside) / each.wedge < 1.25, (cell, each)
    assert refinement.spread([each.travel for each in found]) < 0.05
    assert refinement.spread([each.centre for each in found]) < 0.05
    assert found[-1].travel > 2600.0  # without the filter: 1,849 m
