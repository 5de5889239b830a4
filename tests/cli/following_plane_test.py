"""A slide on a plane that runs out, on cells that follow the terrain: areas and travel against their limits.

The limits are those for small cells (docs/refinement.md): 234,800 m2, 597,200 m2 and 1,336 m. Areas are thicker than
0.5 m on map cells of 20 m.
"""

import sys
from pathlib import Path

import pytest
from conftest import ROOT, columns_of, run_facts

sys.path.append(str(ROOT))

from reproduction.studies import refinement
from reproduction.study import Job, Place

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
