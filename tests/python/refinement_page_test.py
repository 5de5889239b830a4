"""The tables of docs/refinement.md: observed orders and limits follow from the cells that halve."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts" / "comparison"))

import refinement_page
from refinement import PLANE_CELLS, Deposit


def deposit(cell: float, order: float) -> Deposit:
    """Return a deposit whose errors have an order: 1,000 m2, 3,000 m2, 8 m and 100 m on cells of no size."""
    error = (cell / 40.0) ** order
    return Deposit(
        cell=cell,
        covered=1_000.0 - 400.0 * error,
        affected=3_000.0 - 900.0 * error,
        thickness=8.0 + 6.0 * error,
        width=100.0 - 30.0 * error,
        dilation=0.2,
        map_cell=1.5 * cell,
    )


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_orders_and_limits_are_those_of_the_cells_that_halve(order: float) -> None:
    cells = sorted({*PLANE_CELLS, *refinement_page.HALVING}, reverse=True)
    table = refinement_page.deposit_table([deposit(cell, order) for cell in cells])
    rows = {line.split("|")[1].strip(): [text.strip() for text in line.split("|")[2:-1]] for line in table.splitlines()}
    assert rows["cells across the release"][: len(cells)] == [f"{40.0 / cell:.3g}" for cell in cells]
    assert rows["cells across the release"][len(cells) :] == ["", ""]
    for words, limit in (
        ("deposit area (m2)", "1,000"),
        ("affected area (m2)", "3,000"),
        ("maximum thickness of the deposit (m)", "8.0"),
        ("standard deviation of the deposit across the slope (m)", "100"),
    ):
        assert rows[words][len(cells) :] == [f"{order:.1f}", limit], words


def test_a_value_that_does_not_converge_evenly_has_no_order() -> None:
    assert refinement_page.order_and_limit([1.0, 2.0, 1.5], 1) == ("not monotonic", "")
