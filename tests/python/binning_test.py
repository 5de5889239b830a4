"""Averages of particles on a grid: volumes are conserved, fractions are exact, means are mass-weighted."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from map_runs import LENGTH, MIDDLE, SPEED, THICKNESS, WEST, WIDTH

from thawslide import Run
from thawslide.binning import FIELDS, gather, spread
from thawslide.maps import Grid, Maps

GRID = Grid(0.5, 1.0, 1.0, 2.0, 20, 12)  # cells of 1 m x 2 m over 0..20 m x 0..24 m


@pytest.mark.parametrize("width", [0.1, 1.0, 1.7, 4.0, 5.3])
def test_sums_are_conserved_for_any_width(width: float) -> None:
    random = np.random.default_rng(3)
    x, y = random.uniform(4.0, 16.0, 500), random.uniform(4.0, 20.0, 500)
    amounts = [random.random(500), random.normal(size=500)]
    for total, amount in zip(spread(GRID, x, y, width, amounts), amounts, strict=True):
        assert (total.shape, total.sum()) == ((12, 20), pytest.approx(amount.sum(), rel=1e-12))


def test_fractions_are_areas_inside_the_grid() -> None:
    (one,) = spread(GRID, np.array([5.75]), np.array([9.0]), 2.0, [np.array([8.0])])
    # 4.75..6.75 m of x: a quarter of a cell, one, three quarters; 8..10 m of y: the fifth row.
    wanted = np.zeros((12, 20))
    wanted[4, 4:7] = 1.0, 4.0, 3.0
    np.testing.assert_allclose(one, wanted, atol=1e-12)
    (one,) = spread(GRID, np.array([0.0, 20.0, -30.0]), np.array([1.0, 23.0, 1.0]), 2.0, [np.ones(3)])
    assert one.sum() == pytest.approx(1.0)


def test_thickness_and_basal_temperature_of_a_slab_are_exact(map_run: Path) -> None:
    run = Run(map_run)
    columns = gather(Maps(run)["release"].grid, run.snapshot(0, fields=FIELDS), 10.0)
    assert columns.thickness.volume() == pytest.approx(LENGTH * WIDTH * THICKNESS, rel=1e-12)
    assert columns.thickness.at(np.array([WEST + 100.0]), np.array([MIDDLE])) == pytest.approx(THICKNESS)
    assert np.nanmax(columns.speed.values) == pytest.approx(SPEED)
    assert np.nanmin(columns.speed.values) == pytest.approx(SPEED) and np.isnan(columns.speed.values[0, 0])
    columns = gather(Maps(run)["release"].grid, run.snapshot(5, fields=FIELDS), 10.0)
    values = columns.temperature.values[np.isfinite(columns.temperature.values)]
    np.testing.assert_allclose(values, 10.0)  # those above are at -50
    assert columns.time == 10.0


def test_invalid_particles_and_other_fields_are_excluded(map_run: Path) -> None:
    with h5py.File(map_run / "snapshots" / "000000.vtkhdf", "a") as file:
        file["VTKHDF/Points"][0] = np.nan
        file["VTKHDF/PointData/volume"][1] = np.nan
    run = Run(map_run)
    columns = gather(Maps(run)["release"].grid, run.snapshot(0, fields=FIELDS), 10.0)
    assert columns.thickness.volume() == pytest.approx(LENGTH * WIDTH * THICKNESS - 2 * 50.0, rel=1e-12)
    assert sorted(Run(map_run).snapshot(0, fields=FIELDS)) == sorted(FIELDS)
