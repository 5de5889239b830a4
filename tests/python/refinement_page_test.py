"""The tables of docs/refinement.md: observed orders and limits."""

import pytest

from reproduction.studies import refinement_page
from reproduction.studies.refinement import PLANE_CELLS, PLANE_THICKNESS, Deposit


def deposit(cell: float) -> Deposit:
    """Return a deposit with errors of first order: 1,000, 2,000 and 3,000 m2, 8 m and 100 m on cells of no size."""
    error = cell / 40.0
    return Deposit(
        cell=cell, covered=1_000.0 - 400.0 * error, inundated=2_000.0 - 600.0 * error,
        affected=3_000.0 - 900.0 * error, thickness=8.0 + 6.0 * error, width=100.0 - 30.0 * error,
    )  # fmt: skip


@pytest.mark.parametrize("cells", [PLANE_CELLS, PLANE_CELLS[:-1], PLANE_CELLS[:2]])
def test_limits_of_deposits_are_of_first_order(cells: tuple[float, ...]) -> None:
    table = refinement_page.deposit_table([deposit(cell) for cell in cells])
    rows = {line.split("|")[1].strip(): [text.strip() for text in line.split("|")[2:-1]] for line in table.splitlines()}
    assert rows["cells across the release"] == [*(f"{PLANE_THICKNESS / cell:.3g}" for cell in cells), ""]
    areas = [rows[f"{name} area (m2)"][-1] for name in ("deposit", "inundated", "affected")]
    assert areas == ["1,000", "2,000", "3,000"]
    assert rows["standard deviation of the deposit across the slope (m)"][-1] == "100"
    assert rows["maximum thickness of the deposit (m)"] == [*(f"{8.0 + 0.15 * cell:.1f}" for cell in cells), ""]


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_orders_and_limits_are_those_of_the_cells_that_halve(order: float) -> None:
    values = [100.0 - 30.0 * (cell / 40.0) ** order for cell in refinement_page.HALVING]
    assert refinement_page.order_and_limit(values, 0) == (f"{order:.1f}", "100")


def test_value_without_monotonic_convergence_has_no_order() -> None:
    assert refinement_page.order_and_limit([1.0, 2.0, 1.5], 1) == ("not monotonic", "")
