"""Travel distance and friction on cells of several sizes: a plane with a level runout, and a slope of the Alps.

The jobs are those of the study `refinement`, whose page has finer cells and explains the differences.
"""

import sys
from pathlib import Path

import pytest
from conftest import ROOT

sys.path.append(str(ROOT))

from reproduction.studies import refinement
from reproduction.studies.refinement_page import friction_rows
from reproduction.study import Job, Place
from thawslide.maps import read_map

ALR = ROOT.parent / "shared" / "data" / "alr"
pytestmark = pytest.mark.long


def run(binary: Path, runs: Path, job: Job) -> refinement.Found:
    Place(binary, runs, runs).perform([job])
    return refinement.read_found(runs / job.key)


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
