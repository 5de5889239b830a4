"""Comparisons with SHALTOP and of cells: deposits, orders of convergence, and limits."""

import math
from pathlib import Path

import numpy as np
import pytest

from reproduction.studies import frank, refinement, refinement_page
from thawslide import ReportError
from thawslide.maps import Grid, Map

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "frank"
GRID = Grid(30.0, 30.0, 20.0, 20.0, 60, 40)


def block(first: int, last: int, value: float) -> Map:
    """Return a map that has a value in some columns of rows 10 to 19."""
    values = np.zeros((GRID.rows, GRID.columns))
    values[10:20, first:last] = value
    return Map(GRID, values, "m")


def test_numbers_of_a_known_deposit_are_exact() -> None:
    x, _ = np.meshgrid(GRID.x, GRID.y)
    terrain, pile = Map(GRID, 1_000.0 - 0.5 * x), block(2, 6, 30.0)
    final = block(30, 40, 4.0)
    final.values[10:20, 40:50] = 0.9  # too thin to count
    highest, speed = block(2, 40, 5.0), block(2, 40, 12.0)
    speed.values[15, 20], speed.values[30, 50] = 50.0, 99.0  # the latter where nothing was thick
    found = frank.figures(frank.Deposit(final, highest, speed), terrain, pile)
    assert (found.speed, found.high_speed, found.usual_speed, found.thickness) == (50.0, 12.0, 12.0, 4.0)
    assert found.farthest == 30.0 + 20.0 * 39
    # From the top of the pile, its uppermost column, to the farthest corner.
    travel, drop = math.hypot(37 * 20.0, 9 * 20.0), 30.0 + 0.5 * 37 * 20.0
    expected = {
        "x": 30.0 + 20.0 * 34.5, "y": 30.0 + 20.0 * 14.5, "area": 100 * 400e-6, "passed": 380 * 400e-6,
        "volume": (100 * 4.0 + 100 * 0.9) * 400e-6, "travel": travel, "drop": drop,
        "reach_angle": math.degrees(math.atan2(drop, travel)),
    }  # fmt: skip
    assert {name: getattr(found, name) for name in expected} == pytest.approx(expected)


def test_difference_and_spread_are_exact_and_orders_need_monotonic_values() -> None:
    empty = block(0, 0, 0.0)
    one, other = (frank.Deposit(block(first, first + 10, 4.0), empty, empty) for first in (10, 15))
    found = frank.difference(one, other)
    assert (found.overlap, found.moved) == (pytest.approx(1.0 / 3.0), pytest.approx(0.5))
    assert found.thickness == pytest.approx(math.sqrt(16.0 * 2.0 / 3.0))
    same = frank.difference(one, one)
    assert (same.overlap, same.moved, same.thickness) == (1.0, 0.0, 0.0)
    assert refinement.spread([90.0, 100.0, 110.0]) == pytest.approx(0.2)
    assert refinement_page.order_and_limit([1.0, 2.0, 1.5], 1) == ("not monotonic", "")


def test_maps_are_on_the_grid_of_the_file_of_the_other_code(tmp_path: Path) -> None:
    part = Map(Grid(10.0, 70.0, 20.0, 20.0, 3, 2), np.array([[1.0, 2.0, np.nan], [4.0, 5.0, 6.0]]))
    placed = frank.on_grid(part, GRID).values
    assert placed[2, :3].tolist() == [2.0, 0.0, 0.0]  # the first column lies outside
    assert (placed[3, :3].tolist(), placed.sum()) == ([5.0, 6.0, 0.0], 13.0)
    with pytest.raises(ReportError, match=r"the cells of a map .* differ from those of SHALTOP"):
        frank.on_grid(Map(Grid(35.0, 70.0, 20.0, 20.0, 3, 2), part.values), GRID)
    file = tmp_path / "a.asc"
    file.write_text("ncols 3\nnrows 2\nxllcorner 20\nyllcorner 40\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 5 6\n")
    found = frank.read_grid(file)
    assert found.grid == Grid(25.0, 45.0, 10.0, 10.0, 3, 2)
    assert found.values.tolist() == [[4.0, 5.0, 6.0], [1.0, 2.0, 3.0]]


PUBLISHED = {10: (2.78, 2696, 2919, 3910), 15: (1.83, 2121, 2580, 3150), 20: (1.24, 1778, 2326, 2530),
             25: (1.02, 1538, 2147, 2210)}  # fmt: skip


@pytest.mark.parametrize("angle", PUBLISHED)
def test_results_of_shaltop_are_as_published(angle: int) -> None:
    if not DATA.is_dir():
        pytest.skip("the Frank slide (frank/) is not in ../shared/data")
    terrain, pile = (frank.read_grid(DATA / f"Frankslide_{kind}.asc") for kind in ("topography", "pile"))
    assert pile.volume() == pytest.approx(36.0e6, rel=1e-4)
    found = frank.figures(frank.read_shaltop(DATA, angle, terrain), terrain, pile)
    assert (round(found.area, 2), round(found.x), round(found.y), round(found.farthest)) == PUBLISHED[angle]


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_orders_and_limits_are_those_of_the_cells_that_halve(order: float) -> None:
    values = [100.0 - 30.0 * (cell / 40.0) ** order for cell in refinement_page.HALVING]
    assert refinement_page.order_and_limit(values, 0) == (f"{order:.1f}", "100")
